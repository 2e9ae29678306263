#include "engine/stage_holds.h"

#include <algorithm>

namespace glisson::engine {
namespace {

constexpr double kSlack = 1e-9;  ///< compliance of each row over its own W: rows that say the same have an answer
constexpr double kLeastMobility = 1e-30;  ///< [1/kg]: so that rows of held tissue have one, too

}  // namespace

void StageHolds::add_row(const HeldRows::Row& row, std::span<const ActiveVertex> active) {
  const std::size_t before = entries_.size();
  for (const VertexWeight& w : row.mean) {
    const auto at = std::ranges::lower_bound(active, w.vertex, {}, &ActiveVertex::vertex);
    if (at == active.end() || at->vertex != w.vertex) return entries_.resize(before);
    entries_.push_back({static_cast<std::uint32_t>(at - active.begin()), row.direction * w.weight});
  }
  begin_.push_back(entries_.size());
}

void StageHolds::set(std::span<const HeldRows> held, std::span<const ActiveVertex> active,
                     std::span<const Vec3d> inverse_mass) {
  const bool same = std::ranges::equal(held, held_) && std::ranges::equal(inverse_mass, inverse_mass_) &&
                    std::ranges::equal(active, active_, {}, &ActiveVertex::vertex);
  if (same) return;
  held_.assign(held.begin(), held.end()), inverse_mass_.assign(inverse_mass.begin(), inverse_mass.end());
  active_.clear();
  for (const ActiveVertex& w : active) active_.push_back(w.vertex);
  entries_.clear(), places_.clear(), mobility_.clear();
  begin_.assign(1, 0);
  std::vector<std::size_t> source;  // of each row, counted through all groups
  std::size_t counted = 0;
  for (const HeldRows& group : held) {
    for (const HeldRows::Row& row : group.rows) {
      add_row(row, active);
      if (source.size() + 2 == begin_.size()) source.push_back(counted);
      ++counted;
    }
  }
  for (const Entry& e : entries_) places_.push_back(e.at);
  std::ranges::sort(places_);
  places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  for (Entry& e : entries_) {
    e.at = static_cast<std::uint32_t>(std::ranges::lower_bound(places_, e.at) - places_.begin());
  }
  for (const std::uint32_t place : places_) mobility_.push_back(inverse_mass[place]);
  if (!empty()) factorise(held, source);
}

/// B M⁻¹ Bᵀ, its lower half.
void StageHolds::add_own(std::vector<Eigen::Triplet<double>>& W) const {
  std::vector<std::vector<std::pair<int, Vec3d>>> of_place(places_.size());  // row, and its weight there
  for (std::size_t r = 0; r + 1 < begin_.size(); ++r) {
    W.emplace_back(static_cast<int>(r), static_cast<int>(r), kLeastMobility);
    for (std::size_t k = begin_[r]; k < begin_[r + 1]; ++k) {
      of_place[entries_[k].at].emplace_back(static_cast<int>(r), entries_[k].weight);
    }
  }
  for (std::size_t p = 0; p < places_.size(); ++p) {
    for (const auto& [r, a] : of_place[p]) {
      for (const auto& [c, b] : of_place[p]) {
        const double w = dot(a, component_product(mobility_[p], b));
        if (c <= r && w != 0.0) W.emplace_back(r, c, r == c ? w * (1.0 + kSlack) : w);
      }
    }
  }
}

/// B M⁻¹ Bᵀ + c.
void StageHolds::factorise(std::span<const HeldRows> held, std::span<const std::size_t> source) {
  std::vector<Eigen::Triplet<double>> triplets;
  add_own(triplets);
  std::size_t first = 0, r = 0;
  for (const HeldRows& group : held) {
    const std::size_t n = group.rows.size(), from = r;
    while (r < source.size() && source[r] < first + n) ++r;
    for (std::size_t a = from; a < r && !group.compliance.empty(); ++a) {
      for (std::size_t b = from; b <= a; ++b) {
        const double c = group.compliance[(source[a] - first) * n + (source[b] - first)];
        if (c != 0.0) triplets.emplace_back(static_cast<int>(a), static_cast<int>(b), c);
      }
    }
    first += n;
  }
  const auto rows = static_cast<Eigen::Index>(source.size());
  Eigen::SparseMatrix<double> W(rows, rows);
  W.setFromTriplets(triplets.begin(), triplets.end());
  factor_.compute(W);
  moved_.resize(rows);
}

void StageHolds::project(std::span<Vec3d> changes) {
  const std::size_t rows = begin_.size() - 1;
  for (std::size_t r = 0; r < rows; ++r) {
    double sum = 0.0;
    for (std::size_t k = begin_[r]; k < begin_[r + 1]; ++k) sum += dot(entries_[k].weight, changes[entries_[k].at]);
    moved_[static_cast<Eigen::Index>(r)] = sum;
  }
  taken_ = factor_.solve(moved_);
  for (std::size_t r = 0; r < rows; ++r) {
    const double p = taken_[static_cast<Eigen::Index>(r)];
    for (std::size_t k = begin_[r]; k < begin_[r + 1]; ++k) {
      changes[entries_[k].at] -= component_product(mobility_[entries_[k].at], entries_[k].weight) * p;
    }
  }
}

}  // namespace glisson::engine
