#include "engine/stage_holds.h"

#include <algorithm>
#include <limits>

namespace glisson::engine {
namespace {

constexpr double kSlack = 1e-9;  ///< compliance of each row over its own W: rows that say the same have an answer
constexpr double kLeastMobility = 1e-30;  ///< [1/kg]: so that rows of held tissue have one, too
constexpr std::size_t kMostDenseRows = 96;
constexpr std::uint32_t kLeftOut = std::numeric_limits<std::uint32_t>::max();

}  // namespace

void StageHolds::set(const HeldRows& held, std::span<const ActiveVertex> active, std::span<const Vec3d> inverse_mass) {
  const bool same_means = held.has_means_of(held_) && std::ranges::equal(inverse_mass, inverse_mass_) &&
                          std::ranges::equal(active, active_, {}, &ActiveVertex::vertex);
  if (same_means && held == held_) return;
  held_ = held;
  if (!same_means) {
    inverse_mass_.assign(inverse_mass.begin(), inverse_mass.end());
    take_active(active);
    take_means(inverse_mass);
    couple_means();
  }
  take_rows();
  factorise();
}

void StageHolds::take_active(std::span<const ActiveVertex> active) {
  active_.clear();
  for (const ActiveVertex& w : active) active_.push_back(w.vertex);
  if (active_.empty()) return;
  if (place_of_vertex_.size() <= active_.back()) place_of_vertex_.resize(active_.back() + 1);
  for (std::uint32_t k = 0; k < active_.size(); ++k) place_of_vertex_[active_[k]] = k;
}

/// Among the active vertices.
std::uint32_t StageHolds::place_of(std::uint32_t vertex) const {
  if (vertex >= place_of_vertex_.size()) return kLeftOut;
  const std::uint32_t place = place_of_vertex_[vertex];
  return place < active_.size() && active_[place] == vertex ? place : kLeftOut;
}

void StageHolds::take_means(std::span<const Vec3d> inverse_mass) {
  entries_.clear(), places_.clear(), still_.clear(), mobility_.clear();
  begin_.assign(1, 0);
  for (std::size_t k = 0; k < held_.mean_count(); ++k) {
    const std::size_t before = entries_.size();
    bool known = true;
    for (const VertexWeight& w : held_.mean(k)) {
      entries_.push_back({place_of(w.vertex), w.weight});
      known = known && entries_.back().at != kLeftOut;
    }
    if (!known) entries_.resize(before);
    begin_.push_back(entries_.size());
  }
  for (const std::uint32_t vertex : held_.vertices()) still_.push_back(place_of(vertex));
  std::erase(still_, kLeftOut);

  std::vector<std::uint32_t>& local = scratch_.local;
  local.assign(active_.size(), kLeftOut);
  for (const Entry& e : entries_) local[e.at] = 0;
  for (const std::uint32_t place : still_) local[place] = 0;
  for (std::uint32_t place = 0; place < local.size(); ++place) {
    if (local[place] == kLeftOut) continue;
    local[place] = static_cast<std::uint32_t>(places_.size());
    places_.push_back(place);
    mobility_.push_back(inverse_mass[place]);
  }
  for (Entry& e : entries_) e.at = local[e.at];
  for (std::uint32_t& place : still_) place = local[place], mobility_[place] = {};
}

void StageHolds::couple_means() {
  const std::size_t means = held_.mean_count();
  Scratch& s = scratch_;
  s.begin.assign(places_.size() + 1, 0);
  for (const Entry& e : entries_) ++s.begin[e.at + 1];
  for (std::size_t p = 0; p < places_.size(); ++p) s.begin[p + 1] += s.begin[p];
  s.filled = s.begin;
  s.here.resize(entries_.size()), s.sum.resize(means), s.shares.assign(means, 0);
  pairs_.clear();
  for (std::uint32_t a = 0; a < means; ++a) {
    const std::span<const Entry> own = std::span(entries_).subspan(begin_[a], begin_[a + 1] - begin_[a]);
    for (const Entry& e : own) s.here[s.filled[e.at]++] = {a, mobility_[e.at] * e.weight};
    for (const Entry& e : own) {
      for (std::size_t other = s.begin[e.at]; other < s.filled[e.at]; ++other) {
        const auto& [b, moved] = s.here[other];
        if (s.shares[b] == 0) s.shares[b] = 1, s.sum[b] = {}, s.partners.push_back(b);
        s.sum[b] += moved * e.weight;
      }
    }
    for (const std::uint32_t b : s.partners) pairs_.push_back({a, b, s.sum[b]}), s.shares[b] = 0;
    s.partners.clear();
  }
}

void StageHolds::take_rows() {
  const std::size_t means = held_.mean_count();
  rows_.clear(), number_.clear();
  rows_begin_.assign(means + 1, 0);
  for (const HeldRows::Row& row : held_.rows()) {
    const bool known = begin_[row.mean] < begin_[row.mean + 1];
    number_.push_back(known ? static_cast<std::uint32_t>(rows_.size()) : kLeftOut);
    if (known) rows_.push_back(row), ++rows_begin_[row.mean + 1];
  }
  for (std::size_t m = 0; m < means; ++m) rows_begin_[m + 1] += rows_begin_[m];
  of_mean_.resize(rows_.size());
  std::vector<std::size_t> filled(rows_begin_.begin(), rows_begin_.end() - 1);
  for (std::uint32_t r = 0; r < rows_.size(); ++r) of_mean_[filled[rows_[r].mean]++] = r;
}

/// The lower half of B M⁻¹ Bᵀ.
template <class Add>
void StageHolds::add_own(const Add& add) const {
  for (const Pair& pair : pairs_) {
    for (std::size_t i = rows_begin_[pair.a]; i < rows_begin_[pair.a + 1]; ++i) {
      const std::uint32_t r = of_mean_[i];
      const Vec3d moved = component_product(pair.coupling, rows_[r].direction);
      for (std::size_t k = rows_begin_[pair.b]; k < rows_begin_[pair.b + 1]; ++k) {
        const std::uint32_t c = of_mean_[k];
        if (pair.a == pair.b && c > r) continue;
        const double w = dot(moved, rows_[c].direction);
        add(std::max(r, c), std::min(r, c), r == c ? w * (1.0 + kSlack) + kLeastMobility : w);
      }
    }
  }
}

/// The lower half of c.
template <class Add>
void StageHolds::add_compliance(const Add& add) const {
  for (std::size_t g = 0; g < held_.group_count(); ++g) {
    const HeldRows::Group group = held_.group(g);
    const std::size_t n = group.end - group.first;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k <= i; ++k) {
        const std::uint32_t r = number_[group.first + i], c = number_[group.first + k];
        if (r != kLeftOut && c != kLeftOut) add(r, c, group.compliance[i * n + k]);
      }
    }
  }
}

/// B M⁻¹ Bᵀ + c.
void StageHolds::factorise() {
  const auto n = static_cast<Eigen::Index>(rows_.size());
  moved_.resize(n);
  of_means_.resize(held_.mean_count());
  sparse_ = rows_.size() > kMostDenseRows;
  if (!sparse_) {
    W_.setZero(n, n);
    const auto add = [this](Eigen::Index r, Eigen::Index c, double w) { W_(r, c) += w; };
    add_own(add), add_compliance(add);
    if (n > 0) dense_factor_.compute(W_);
    return;
  }
  std::vector<Eigen::Triplet<double>> triplets;
  const auto add = [&triplets](std::uint32_t r, std::uint32_t c, double w) {
    if (w != 0.0) triplets.emplace_back(static_cast<int>(r), static_cast<int>(c), w);
  };
  add_own(add), add_compliance(add);
  Eigen::SparseMatrix<double> W(n, n);
  W.setFromTriplets(triplets.begin(), triplets.end());
  sparse_factor_.compute(W);
}

void StageHolds::project(std::span<Vec3d> changes) {
  for (const std::uint32_t place : still_) changes[place] = {};
  if (rows_.empty()) return;
  for (std::size_t m = 0; m < of_means_.size(); ++m) {
    Vec3d sum{};
    for (std::size_t k = begin_[m]; k < begin_[m + 1]; ++k) sum += changes[entries_[k].at] * entries_[k].weight;
    of_means_[m] = sum;
  }
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    moved_[static_cast<Eigen::Index>(r)] = dot(rows_[r].direction, of_means_[rows_[r].mean]);
  }
  if (sparse_) {
    moved_ = sparse_factor_.solve(moved_).eval();
  } else {
    dense_factor_.solveInPlace(moved_);
  }
  std::ranges::fill(of_means_, Vec3d{});
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    of_means_[rows_[r].mean] += rows_[r].direction * moved_[static_cast<Eigen::Index>(r)];
  }
  for (std::size_t m = 0; m < of_means_.size(); ++m) {
    for (std::size_t k = begin_[m]; k < begin_[m + 1]; ++k) {
      const Entry& e = entries_[k];
      changes[e.at] -= component_product(mobility_[e.at], of_means_[m]) * e.weight;
    }
  }
}

}  // namespace glisson::engine
