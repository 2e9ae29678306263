// barrel.h — a cylinder between plates on which it slides with friction or not at all: pressed it bulges, pulled it necks in, and
// it resists more than one that deforms alike all over.
//
//   face   u_r = s R: it spreads alike all over, by less than it would on smooth plates. With P_rz the traction on it and
//          F the force on it, Coulomb's friction, made smooth, balances it over the face [docs/fit.md]:
//             ∫ P_rz R dA + ⅔ R₀ (τ A + f F) g = 0,   g = x/√(1 + x²),   x = s/(0.02 s₀),   s₀ = λ^(−½) − 1
//          with A its area at rest and τ what a tacky face bears without pressure
//   side   where it bulges over the edge it comes to lie on the plate, without friction there
//
//      plate ──────────────●      a quarter of its meridian, mirrored at the axis and at mid-height, with elements that are
//            ├───┼───┼──┼─┤       smaller towards the edge ●, where faces that stick have a singularity
//      axis  └───┴───┴──┴─┘ mid-height
//
// Newton's method from rest on, the pressures of the elements beside the displacements; steps are halved where it does not
// converge. The state is a function of the displacement alone: friction is that of a compression that goes on. A specimen that
// is pulled has been glued: then its side touches nothing, and no face slides.
#pragma once

#include <memory>
#include <vector>

#include "lab/grip.h"
#include "lab/meridian_solid.h"

namespace glisson::lab {

/// Elements along the radius and along half the height; each is `grading` times the one before it.
struct BarrelGrid {
  std::size_t radial = 4, axial = 3;
  double grading = 0.6;
};

struct BarrelMesh : MeridianMesh {
  BarrelMesh(double radius, double height, const BarrelGrid& grid = {});

  double height;  ///< of the whole cylinder [m]
};

class Barrel {
 public:
  /// @param grip  with Faces::friction alone
  Barrel(std::shared_ptr<const BarrelMesh> mesh, const HyperelasticLaw& law, Faces faces, Grip grip = {});

  /// Goes on to a displacement of the plates towards each other beyond the last; below 0 they part [m].
  /// @param pressure  about that of the plate, by which it carries the side [Pa]
  /// @return the force of the plate [N], > 0 where it presses
  /// @throws std::runtime_error where no equilibrium is found, std::invalid_argument where faces of friction are pulled
  double press(double displacement, double pressure);
  /// s of the last state [-].
  double spread() const { return state_.spread; }

 private:
  struct State {
    double displacement = 0.0, spread = 0.0;
    MeridianState body;
  };
  /// What the face's balance lacks, with its derivatives by s and u.
  struct Balance {
    double rest = 0.0, by_spread = 0.0;
    std::vector<double> by_u;
  };

  State predicted(double displacement) const;
  bool converge();
  void put_on_plates();
  bool assemble();
  void lean();
  Balance face_balance() const;
  void add_friction(Balance& face) const;
  double solve_step(Balance& face, std::vector<double>& step);
  double face_force() const;
  std::size_t face_vertex(std::size_t column) const { return (column + 1) * mesh_->rows() - 1; }

  std::shared_ptr<const BarrelMesh> mesh_;
  MeridianSolid solid_;
  Faces faces_;
  Grip grip_;
  State state_;
  std::vector<State> past_;  ///< the last states, the newest at the end
  double pressure_ = 0.0;    ///< about that of the plate [Pa]
  double side_force_ = 0.0;  ///< of the plate on the side in the last assembly [N]
};

}  // namespace glisson::lab
