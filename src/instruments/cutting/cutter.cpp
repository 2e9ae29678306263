// cutter.cpp — one advance of a blade: crossings ─▶ faces that part ─▶ vertices onto the path ─▶ the body changed.
#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "base/require_fields.h"
#include "dynamics/simulation_parts.h"
#include "dynamics/state/checkpoint.h"
#include "dynamics/step/element_step_bound.h"
#include "dynamics/step/stable_step.h"
#include "glisson/instruments/cutting.h"
#include "instruments/cutting/blade_view.h"
#include "mesh/cut/cut_snap.h"
#include "mesh/topology/faces.h"

namespace glisson {
namespace {

constexpr double kNearest = 1e-5;     ///< of a typical edge: ways shorter than that are not gone
constexpr double kSupport = 1e-6;     ///< weight from which a corner bears what a vertex becomes
constexpr double kSetSupport = 0.25;  ///< the same for named sets, on faces that are not flat
constexpr int kPasses = 2;            ///< over the vertices: what one gives way to may be another

void require_finite(const BladeEdge& edge) {
  if (std::isfinite(norm(edge.from)) && std::isfinite(norm(edge.to))) return;
  throw std::invalid_argument("cutter: an end of the blade's edge is not finite; give two points in metres");
}

/// The part of the path within a tet: a triangle or quadrilateral.
struct PathPiece {
  Vec3d area, middle;
};

/// Restricts [low, high] to where a + s b ≥ 0.
void clip(double a, double b, double& low, double& high) {
  if (b > 0.0) low = std::max(low, -a / b);
  if (b < 0.0) high = std::min(high, -a / b);
  if (b == 0.0 && a < 0.0) high = low - 1.0;
}

}  // namespace

struct Cutter::Impl {
  SimulationParts::Inside& simulation;
  Scheme& scheme;
  CutOptions options;
  BladeView view;
  detail::CutSheet sheet;
  std::vector<char> doubled;   ///< per vertex: split by this cut already, so that it stays where it is
  std::vector<double> spread;  ///< largest of a tet, by tissue [1/m²]
  BladeEdge edge{};
  bool placed = false;

  Impl(Simulation& s, const CutOptions& o)
      : simulation(SimulationParts::inside(s)), scheme(SimulationParts::scheme(s)), options(o), view(scheme),
        sheet(scheme.body().elements.size(), scheme.body().vertex_count), doubled(scheme.body().vertex_count, 0) {
    limit_spread(scheme.capabilities().viscosity_limits_step ? 1.0 : 0.0);
  }

  std::array<Vec3d, 4> corners_at_rest(std::size_t e) const {
    const Body& body = scheme.body();
    std::array<Vec3d, 4> x;
    for (std::size_t c = 0; c < 4; ++c) x[c] = body.rest_positions[body.elements[e][c]];
    return x;
  }

  void archive(Archive& ar);
  void limit_spread(double viscosity);
  void follow();
  PathPiece piece_in(std::uint32_t tet) const;
  bool may_become(std::uint32_t vertex, const Tet& tet, const std::array<double, 4>& weights) const;
  std::vector<VertexMove> snap(const std::vector<std::uint32_t>& vertices, CutReport& report) const;
  void open(const detail::CutFaces& cut, CutReport& report);
  std::vector<EdgePiece> pieces(const BladeEdge& at, const BladeView& seen) const;
};

/// Finds how spread the gradients of a tet of each tissue may be, so that its bound of the step is least_step times that
/// of the body.
void Cutter::Impl::limit_spread(double viscosity) {
  const Body& body = scheme.body();
  const std::vector<double> factors(body.blocks.size(), viscosity);
  const double step = options.least_step * ElementStepBound(body, scheme.stars(), factors).step();
  for (const TissueBlock& block : body.blocks) {
    std::size_t e = block.begin;
    while (e + 1 < block.end && !(body.rest[e].volume > 0.0)) ++e;
    const double some = body.rest[e].volume > 0.0 ? detail::spread_of(corners_at_rest(e)) : 0.0;
    spread.push_back(some > 0.0 ? some / mass_factor_for(body, block, e, step, viscosity) : 0.0);
  }
}

/// Takes in copies that have come.
void Cutter::Impl::follow() {
  const std::span<const std::uint32_t> copies = scheme.state().copies;
  const std::size_t now = scheme.body().vertex_count, known = doubled.size();
  const auto fresh = copies.subspan(copies.size() - (now - known));
  sheet.add_copies(fresh);
  doubled.resize(now, 1);
  for (const std::uint32_t origin : fresh) doubled[origin] = 1;
  view.follow_copies();
}

/// Of a tet gone through, in the body as it was at first.
PathPiece Cutter::Impl::piece_in(std::uint32_t tet) const {
  const detail::CutTet& cut = *sheet.find(tet);
  const Tet& t = scheme.body().elements[tet];
  const auto point = [&](std::size_t a, std::size_t b) {
    for (std::size_t k = 0; k < 6; ++k) {
      const auto [p, q] = detail::kEdgeCorners[k];
      const Vec3d x = view.first_rest()[t[p]], y = view.first_rest()[t[q]];
      if ((p == a && q == b) || (p == b && q == a)) return x + (y - x) * cut.at[k];
    }
    return Vec3d{};
  };
  std::vector<std::size_t> here, there;
  for (std::size_t c = 0; c < 4; ++c) ((cut.stays >> c & 1U) != 0 ? here : there).push_back(c);
  if (here.size() == 2) {
    const Vec3d a = point(here[0], there[0]), b = point(here[0], there[1]), c = point(here[1], there[1]),
                d = point(here[1], there[0]);
    return {detail::area_vector({a, b, c}) + detail::area_vector({a, c, d}), (a + b + c + d) * 0.25};
  }
  if (here.size() > 2) std::swap(here, there);
  const Vec3d a = point(here[0], there[0]), b = point(here[0], there[1]), c = point(here[0], there[2]);
  return {detail::area_vector({a, b, c}), (a + b + c) * (1.0 / 3.0)};
}

/// A vertex that is held or in a named set stays among vertices that are so, too.
bool Cutter::Impl::may_become(std::uint32_t vertex, const Tet& tet, const std::array<double, 4>& weights) const {
  const Body& body = scheme.body();
  if (!body.mass_factor.empty()) return false;
  const Constraints& constraints = scheme.state().constraints;
  const auto all_in = [&](double support, const auto& has) {
    for (std::size_t c = 0; c < 4; ++c) {
      if (weights[c] > support && tet[c] != vertex && !has(tet[c])) return false;
    }
    return true;
  };
  const bool held = constraints.holds(vertex, 0) || constraints.holds(vertex, 1) || constraints.holds(vertex, 2);
  for (std::size_t k = 0; held && k < constraints.all().size(); ++k) {
    const std::vector<std::uint32_t>& list = constraints.all()[k].vertices;
    const auto has = [&](std::uint32_t v) { return std::find(list.begin(), list.end(), v) != list.end(); };
    if (has(vertex) && !all_in(kSupport, has)) return false;
  }
  for (const auto& named : SimulationParts::mesh(simulation).vertex_sets) {
    const std::vector<std::uint32_t>& set = named.second;
    const auto has = [&](std::uint32_t v) { return std::binary_search(set.begin(), set.end(), v); };
    if (has(vertex) && !all_in(kSetSupport, has)) return false;
  }
  return true;
}

/// Moves vertices of faces that part onto the path.
std::vector<VertexMove> Cutter::Impl::snap(const std::vector<std::uint32_t>& vertices, CutReport& report) const {
  const Body& body = scheme.body();
  const detail::SnapMesh mesh{
      .tets = body.elements,
      .stars = scheme.stars(),
      .rest = body.rest_positions,
      .displacement = scheme.displacement(),
      .root = view.root(),
      .tissue = [&](std::uint32_t e) { return static_cast<std::size_t>(&body.block_of(e) - body.blocks.data()); },
      .may_become = [this](std::uint32_t v, const Tet& tet, const auto& w) { return may_become(v, tet, w); }};
  detail::CutSnap snap(mesh, {options.least_quality, spread, kNearest * view.typical_edge()});
  std::vector<double> left(vertices.size(), 0.0);
  for (int pass = 0; pass < kPasses; ++pass) {
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      Vec3d normal{}, middle{};
      double weight = 0.0;
      for (const std::uint32_t e : scheme.stars().tets_at(vertices[i])) {
        const detail::CutTet* cut = sheet.find(e);
        if (cut == nullptr || !cut->through) continue;
        const PathPiece piece = piece_in(e);
        const double area = norm(piece.area);
        normal += dot(normal, piece.area) < 0.0 ? -piece.area : piece.area;
        middle += piece.middle * area;
        weight += area;
      }
      if (!(norm(normal) > 0.0)) continue;
      const Vec3d n = unit(normal), p = middle * (1.0 / weight);
      if (pass > 0 && left[i] == 0.0) continue;
      left[i] = options.snap ? snap.bring(vertices[i], p, n) : std::abs(dot(n, p - body.rest_positions[vertices[i]]));
    }
  }
  std::set<std::uint32_t> moved;
  for (const VertexMove& m : snap.moves()) moved.insert(m.vertex);
  report.moved_vertices = moved.size();
  for (const double way : left) {
    report.held_back += way > kNearest * view.typical_edge() ? 1 : 0;
    report.largest_offset = std::max(report.largest_offset, way);
  }
  return snap.moves();
}

/// Moves vertices, parts the faces and lets all that is kept follow.
void Cutter::Impl::open(const detail::CutFaces& cut, CutReport& report) {
  report.tets = cut.through.size();
  for (const std::uint32_t e : cut.through) report.area += norm(piece_in(e).area);
  if (cut.faces.empty()) return;
  std::set<Triangle> faces;
  std::set<std::uint32_t> vertices;
  for (Triangle f : cut.faces) {
    std::sort(f.begin(), f.end());
    if (!faces.insert(f).second) continue;
    for (const std::uint32_t v : f) {
      if (doubled[v] == 0) vertices.insert(v);
    }
  }
  const std::vector<VertexMove> moves = snap({vertices.begin(), vertices.end()}, report);
  const std::vector<Triangle> parted(faces.begin(), faces.end());
  report.new_vertices = SimulationParts::split_faces(simulation, parted, moves).origins.size();
  report.faces = parted.size();
  const std::vector<Vec3d>& x = SimulationParts::mesh(simulation).vertices;
  for (const Triangle& f : parted) report.faces_area += norm(detail::area_vector({x[f[0]], x[f[1]], x[f[2]]}));
  follow();
}

Cutter::Cutter(Simulation& simulation, const CutOptions& options) {
  SimulationParts::refuse_inside_step(SimulationParts::inside(simulation), "Cutter");
  detail::require_fields("cutter", options);
  impl_ = std::make_unique<Impl>(simulation, options);
}

Cutter::~Cutter() = default;
Cutter::Cutter(Cutter&&) noexcept = default;
Cutter& Cutter::operator=(Cutter&&) noexcept = default;

void Cutter::place(const BladeEdge& edge) {
  require_finite(edge);
  Impl& me = *impl_;
  SimulationParts::refuse_inside_step(me.simulation, "Cutter::place");
  me.follow();
  me.sheet.begin_another();
  std::fill(me.doubled.begin(), me.doubled.end(), char{0});
  me.edge = edge;
  me.placed = true;
  me.view.look(edge, edge, me.scheme.displacement());
  me.view.step_on();
}

CutReport Cutter::advance(const BladeEdge& edge) {
  require_finite(edge);
  Impl& me = *impl_;
  SimulationParts::refuse_inside_step(me.simulation, "Cutter::advance");
  if (!me.placed) throw std::invalid_argument("cutter: the blade is nowhere yet; call place() before advance()");
  me.follow();
  me.view.step_on();
  me.view.look(me.edge, edge, me.scheme.displacement());
  const Body& body = me.scheme.body();
  CutReport report;
  me.open(me.sheet.take(body.elements, me.scheme.stars(), me.view.crossings(me.edge, edge)), report);
  me.edge = edge;
  return report;
}

/// The pieces of an edge in tissue that has not been cut through, in the body as it is seen.
std::vector<EdgePiece> Cutter::Impl::pieces(const BladeEdge& at, const BladeView& seen) const {
  const Body& body = scheme.body();
  const Vec3d a = at.from, d = at.to - a;
  const double length = norm(d);
  std::vector<EdgePiece> all;
  if (!placed || !(length > 0.0)) return all;
  for (const std::uint32_t e : seen.near()) {
    const detail::CutTet* cut = sheet.find(e);
    if (cut != nullptr && cut->through) continue;
    std::array<Vec3d, 4> x;
    for (std::size_t c = 0; c < 4; ++c) x[c] = seen.now()[body.elements[e][c]];
    const ElementRest shape = element_rest(x);
    if (!(shape.volume > 0.0)) continue;
    std::array<double, 4> start{1.0}, rate{};
    for (std::size_t c = 1; c < 4; ++c) {
      start[c] = dot(shape.s[c - 1], a - x[0]), rate[c] = dot(shape.s[c - 1], d);
      start[0] -= start[c], rate[0] -= rate[c];
    }
    double low = 0.0, high = 1.0;
    for (std::size_t c = 0; c < 4; ++c) clip(start[c], rate[c], low, high);
    if (high <= low) continue;
    EdgePiece piece{body.mesh_tet[e], (high - low) * length, {}};
    for (std::size_t c = 0; c < 4; ++c) piece.weights[c] = start[c] + 0.5 * (low + high) * rate[c];
    all.push_back(piece);
  }
  return all;
}

std::vector<EdgePiece> Cutter::contact() const { return impl_->pieces(impl_->edge, impl_->view); }

std::vector<EdgePiece> Cutter::contact(const BladeEdge& edge, std::span<const ActiveVertex> moved) const {
  require_finite(edge);
  const std::span<const Vec3d> present = impl_->scheme.displacement();
  std::vector<Vec3d> u(present.begin(), present.end());
  for (const ActiveVertex& w : moved) u[w.vertex] = w.displacement;
  BladeView seen = impl_->view;
  seen.follow_copies();
  seen.look(edge, edge, u);
  return impl_->pieces(edge, seen);
}

const BladeEdge& Cutter::edge() const { return impl_->edge; }

void Cutter::Impl::archive(Archive& ar) {
  ar(edge.from, edge.to, placed);
  ar.same_size(spread), ar.same_size(doubled);
  ar(sheet, view);
}

void Cutter::archive(Archive& ar) {
  if (!ar.reads()) return impl_->archive(ar);
  auto read = std::make_unique<Impl>(*impl_);
  read->follow();
  read->archive(ar);
  impl_ = std::move(read);
}

std::shared_ptr<const void> Cutter::save_state() const { return std::make_shared<const Impl>(*impl_); }

void Cutter::load_state(const std::shared_ptr<const void>& state) {
  impl_ = std::make_unique<Impl>(*std::static_pointer_cast<const Impl>(state));
}

void Cutter::save(std::ostream& out) const {
  Archive contents;
  impl_->archive(contents);
  write_checkpoint(contents, out);
}

void Cutter::load(std::istream& in) {
  SimulationParts::refuse_inside_step(impl_->simulation, "Cutter::load");
  Archive contents = read_checkpoint(in);
  archive(contents);
  contents.check(contents.left() == 0);
}

}  // namespace glisson
