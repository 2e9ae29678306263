#include "mesh/topology/vertex_stars.h"

#include <algorithm>
#include <stdexcept>

#include "base/text.h"
#include "mesh/topology/buckets.h"

namespace glisson::detail {
namespace {

constexpr std::size_t kMostTets = std::size_t{1} << 30;  // four corners each, counted in 32 bits
constexpr std::size_t kSpare = 16;                       // a cut through a vertex leaves about 12 of 24 tets on a side

[[noreturn]] void refuse_star(const std::string& fault) { throw std::invalid_argument("vertex stars: " + fault); }

void require_vertex(std::uint32_t vertex, std::size_t vertices) {
  if (vertex < vertices) return;
  refuse_star("there is no vertex " + std::to_string(vertex) + " among " + count_text(vertices, "vertex", "vertices") +
              ", numbered from 0");
}

void check(std::span<const Tet> tets, std::size_t vertices) {
  if (tets.size() >= kMostTets) refuse_star(std::to_string(tets.size()) + " tets; fewer than 2³⁰ can be numbered");
  for (const Tet& tet : tets) {
    for (const std::uint32_t v : tet) require_vertex(v, vertices);
  }
}

}  // namespace

VertexStars::VertexStars(std::span<const Tet> tets, std::size_t vertices) {
  check(tets, vertices);
  auto stars = make_buckets<std::uint32_t>(vertices, [&](const auto& sink) {
    for (std::uint32_t t = 0; t < tets.size(); ++t) {
      for (const std::uint32_t v : tets[t]) sink(v, t);
    }
  });
  items_ = std::move(stars.items);
  rows_.reserve(vertices + vertices / 8);  // room for the vertices of some cuts
  for (std::size_t v = 0; v < vertices; ++v) {
    rows_.push_back(
        {static_cast<std::uint32_t>(stars.begin[v]), static_cast<std::uint32_t>(stars.begin[v + 1] - stars.begin[v])});
  }
}

void VertexStars::require_held(std::uint32_t tet, std::uint32_t vertex) const {
  require_vertex(vertex, vertices());
  const auto star = tets_at(vertex);
  if (std::binary_search(star.begin(), star.end(), tet)) return;
  refuse_star("tet " + std::to_string(tet) + " does not hold vertex " + std::to_string(vertex) +
              "; it was removed, or its corner was moved before");
}

void VertexStars::remove(std::uint32_t tet, const Tet& corners) {
  for (const std::uint32_t v : corners) require_held(tet, v);
  for (const std::uint32_t v : corners) erase(tet, v);
}

void VertexStars::move(std::uint32_t tet, std::uint32_t from, std::uint32_t to) {
  require_held(tet, from);
  require_vertex(to, vertices());
  const auto star = tets_at(to);
  if (std::binary_search(star.begin(), star.end(), tet)) {
    refuse_star("tet " + std::to_string(tet) + " holds vertex " + std::to_string(to) +
                " already; its corners must differ");
  }
  erase(tet, from);
  insert(tet, to);
}

void VertexStars::add_vertices(std::size_t count) {
  // One by one: a resize to just this size would copy all rows every time.
  for (std::size_t i = 0; i < count; ++i) rows_.push_back({0, 0});
}

std::size_t VertexStars::bytes() const {
  std::size_t total = items_.capacity() * sizeof(std::uint32_t) + rows_.capacity() * sizeof(Row) +
                      grown_.capacity() * sizeof(std::vector<std::uint32_t>);
  for (const auto& list : grown_) total += list.capacity() * sizeof(std::uint32_t);
  return total;
}

void VertexStars::erase(std::uint32_t tet, std::uint32_t vertex) {
  Row& row = rows_[vertex];
  if (row.size == kGrown) {
    auto& list = grown_[row.begin];
    list.erase(std::lower_bound(list.begin(), list.end(), tet));
    return;
  }
  const auto star = std::span(items_).subspan(row.begin, row.size);
  const auto at = std::lower_bound(star.begin(), star.end(), tet);
  std::copy(at + 1, star.end(), at);
  --row.size;
}

void VertexStars::insert(std::uint32_t tet, std::uint32_t vertex) {
  auto& list = list_of_its_own(vertex);
  list.insert(std::lower_bound(list.begin(), list.end(), tet), tet);
}

std::vector<std::uint32_t>& VertexStars::list_of_its_own(std::uint32_t vertex) {
  Row& row = rows_[vertex];
  if (row.size == kGrown) return grown_[row.begin];
  const auto star = tets_at(vertex);
  std::vector<std::uint32_t> list;
  list.reserve(star.size() + kSpare);
  list.assign(star.begin(), star.end());
  row = {static_cast<std::uint32_t>(grown_.size()), kGrown};
  return grown_.emplace_back(std::move(list));
}

}  // namespace glisson::detail
