// unloaded_shape.h — inverse statics: the shape that a body takes without its loads, from the one that it has under them.
//
//   loaded x (an image) ──▶ find_unloaded_shape ──▶ unloaded X ──▶ Simulation on X, set_state(x − X): equilibrium at x
//
// An organ in an image lies on its supports under its own weight. Taken as a shape at rest, it would sag by that weight once more.
#pragma once

#include <functional>
#include <stdexcept>
#include <vector>

#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

struct UnloadedOptions {
  /// Largest distance of a vertex of the loaded body from where it is to be, by the tangent there, over the body's size [-], > 0.
  double tolerance = 1e-9;
  int most_iterations = 60;     ///< at one share of the loads, ≥ 1
  double least_advance = 0.01;  ///< of the share of the loads: where it goes on by less, there is no unloaded shape [-]
};

struct UnloadedFigures {
  int iterations = 0;          ///< bodies at rest that were tried
  double off = 0.0;            ///< largest distance of the loaded body from the given one, by the tangent there [m]
  double largest_shift = 0.0;  ///< largest distance of a vertex from its unloaded place [m]
  double volume = 0.0, unloaded_volume = 0.0;  ///< of the loaded and of the unloaded body [m³]
};

struct UnloadedShape {
  std::vector<Vec3d> rest;  ///< per vertex [m]
  UnloadedFigures figures;
};

/// No unloaded shape was found. what() says at which share of the loads the search ended, why, and the ways out.
class NoUnloadedShape : public std::runtime_error {
 public:
  NoUnloadedShape(const std::string& what, double share) : std::runtime_error(what), share_(share) {}
  double share() const { return share_; }  ///< largest share of the loads with an unloaded shape [-]

 private:
  double share_;
};

/// Makes a body with all that acts on it.
/// @param rest   the mesh to be unloaded, at trial places at rest
/// @param share  of gravity and of loads that do not depend on the displacement [-], 0 to 1
/// @return a simulation of `quasi_static`, at time 0, no step made
using LoadedBody = std::function<Simulation(TetMesh rest, double share)>;

/// The shape X at rest of a body that is in static equilibrium at x under what acts on it at time 0:
///
///   f(x − X; X) + external(x − X; X) = 0 on the free components,   X = x on those that supports hold.
///
/// Forces, masses, areas and springs are those of the body at rest in X: springs to the ground and membranes without prestretch are
/// slack there. Branches have relaxed; tools, containers and other contact do not act. The iteration is
///
///   X ← X + (x − x̂(X)),   x̂(X) = x + K⁻¹ (f + external)    [Sellier2011]
///
/// with one Newton step from x in place of the equilibrium of each trial body, and Anderson's acceleration [WalkerNi2011]. It solves
/// the equations of [GovindjeeMihalic1996] for any law without the derivatives of its forces by places at rest.
/// Loads are applied in parts where all of them at once are too much.
/// @throws NoUnloadedShape; std::invalid_argument for options out of range, another integrator, supports that leave a rigid motion
///         free, and what `body` throws
/// Cost: a body built and a solve with a factor for each iteration, some 10 to 30: docs/image.md.
UnloadedShape find_unloaded_shape(const TetMesh& loaded, const LoadedBody& body, const UnloadedOptions& options = {});

}  // namespace glisson
