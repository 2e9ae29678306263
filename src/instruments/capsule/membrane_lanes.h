// membrane_lanes.h — the triangles of a sheet in blocks of eight, side by side for vectors of any width.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "glisson/math.h"

namespace glisson {

/// Eight triangles: rest data, and what the last step has found. Natural edges in the plane of a triangle are
/// ((1/g00, −g01/(g00 g11)), (0, 1/g11)) by columns. Places without a triangle have area 0 and its corners at vertex 0.
struct alignas(64) MembraneBlock {
  static constexpr std::size_t kSize = 8;
  using Lanes = std::array<double, kSize>;

  Lanes g00{}, g01{}, g11{};     ///< [1/m]
  Lanes area{};                  ///< natural area times the share of stiffness kept [m²]
  Lanes rate{};                  ///< of MembraneSums::frequency [1/kg]
  Lanes modulus{};               ///< k of the last step; 0 where nothing is borne [N/m]
  std::array<Lanes, 3> above{};  ///< per corner: D of k D, above the tangent [-]
  Lanes squared_tension{};       ///< of the largest principal value of |F S|, per natural width [N²/m²]
  std::array<std::array<std::uint32_t, kSize>, 3> corner{};
};

/// Constants of a law that the loop over triangles needs.
struct MembraneFactors {
  double stiffness, nu, alpha, shear, bulk, modulus, most_exponent;
};

/// Largest values over all triangles that bear something.
struct MembraneSums {
  double frequency = 0.0;        ///< modulus times rate
  double modulus = 0.0;          ///< [N/m]
  double squared_tension = 0.0;  ///< [N²/m²]
};

/// Adds the forces of the sheet. The same bytes for any width of vectors, where the law does not stiffen.
using MembraneForces = MembraneSums (*)(const MembraneFactors& factors, MembraneBlock* blocks, std::size_t count,
                                        const Vec3d* positions, Vec3d* forces);

/// The kernel for the machine it runs on. @param stiffens  whether alpha is not 0
MembraneForces membrane_forces(bool stiffens);

}  // namespace glisson
