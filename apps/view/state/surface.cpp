// surface.cpp — see surface.h.
#include "view/state/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "glisson/material/shape_measure.h"
#include "glisson/tet_gradient.h"
#include "report/field_values.h"

namespace glisson::view {
namespace {

constexpr double kRim = 10.0;  // of the picture, in diagonals of the body
constexpr std::uint32_t kInside = std::numeric_limits<std::uint32_t>::max();

/// H of a tet from the displacements of its corners.
Mat3d gradient(const std::vector<Vec3d>& displacement, const Tet& tet, const std::array<Vec3d, 3>& s) {
  const Vec3d& u0 = displacement[tet[0]];
  return displacement_gradient<double>(
      s, {displacement[tet[1]] - u0, displacement[tet[2]] - u0, displacement[tet[3]] - u0});
}

}  // namespace

double diagonal(const TetMesh& mesh) {
  Vec3d low = mesh.vertices.front(), high = low;
  for (const Vec3d& x : mesh.vertices) {
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], x[k]);
      high[k] = std::max(high[k], x[k]);
    }
  }
  return norm(high - low);
}

Surface::Surface(std::shared_ptr<const BodyShape> shape, bool whole) : shape_(std::move(shape)) {
  number_vertices();
  if (whole) number_inside();
  count_pieces();
  rim_ = kRim * diagonal(shape_->mesh);
  const TetMesh& mesh = shape_->mesh;
  tets_around_.assign(vertices_.size(), 0.0);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& tet = mesh.tets[t];
    bool near = false;
    for (const std::uint32_t v : tet) {
      if (number_[v] == kInside) continue;
      tets_around_[number_[v]] += 1.0;
      near = true;
    }
    if (!near) continue;
    const std::vector<Vec3d>& x = mesh.vertices;
    near_.push_back({tet, t, element_rest({x[tet[0]], x[tet[1]], x[tet[2]], x[tet[3]]}).s});
  }
}

/// The boundary first: vertices of inner regions come after its own.
void Surface::number_vertices() {
  const TetMesh& mesh = shape_->mesh;
  number_.assign(mesh.vertices.size(), kInside);
  BodySurface surface = shape_->skin ? shape_->skin->surface(mesh) : SkinFaces(mesh).surface(mesh);
  mark_torn(surface, shape_->torn);
  triangles_ = numbered(surface.outer);
  outer_ = vertices_.size();
  for (const SurfaceKind kind : surface.kinds) kinds_.push_back(static_cast<std::uint8_t>(kind));
  for (const RegionSurface& region : surface.regions) regions_.push_back({region.name, numbered(region.triangles)});
  tissue_ = surface.tissue;
}

/// What no surface has, in the order of the tets.
void Surface::number_inside() {
  for (const Tet& tet : shape_->mesh.tets) {
    for (const std::uint32_t v : tet) tets_.push_back(number_of(v));
  }
}

/// A vertex's own number; a new one gets the next.
std::uint32_t Surface::number_of(std::uint32_t vertex) {
  if (number_[vertex] == kInside) {
    number_[vertex] = static_cast<std::uint32_t>(vertices_.size());
    vertices_.push_back(vertex);
  }
  return number_[vertex];
}

/// Triangles in surface vertices.
std::vector<std::uint32_t> Surface::numbered(const std::vector<Triangle>& triangles) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(3 * triangles.size());
  for (const Triangle& triangle : triangles) {
    for (const std::uint32_t v : triangle) numbers.push_back(number_of(v));
  }
  return numbers;
}

/// Sets of vertices that tets join.
void Surface::count_pieces() {
  std::vector<std::uint32_t> parent(shape_->mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<char> in_tet(parent.size(), 0);
  for (const Tet& tet : shape_->mesh.tets) {
    for (const std::uint32_t v : tet) {
      in_tet[v] = 1;
      parent[root(v)] = root(tet[0]);
    }
  }
  pieces_ = 0;
  for (std::uint32_t v = 0; v < parent.size(); ++v) pieces_ += in_tet[v] != 0 && parent[v] == v ? 1 : 0;
}

bool Surface::strays(const Snapshot& state) const {
  return std::any_of(vertices_.begin(), vertices_.end(),
                     [&](std::uint32_t v) { return norm(state.displacement[v]) > rim_; });
}

template <class OfTet>
std::vector<double> Surface::mean(OfTet of_tet) const {
  std::vector<double> sum(vertices_.size(), 0.0);
  for (std::size_t i = 0; i < near_.size(); ++i) {
    const double value = of_tet(i);
    for (const std::uint32_t v : near_[i].tet) {
      if (number_[v] != kInside) sum[number_[v]] += value;
    }
  }
  for (std::size_t i = 0; i < sum.size(); ++i) sum[i] /= std::max(1.0, tets_around_[i]);
  return sum;
}

std::vector<double> Surface::field(Field field, const Snapshot& state) {
  if (is_of_stress(field) && !state.tissues) return of_record(field, state);
  if (is_of_stress(field)) return of_stress(field, state);
  if (field == Field::contact_pressure) {
    std::vector<double> own(vertices_.size(), 0.0);
    for (std::size_t i = 0; i < own.size() && !state.contact_pressure.empty(); ++i)
      own[i] = state.contact_pressure[vertices_[i]];
    return own;
  }
  const auto blunt = [&](std::size_t i) {
    return one_minus_q(gradient(state.displacement, near_[i].tet, near_[i].gradients));
  };
  if (field == Field::shape) return mean([&](std::size_t i) { return 1.0 - blunt(i); });
  return mean([&](std::size_t i) { return intensity_of(blunt(i)); });
}

std::vector<double> Surface::of_stress(Field field, const Snapshot& state) {
  if (!near_fields_ || tissues_ != state.tissues) {
    std::vector<std::uint32_t> tets;
    for (const NearTet& x : near_) tets.push_back(x.number);
    near_fields_.emplace(shape_->mesh, *state.tissues, std::move(tets));
    tissues_ = state.tissues;
  }
  const std::size_t vertices = shape_->mesh.vertices.size();  // those that came after this shape are at its end
  const std::vector<Vec3d> at_rest(state.velocity.size() < vertices ? vertices : 0);
  const std::vector<Vec3d>& velocity = at_rest.empty() ? state.velocity : at_rest;
  const TetFields fields = near_fields_->fields(state.displacement, velocity, state.branches);
  const std::vector<double> values =
      field == Field::pressure ? pressure_of(fields.stress) : von_mises_of(fields.stress);
  return mean([&](std::size_t i) { return values[i]; });
}

/// What the frames of a recorded run say; 0 where they do not.
std::vector<double> Surface::of_record(Field field, const Snapshot& state) const {
  const std::vector<double>& values = field == Field::pressure ? state.pressure : state.von_mises;
  if (values.size() != shape_->mesh.tets.size()) return std::vector<double>(vertices_.size(), 0.0);
  return mean([&](std::size_t i) { return values[near_[i].number]; });
}

}  // namespace glisson::view
