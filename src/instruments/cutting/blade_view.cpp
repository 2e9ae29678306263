#include "instruments/cutting/blade_view.h"

#include <algorithm>
#include <cmath>

#include "mesh/cut/cut_crossing.h"

namespace glisson {
namespace {

constexpr double kShift = 1e-6;  ///< of a typical edge
constexpr double kMoved = 1e-4;  ///< the same: a vertex farther from its first place has been moved
constexpr double kMargin = 2.0;  ///< around the blade, in longest edges: beyond, moved vertices need not be sought

/// A number in [−1, 1) for each number, without any order in them.
double scattered(std::uint64_t n) {
  n = (n + 1) * 0x9E3779B97F4A7C15U;
  n = (n ^ (n >> 30U)) * 0xBF58476D1CE4E5B9U;
  n = (n ^ (n >> 27U)) * 0x94D049BB133111EBU;
  return static_cast<double>((n ^ (n >> 31U)) >> 11U) * 0x1p-52 - 1.0;
}

void widen(Vec3d& low, Vec3d& high, const Vec3d& p) {
  for (std::size_t a = 0; a < 3; ++a) low[a] = std::min(low[a], p[a]), high[a] = std::max(high[a], p[a]);
}

}  // namespace

BladeView::BladeView(Scheme& scheme) : scheme_(scheme) {
  const Body& body = scheme.body();
  double sum = 0.0;
  for (const Tet& t : body.elements) {
    for (const auto& [a, b] : detail::kEdgeCorners) {
      const double length = norm(body.rest_positions[t[a]] - body.rest_positions[t[b]]);
      sum += length;
      longest_edge_ = std::max(longest_edge_, length);
    }
  }
  typical_edge_ = sum / (6.0 * static_cast<double>(body.elements.size()));
  follow_copies();
}

void BladeView::follow_copies() {
  const Body& body = scheme_.body();
  const std::span<const std::uint32_t> copies = scheme_.state().copies;
  const std::size_t originals = body.vertex_count - copies.size();
  for (std::size_t v = root_.size(); v < body.vertex_count; ++v) {
    const bool copy = v >= originals;
    root_.push_back(copy ? root_[copies[v - originals]] : static_cast<std::uint32_t>(v));
    if (copy) {
      const std::uint32_t origin = copies[v - originals];
      first_.push_back(Vec3d(first_[origin]));
      for (auto* field : {&before_, &now_}) {
        if (!field->empty()) field->push_back(Vec3d((*field)[origin]));
      }
      continue;
    }
    const std::uint64_t n = 3 * static_cast<std::uint64_t>(v);
    first_.push_back(body.rest_positions[v] +
                     Vec3d{scattered(n), scattered(n + 1), scattered(n + 2)} * (kShift * typical_edge_));
  }
}

/// Where the first point of a vertex is now.
Vec3d BladeView::position(std::uint32_t vertex, const Vec3d& displacement, std::span<const Vec3d> u, bool near) const {
  const Body& body = scheme_.body();
  const Vec3d off = first_[vertex] - body.rest_positions[vertex];
  const double moved = kMoved * typical_edge_;
  if (!near || dot(off, off) < moved * moved) return body.rest_positions[vertex] + displacement + off;
  const auto star = scheme_.stars().tets_at(vertex);
  if (star.empty()) return first_[vertex] + displacement;
  const Located at = locate(body, star, first_[vertex]);
  Vec3d x{};
  for (std::size_t c = 0; c < 4; ++c) {
    const std::uint32_t v = body.elements[at.element][c];
    x += (body.rest_positions[v] + u[v]) * at.weights[c];
  }
  return x;
}

/// Marks on which sides of a box vertices are, and lists the elements that may be in it.
void BladeView::find_near(const Vec3d& low, const Vec3d& high) {
  const Body& body = scheme_.body();
  outside_.resize(now_.size());
  for (std::size_t v = 0; v < now_.size(); ++v) {
    unsigned sides = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      sides |= static_cast<unsigned>(now_[v][a] < low[a] && before_[v][a] < low[a]) << a;
      sides |= static_cast<unsigned>(now_[v][a] > high[a] && before_[v][a] > high[a]) << (a + 3);
    }
    outside_[v] = static_cast<std::uint8_t>(sides);
  }
  near_.clear();
  for (std::uint32_t e = 0; e < body.elements.size(); ++e) {
    const Tet& t = body.elements[e];
    const int all = outside_[t[0]] & outside_[t[1]] & outside_[t[2]] & outside_[t[3]];
    if (all == 0 && body.rest[e].volume > 0.0) near_.push_back(e);
  }
}

void BladeView::look(const BladeEdge& from, const BladeEdge& to, std::span<const Vec3d> u) {
  const Body& body = scheme_.body();
  Vec3d low = from.from, high = from.from;
  for (const Vec3d& p : {from.to, to.from, to.to}) widen(low, high, p);
  const double margin = kMargin * longest_edge_;
  const auto is_near = [&](const Vec3d& x) {
    bool near = true;
    for (std::size_t a = 0; a < 3; ++a) near = near && x[a] > low[a] - margin && x[a] < high[a] + margin;
    return near;
  };
  now_.resize(body.vertex_count);
  for (std::uint32_t v = 0; v < now_.size(); ++v) {
    now_[v] = position(v, u[v], u, is_near(body.rest_positions[v] + u[v]));
  }
  if (before_.empty()) before_ = now_;
  find_near(low, high);
}

std::vector<detail::EdgeCrossing> BladeView::crossings(const BladeEdge& from, const BladeEdge& to) {
  const Body& body = scheme_.body();
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const std::uint32_t e : near_) {
    for (const auto& [a, b] : detail::kEdgeCorners) {
      const auto [low, high] = std::minmax(body.elements[e][a], body.elements[e][b]);
      if ((outside_[low] & outside_[high]) == 0) edges.emplace_back(low, high);
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  const detail::MovingSegment blade{{from.from, from.to}, {to.from, to.to}};
  std::vector<detail::EdgeCrossing> found;
  for (const auto& [low, high] : edges) {
    const detail::MovingSegment edge{{before_[low], before_[high]}, {now_[low], now_[high]}};
    if (const auto c = detail::first_crossing(blade, edge)) found.push_back({low, high, c->at, c->time});
  }
  return found;
}

void BladeView::archive(Archive& ar) {
  const std::size_t n = scheme_.body().vertex_count;
  ar.all_below(root_, n);
  ar(first_, before_, now_);
  const auto fits = [&](const auto& list) { return list.empty() || list.size() == n; };
  ar.check(root_.size() == n && first_.size() == n && fits(before_) && fits(now_));
}

}  // namespace glisson
