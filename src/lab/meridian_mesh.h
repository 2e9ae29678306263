// meridian_mesh.h — the meridian of a round body in quadratic elements, and what one of them answers.
//
//          z │   │   │  │ │
//            ├───┼───┼──┼─┤       Elements of 9 vertices in columns from the axis and rows from below. The volume change of
//      axis  │   │   │  │ │       an element is taken as linear in it, and its pressure is eliminated there
//            └───┴───┴──┴─┘ r     [SussmanBathe1987]: nearly incompressible tissues do not lock.
#pragma once

#include <array>
#include <vector>

#include "glisson/material/hyperelastic_law.h"

namespace glisson::lab {

struct MeridianElement {
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

/// The vertex of a column (from the axis) and a row (from below) is column × rows + row.
struct MeridianMesh {
  /// @param columns, rows  radii and heights of the vertices, ascending: ends and middles of elements in turn [m]
  MeridianMesh(std::vector<double> columns, std::vector<double> rows);

  std::vector<double> radii, heights;  ///< of columns and rows [m]
  std::vector<MeridianElement> elements;
  std::size_t columns() const { return radii.size(); }
  std::size_t rows() const { return heights.size(); }
};

/// Ends and middles of elements from 0 on. @param sizes  of the elements, in any unit @param length  of all of them [m]
std::vector<double> ends_and_middles(const std::vector<double>& sizes, double length);

}  // namespace glisson::lab
