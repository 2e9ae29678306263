// tet_complex.cpp — see tet_complex.h.
#include "mesher/lattice/tet_complex.h"

#include <algorithm>

#include "mesh/topology/faces.h"

namespace glisson::lattice {

using detail::corner_of;

std::uint32_t TetComplex::add_vertex(const Vec3d& point, double edge) {
  points.push_back(point);
  stars.emplace_back();
  masks.push_back(0);
  edges.push_back(edge);
  changed.push_back(0);
  const auto v = static_cast<std::uint32_t>(points.size() - 1);
  if (trying_) log_.push_back({Change::Kind::vertex, 0, v, {}, {}, 0});
  return v;
}

std::uint32_t TetComplex::add_tet(const Tet& tet, Label label) {
  std::uint32_t t = 0;
  if (free_.empty()) {
    t = static_cast<std::uint32_t>(tets.size());
    tets.push_back(tet);
    labels.push_back(label);
  } else {
    t = free_.back();
    free_.pop_back();
    tets[t] = tet;
    labels[t] = label;
  }
  for (const std::uint32_t v : tet) stars[v].push_back(t);
  if (trying_) {
    log_.push_back({Change::Kind::added, label, t, tet, {}, 0});
  } else {
    note_tet(tet);
  }
  return t;
}

void TetComplex::remove_tet(std::uint32_t t) {
  if (trying_) log_.push_back({Change::Kind::removed, labels[t], t, tets[t], {}, 0});
  for (const std::uint32_t v : tets[t]) {
    auto& star = stars[v];
    *std::find(star.begin(), star.end(), t) = star.back();
    star.pop_back();
  }
  labels[t] = kNone;
  free_.push_back(t);
}

void TetComplex::move(std::uint32_t vertex, const Vec3d& to) {
  if (trying_) {
    log_.push_back({Change::Kind::moved, 0, vertex, {}, points[vertex], 0});
  } else {
    note_move(vertex);
  }
  points[vertex] = to;
}

void TetComplex::note_tet(const Tet& tet) {
  for (const std::uint32_t v : tet) changed[v] = clock;
}

void TetComplex::note_move(std::uint32_t vertex) {
  for (const std::uint32_t t : stars[vertex]) note_tet(tets[t]);
}

void TetComplex::set_mask(std::uint32_t vertex, Mask mask) {
  if (trying_) log_.push_back({Change::Kind::mask, 0, vertex, {}, {}, masks[vertex]});
  masks[vertex] = mask;
}

std::uint32_t TetComplex::across(std::uint32_t tet, std::size_t corner) const {
  const Tet& t = tets[tet];
  const std::uint32_t a = t[(corner + 1) & 3], b = t[(corner + 2) & 3], c = t[(corner + 3) & 3];
  for (const std::uint32_t other : stars[a]) {
    if (other != tet && has(other, b) && has(other, c)) return other;
  }
  return ~0u;
}

EdgeRing TetComplex::edge_ring(std::uint32_t u, std::uint32_t v) const {
  EdgeRing out;
  struct Link {
    std::uint32_t from, to, tet;
  };
  std::array<Link, 64> links;
  std::size_t n = 0;
  for (const std::uint32_t t : stars[u]) {
    const Tet& tet = tets[t];
    const std::size_t j = corner_of(tet, v);
    if (j == 4) continue;
    if (n == links.size()) return out;
    const auto& others = kOthers[corner_of(tet, u)][j];
    links[n++] = {tet[others[0]], tet[others[1]], t};
  }
  if (n == 0) return out;
  std::size_t first = 0;  // the start of an open chain: nobody's end
  for (std::size_t i = 0; i < n; ++i) {
    const bool is_end =
        std::any_of(links.begin(), links.begin() + n, [&](const Link& l) { return l.to == links[i].from; });
    if (is_end) continue;
    first = i;
    break;
  }
  out.ring.push_back(links[first].from);
  std::uint32_t at = links[first].from;
  for (std::size_t count = 0; count < n; ++count) {
    const auto next = std::find_if(links.begin(), links.begin() + n, [&](const Link& l) { return l.from == at; });
    if (next == links.begin() + n) return out;  // two chains
    out.tets.push_back(next->tet);
    at = next->to;
    if (at == out.ring.front()) {
      out.closed = true;
      break;
    }
    out.ring.push_back(at);
  }
  out.simple = out.tets.size() == n;
  return out;
}

Mask TetComplex::labels_at_edge(std::uint32_t u, std::uint32_t v) const {
  Mask mask = 0;
  for (const std::uint32_t t : stars[u]) {
    if (has(t, v)) mask |= bit(labels[t]);
  }
  return mask;
}

Mask TetComplex::labels_at(std::uint32_t vertex) const {
  Mask mask = 0;
  for (const std::uint32_t t : stars[vertex]) mask |= bit(labels[t]);
  return mask;
}

void TetComplex::neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& out) const {
  out.clear();
  for (const std::uint32_t t : stars[vertex]) {
    for (const std::uint32_t w : tets[t]) {
      if (w != vertex) out.push_back(w);
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
}

std::uint32_t TetComplex::split_edge(std::uint32_t u, std::uint32_t v, const Vec3d& at) {
  thread_local std::vector<std::uint32_t> around;
  around.clear();
  for (const std::uint32_t t : stars[u]) {
    if (has(t, v)) around.push_back(t);
  }
  const std::uint32_t m = add_vertex(at, edge_between(u, v));
  for (const std::uint32_t t : around) {
    const Label label = labels[t];
    Tet low = tets[t], high = tets[t];
    low[corner_of(low, v)] = m;
    high[corner_of(high, u)] = m;
    remove_tet(t);
    add_tet(low, label);
    add_tet(high, label);
  }
  return m;
}

void TetComplex::begin() {
  log_.clear();
  trying_ = true;
}

void TetComplex::keep() {
  for (const Change& c : log_) {
    if (c.kind == Change::Kind::added) note_tet(c.tet);
    if (c.kind == Change::Kind::moved) note_move(c.index);
  }
  log_.clear();
  trying_ = false;
}

void TetComplex::take_back() {
  const std::vector<Change> log = std::move(log_);  // undoing is noted in a log that nobody reads
  for (std::size_t i = log.size(); i-- > 0;) {
    const Change& c = log[i];
    switch (c.kind) {
      case Change::Kind::vertex:
        points.pop_back();
        stars.pop_back();
        masks.pop_back();
        edges.pop_back();
        changed.pop_back();
        break;
      case Change::Kind::added:
        remove_tet(c.index);
        break;
      case Change::Kind::removed:
        add_tet(c.tet, c.label);
        break;
      case Change::Kind::moved:
        points[c.index] = c.point;
        break;
      case Change::Kind::mask:
        masks[c.index] = c.mask;
        break;
    }
  }
  log_.clear();
  trying_ = false;
}

void TetComplex::touched(std::vector<std::uint32_t>& out) const {
  out.clear();
  for (const Change& c : log_) {
    if (c.kind == Change::Kind::added && alive(c.index)) out.push_back(c.index);
    if (c.kind == Change::Kind::moved) out.insert(out.end(), stars[c.index].begin(), stars[c.index].end());
  }
}

}  // namespace glisson::lattice
