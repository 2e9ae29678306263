#include "dynamics/state/loads.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "base/require_fields.h"

namespace glisson {
namespace {

/// Adds to a field that is empty as long as it is 0.
void add_to(std::vector<Vec3d>& field, std::size_t size, std::size_t vertex, const Vec3d& value) {
  if (value == Vec3d{}) return;
  if (field.empty()) field.resize(size);
  field[vertex] += value;
}

void require_vertices(std::span<const std::uint32_t> vertices, std::size_t count) {
  if (vertices.empty()) throw std::invalid_argument("load: the vertex set is empty; name at least one vertex");
  for (const std::uint32_t v : vertices) {
    if (v < count) continue;
    throw std::invalid_argument("load: vertex " + std::to_string(v) + " is outside the mesh, 0 to " +
                                std::to_string(count - 1));
  }
}

Corners present(const Body& body, const LoadedFace& face, std::span<const Vec3d> u) {
  Corners x;
  const auto v = corners_of(body, face);
  for (std::size_t a = 0; a < 3; ++a) x[a] = body.rest_positions[v[a]] + (u.empty() ? Vec3d{} : u[v[a]]);
  return x;
}

std::vector<Corners> all_present(const Body& body, std::span<const LoadedFace> faces, std::span<const Vec3d> u) {
  std::vector<Corners> all;
  for (const LoadedFace& face : faces) {
    if (is_there(body, face)) all.push_back(present(body, face, u));
  }
  return all;
}

/// What acts per area of a face at rest [Pa], pressure included.
Vec3d traction_on(const SurfaceLoad& load, const Corners& rest) {
  return load.traction - unit(area_vector(rest)) * load.pressure;
}

/// Whether a vertex belongs to a tet that is there.
bool bears(const Body& body, std::uint32_t vertex) { return body.masses[vertex] > 0.0; }

/// 1 over the shares of vertices that bear: those that do not leave theirs to the others, in proportion to their own. 1 where all
/// bear, to the last digit; 0 where none does, so that nothing acts.
double over_shares_borne(const Body& body, std::span<const std::uint32_t> vertices, std::span<const double> share) {
  double borne = 0.0;
  bool all = true;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (bears(body, vertices[k])) {
      borne += share[k];
    } else {
      all = false;
    }
  }
  if (all) return 1.0;
  return borne > 0.0 ? 1.0 / borne : 0.0;
}

std::string no_bearer(std::size_t vertices) {
  return "load: none of the " + std::to_string(vertices) + (vertices == 1 ? " vertex" : " vertices") +
         " of the set belongs to a tet (removed ones do not count), so that it would act on nothing; name a set of "
         "vertices of the body";
}

std::string no_face(std::size_t vertices) {
  return "load: the set of " + std::to_string(vertices) + (vertices == 1 ? " vertex" : " vertices") +
         " spans no face of the body's surface: no face has all three corners in it. Traction, pressure, moment, "
         "spring_Pa_m and dashpot_Pa_s_m act on faces; choose a set that has whole faces, or give a force, a spring "
         "[N/m] or a dashpot [N s/m], which act on single vertices, too";
}

}  // namespace

Fault SurfaceLoad::check() const {
  const bool others = force != Vec3d{} || spring != Vec3d{} || dashpot != Vec3d{} || spring_per_area != Vec3d{} ||
                      dashpot_per_area != Vec3d{};
  if (!follows || !others || has_traction()) return {};
  return {
      "= true is for traction, pressure and moment, none of which is given; a force keeps its direction, springs "
      "and dashpots theirs",
      "follows"};
}

std::vector<std::uint32_t> Loads::add(const Body& body, std::span<const std::uint32_t> vertices,
                                      const SurfaceLoad& what, TimeFunction<double> scale) {
  require_vertices(vertices, force_.size());
  detail::require_fields("load", what);
  Load load;
  load.what = what, load.scale = std::move(scale);
  load.vertices.assign(vertices.begin(), vertices.end());
  std::sort(load.vertices.begin(), load.vertices.end());
  load.vertices.erase(std::unique(load.vertices.begin(), load.vertices.end()), load.vertices.end());
  if (std::none_of(load.vertices.begin(), load.vertices.end(), [&](auto v) { return bears(body, v); })) {
    throw std::invalid_argument(no_bearer(load.vertices.size()));
  }
  load.share.assign(load.vertices.size(), 1.0 / static_cast<double>(load.vertices.size()));
  if (what.needs_faces()) load.faces = spanned_faces(body, load.vertices);
  if (what.needs_faces() && load.faces.empty()) throw std::invalid_argument(no_face(load.vertices.size()));
  loads_.push_back(std::move(load));
  prepare(loads_.back(), body);
  size_rows(body);
  return loads_.back().vertices;
}

void Loads::take_back_last(const Body& body) {
  loads_.pop_back();
  body_changed(body);
}

void Loads::add_copies(std::span<const std::uint32_t> origins) {
  const auto first = static_cast<std::uint32_t>(force_.size());
  force_.resize(force_.size() + origins.size());
  for (Load& load : loads_) {
    const std::size_t before = load.vertices.size();
    for (std::size_t k = 0; k < before; ++k) {
      const auto copies = std::count(origins.begin(), origins.end(), load.vertices[k]);
      if (copies == 0) continue;
      load.share[k] /= static_cast<double>(copies + 1);
      for (std::uint32_t i = 0; i < origins.size(); ++i) {
        if (origins[i] != load.vertices[k]) continue;
        load.vertices.push_back(first + i);
        load.share.push_back(double(load.share[k]));
      }
    }
  }
}

/// Areas at rest per corner.
void Loads::measure(Load& load, const Body& body) const {
  load.corners.clear(), load.area.clear();
  if (load.faces.empty()) return;
  std::vector<double> area(body.vertex_count, 0.0);
  for (const LoadedFace& face : load.faces) {
    if (!is_there(body, face)) continue;
    const double third = norm(area_vector(present(body, face, {}))) / 3.0;
    for (const std::uint32_t v : corners_of(body, face)) {
      if (area[v] == 0.0) load.corners.push_back(v);
      area[v] += third;
    }
  }
  std::sort(load.corners.begin(), load.corners.end());
  for (const std::uint32_t v : load.corners) load.area.push_back(double(area[v]));
}

/// Forces on the corners of what does not follow.
void Loads::take_dead(Load& load, const Body& body) const {
  load.dead.clear();
  if (load.what.follows || !load.what.has_traction()) return;
  const std::vector<Corners> rest = all_present(body, load.faces, {});
  if (rest.empty()) return;
  std::vector<Vec3d> force(body.vertex_count);
  const MomentTraction moment(load.what.moment, rest);
  for (const LoadedFace& face : load.faces) {
    if (!is_there(body, face)) continue;
    const Corners x = present(body, face, {});
    const Vec3d third = traction_on(load.what, x) * (norm(area_vector(x)) / 3.0);
    const std::array<Vec3d, 3> turning = moment.forces(x);
    const auto v = corners_of(body, face);
    for (std::size_t a = 0; a < 3; ++a) force[v[a]] += third + turning[a];
  }
  for (const std::uint32_t v : load.corners) load.dead.push_back(Vec3d(force[v]));
}

/// What of a load follows from the body: areas, forces at rest, its springs and dashpots per vertex.
void Loads::prepare(Load& load, const Body& body) {
  measure(load, body);
  take_dead(load, body);
  const SurfaceLoad& what = load.what;
  const double all = over_shares_borne(body, load.vertices, load.share);
  const Vec3d spring = what.spring * all, dashpot = what.dashpot * all;
  for (std::size_t k = 0; k < load.vertices.size(); ++k) {
    if (!bears(body, load.vertices[k])) continue;
    add_to(spring_, body.vertex_count, load.vertices[k], spring * load.share[k]);
    add_to(dashpot_, body.vertex_count, load.vertices[k], dashpot * load.share[k]);
  }
  for (std::size_t k = 0; k < load.corners.size(); ++k) {
    add_to(spring_, body.vertex_count, load.corners[k], what.spring_per_area * load.area[k]);
    add_to(dashpot_, body.vertex_count, load.corners[k], what.dashpot_per_area * load.area[k]);
  }
}

void Loads::size_rows(const Body& body) {
  follows_ = std::any_of(loads_.begin(), loads_.end(), [](const Load& load) { return load.follows(); });
  row_.assign(follows_ ? body.vertex_count : 0, 0.0);
}

void Loads::body_changed(const Body& body) {
  force_.resize(body.vertex_count);
  spring_.clear(), dashpot_.clear();
  for (Load& load : loads_) prepare(load, body);
  size_rows(body);
}

void Loads::archive(Archive& ar, const Body& body) {
  auto count = static_cast<std::uint64_t>(loads_.size());
  ar(count);
  ar.check(count == loads_.size());
  for (Load& load : loads_) {
    const std::vector<std::uint32_t> here = load.vertices;
    ar.all_below(load.vertices, body.vertex_count);
    ar(load.share);
    ar.check(load.share.size() == load.vertices.size() && here.size() <= load.vertices.size());
    ar.check(std::equal(here.begin(), here.end(), load.vertices.begin()));
  }
  if (ar.reads()) body_changed(body);
  ar.same_size(row_);
}

/// Forces of what follows, and how stiff it is.
void Loads::follow(const Load& load, double scale, const Body& body, std::span<const Vec3d> u) {
  for (const LoadedFace& face : load.faces) {
    if (!is_there(body, face)) continue;
    const Corners x = present(body, face, u), rest = present(body, face, {});
    const TurningTraction traction(load.what.traction * scale, load.what.pressure * scale, rest);
    const Vec3d force = traction.force(x);
    const double stiffness = traction.stiffness(x);
    for (const std::uint32_t v : corners_of(body, face)) force_[v] += force, row_[v] += stiffness;
  }
  if (load.what.moment == Vec3d{}) return;
  const std::vector<Corners> all = all_present(body, load.faces, u);
  if (all.empty()) return;
  const MomentTraction moment(load.what.moment * scale, all);
  for (const LoadedFace& face : load.faces) {
    if (!is_there(body, face)) continue;
    const Corners x = present(body, face, u);
    const std::array<Vec3d, 3> forces = moment.forces(x);
    const double stiffness = moment.stiffness(x);
    const auto v = corners_of(body, face);
    for (std::size_t a = 0; a < 3; ++a) force_[v[a]] += forces[a], row_[v[a]] += stiffness;
  }
}

std::span<const Vec3d> Loads::at(double time, const Body& body, std::span<const Vec3d> u) {
  if (loads_.empty()) return force_;
  std::fill(force_.begin(), force_.end(), Vec3d{});
  std::fill(row_.begin(), row_.end(), 0.0);
  for (const Load& load : loads_) {
    const double scale = load.scale ? load.scale(time) : 1.0;
    if (load.what.force != Vec3d{}) {
      const Vec3d f = load.what.force * scale * over_shares_borne(body, load.vertices, load.share);
      for (std::size_t k = 0; k < load.vertices.size(); ++k) {
        if (bears(body, load.vertices[k])) force_[load.vertices[k]] += f * load.share[k];
      }
    }
    for (std::size_t k = 0; k < load.dead.size(); ++k) force_[load.corners[k]] += load.dead[k] * scale;
    if (load.follows()) follow(load, scale, body, u);
  }
  for (std::size_t v = 0; v < spring_.size(); ++v) force_[v] -= component_product(spring_[v], u[v]);
  return force_;
}

std::span<const FaceStiffness> Loads::stiffness(double time, const Body& body, std::span<const Vec3d> u) {
  stiffness_.clear();
  for (const Load& load : loads_) {
    if (!load.follows()) continue;
    const double scale = load.scale ? load.scale(time) : 1.0;
    for (const LoadedFace& face : load.faces) {
      if (!is_there(body, face)) continue;
      const Corners rest = present(body, face, {});
      const TurningTraction traction(load.what.traction * scale, load.what.pressure * scale, rest);
      stiffness_.push_back({corners_of(body, face), traction.slope(present(body, face, u))});
    }
  }
  return stiffness_;
}

double Loads::next_corner(double after) const {
  double first = std::numeric_limits<double>::infinity();
  for (const Load& load : loads_) first = std::min(first, load.scale.corners.after(after));
  return first;
}

double Loads::squared_frequency(const Body& body) const {
  double most = 0.0;
  for (std::size_t v = 0; v < std::max(spring_.size(), row_.size()); ++v) {
    if (!(body.masses[v] > 0.0)) continue;
    const Vec3d k = spring(v);
    const double row = (row_.empty() ? 0.0 : row_[v]) + std::max({k.x, k.y, k.z});
    most = std::max(most, row / body.masses[v]);
  }
  return most;
}

}  // namespace glisson
