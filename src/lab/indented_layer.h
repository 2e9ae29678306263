// indented_layer.h — a layer of tissue on a rigid floor, pressed by a rigid indenter: force over depth, in statics.
//
// A sphere, a cone or a punch with a rounded edge pushes back what would enter it, along its normal, by a pressure that grows with how far it has entered: stiff
// enough that 1e-3 of the force is missing. Without friction the tissue slides along it; to a bonded indenter it sticks where it touches first.
// What lies under a sharp flat punch goes down with it. Without friction the edge draws tissue in around itself at some depth; then
// this no longer holds: strain is singular there, finer meshes slide farther, and no force is given.
//
// Newton's method from rest on; the steps of depth grow where it converges fast and are shortened where it does not.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "lab/layer_mesh.h"
#include "lab/meridian_solid.h"

namespace glisson::lab {

class IndentedLayer {
 public:
  /// @param deepest  of all depths to come: the mesh is made for it [m] @param fineness  as layer_mesh
  /// @throws std::invalid_argument for a depth beyond the layer, or a punch wider than the specimen
  IndentedLayer(const Layer& layer, const Indenter& indenter, const HyperelasticLaw& law, double deepest,
                double fineness = 1.0);

  /// Goes on to a depth above the last [m].
  /// @return the force of the indenter [N] @throws std::runtime_error where no equilibrium is found
  double press(double depth);

 private:
  /// A point of the surface: the three vertices about it and what each has to do with it.
  struct SurfacePoint {
    std::array<std::size_t, 3> vertices{};
    std::array<double, 3> share{};
    double radius = 0.0, weight = 0.0;  ///< at rest [m], 2πR dR [m²]
    bool sticks = false;
    double stuck = 0.0;  ///< u_r where it touched first [m]
  };
  struct State {
    double depth = 0.0;
    MeridianState body;
  };
  struct Place {
    double r = 0.0, z = 0.0;  ///< [m]
  };

  void place_surface();
  Place place_of(const SurfacePoint& point) const;
  double tip() const { return solid_.mesh().heights.back() - state_.depth; }
  bool advance(double to);
  bool converge();
  void press_down();
  void touch();
  void add_contact(const SurfacePoint& point);
  void hold_vertices();
  void stick();
  void require_edge() const;
  std::size_t surface_vertex(std::size_t column) const { return (column + 1) * solid_.mesh().rows() - 1; }

  Layer layer_;
  Indenter indenter_;
  MeridianSolid solid_;
  std::vector<SurfacePoint> surface_;
  std::size_t under_punch_ = 0;  ///< columns under a flat punch
  State state_;
  std::vector<State> past_;  ///< the last states, the newest at the end
  double stride_ = 0.0;      ///< the next step of depth, where there is room for it [m]
  double stiffness_ = 0.0;   ///< of the contact [Pa/m]
  double pressure_ = 0.0;    ///< mean, of the last state [Pa]
  double force_ = 0.0;       ///< of the indenter in the last assembly [N]
  int iterations_ = 0;       ///< of Newton's method in the last step
};

}  // namespace glisson::lab
