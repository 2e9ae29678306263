// barrel_mesh.h — a quarter of a cylinder's meridian in quadratic elements, and what one of them answers.
//
//      plate ──────────────●      mirrored at the axis and at mid-height; elements of 9 vertices, smaller towards the
//            │   │   │  │ │       edge ●, where faces that stick have a singularity. The volume change of an element is
//            ├───┼───┼──┼─┤       taken as linear in it, and its pressure is eliminated there [SussmanBathe1987]:
//      axis  │   │   │  │ │       nearly incompressible tissues do not lock.
//            └───┴───┴──┴─┘
//              mid-height
#pragma once

#include <array>
#include <vector>

#include "glisson/material/hyperelastic_law.h"

namespace glisson::fit {

/// Elements along the radius and along half the height; each is `grading` times the one before it.
struct BarrelGrid {
  std::size_t radial = 4, axial = 3;
  double grading = 0.6;
};

struct BarrelElement {
  static constexpr std::size_t kVertices = 9, kPoints = 9, kUnknowns = 2 * kVertices;
  using Vector = std::array<double, kUnknowns>;  ///< u_r and u_z of each vertex in turn
  using Linear = std::array<double, 3>;          ///< of 1, ξ, η

  /// A point of quadrature at rest.
  struct Point {
    std::array<double, kVertices> by_r{}, by_z{}, by_hoop{};  ///< ∂N/∂R, ∂N/∂Z, N/R [1/m]
    double weight = 0.0;                                      ///< 2πR dA [m³]
    Linear linear{};                                          ///< 1, ξ, η
  };
  /// Pressure of the volume change: κ times its projection, and κ ∂/∂u of it.
  struct Pressure {
    Linear value{};
    std::array<Vector, 3> by_u{};
  };
  struct Answer {
    bool folded = false;
    Vector force{};                           ///< ∂W/∂u [N]
    std::array<Vector, kUnknowns> tangent{};  ///< [N/m]
    Pressure pressure;                        ///< [Pa]
  };

  std::array<std::size_t, kVertices> vertices{};
  std::array<Point, kPoints> points;
  std::array<Linear, 3> inverse{};  ///< of ∫ linear linearᵀ dV [1/m³]

  /// @param now  the pressure with which the tangent's geometric part is made; that of u where there is equilibrium
  Answer answer(const HyperelasticLaw& law, const Vector& u, const Linear& now) const;
};

/// The vertex of a column (from the axis) and a row (from mid-height) is column × rows + row.
struct BarrelMesh {
  BarrelMesh(double radius, double height, const BarrelGrid& grid = {});

  double height;
  std::vector<double> radii, heights;  ///< of columns and rows [m]
  std::vector<BarrelElement> elements;
  std::size_t columns() const { return radii.size(); }
  std::size_t rows() const { return heights.size(); }
};

}  // namespace glisson::fit
