// radio_frequency.h — current between electrodes, which heats the tissue that it goes through.
//
//   ∇·(σ(T) ∇φ) = 0,   φ = U at the electrode, 0 at the ground, no current through the rest of the surface
//   heat per volume    σ |∇φ|²                                                                     [Chang2003]
//
// At the frequencies in use, near 500 kHz, the field follows the current at once; U is the effective value. Linear elements, σ the
// mean of its values at the corners of a tet; what the tets take is the current times the voltage to rounding. σ is that of
// the temperatures at the start of a step.
#pragma once

#include <cstdint>
#include <vector>

#include "glisson/archive.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/time_function.h"

namespace glisson {

/// One of `voltage` and `power` is given.
struct RadioFrequency {
  std::vector<std::uint32_t> electrode, ground;  ///< vertices, none in both
  TimeFunction<double> voltage{};                ///< U, effective [V]
  TimeFunction<double> power{};                  ///< of all heat in the body, ≥ 0 [W]
};

/// Of the last step; before the first all is 0.
struct RadioState {
  std::vector<double> potential;  ///< at each vertex for 1 V at the electrode [-]; 0 where no current goes
  double voltage = 0.0;           ///< effective [V]
  double power = 0.0;             ///< [W]
  double resistance = 0.0;        ///< between electrode and ground [Ω]

  void archive(Archive& ar) { ar(potential, voltage, power, resistance); }
};

/// Vertices that stand for a needle: those of the tets that its axis passes through, and all within its radius. On a mesh that is
/// coarser than the needle its width is that of the mesh.
/// @param from,to  ends of its bare part [m] @param radius  ≥ 0 [m] @throws std::invalid_argument where it leaves the body
std::vector<std::uint32_t> needle_vertices(const TetMesh& mesh, const Vec3d& from, const Vec3d& to, double radius);

}  // namespace glisson
