// surface.cpp — see surface.h.
#include "view/surface.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/shape_measure.h"

namespace glisson::view {
namespace {

constexpr std::uint32_t kInside = std::numeric_limits<std::uint32_t>::max();

/// Rows of D_m⁻¹, D_m = [X₁ − X₀, X₂ − X₀, X₃ − X₀]: gradients of the shape functions of vertices 1, 2, 3.
std::array<Vec3d, 3> shape_gradients(const TetMesh& mesh, const Tet& tet) {
  const Vec3d &a = mesh.vertices[tet[0]], e1 = mesh.vertices[tet[1]] - a, e2 = mesh.vertices[tet[2]] - a,
              e3 = mesh.vertices[tet[3]] - a;
  const double six_volume = dot(e1, cross(e2, e3));
  const double inverse = six_volume != 0.0 ? 1.0 / six_volume : 0.0;
  return {cross(e2, e3) * inverse, cross(e3, e1) * inverse, cross(e1, e2) * inverse};
}

}  // namespace

Surface::Surface(std::shared_ptr<const BodyShape> shape) : shape_(std::move(shape)) {
  const TetMesh& mesh = shape_->mesh;
  number_.assign(mesh.vertices.size(), kInside);
  for (const Triangle& triangle : boundary_triangles(mesh)) {
    for (const std::uint32_t v : triangle) {
      if (number_[v] == kInside) {
        number_[v] = static_cast<std::uint32_t>(vertices_.size());
        vertices_.push_back(v);
      }
      triangles_.push_back(number_[v]);
    }
  }
  tets_around_.assign(vertices_.size(), 0.0);
  for (const Tet& tet : mesh.tets) {
    bool near = false;
    for (const std::uint32_t v : tet) {
      if (number_[v] == kInside) continue;
      tets_around_[number_[v]] += 1.0;
      near = true;
    }
    if (near) near_.push_back({tet, shape_gradients(mesh, tet)});
  }
}

std::vector<double> Surface::intensity(const std::vector<Vec3d>& displacement) const {
  std::vector<double> mean(vertices_.size(), 0.0);
  for (const auto& [tet, gradients] : near_) {
    Mat3d H;  // Σ u_a ⊗ ∂N_a/∂X, from differences
    for (std::size_t a = 0; a < 3; ++a) {
      const Vec3d u = displacement[tet[a + 1]] - displacement[tet[0]];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) H(i, j) += u[i] * gradients[a][j];
      }
    }
    const double s = intensity_of(one_minus_q(H));
    for (const std::uint32_t v : tet) {
      if (number_[v] != kInside) mean[number_[v]] += s;
    }
  }
  for (std::size_t i = 0; i < mean.size(); ++i) mean[i] /= std::max(1.0, tets_around_[i]);
  return mean;
}

}  // namespace glisson::view
