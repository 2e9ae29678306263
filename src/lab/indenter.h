// indenter.h — the shapes of rigid indenters: their surfaces, and their closed forms for a thick layer of little strain.
//
//   flat    a face of radius a with a sharp edge, or one rounded by a torus
//   sphere  a ball of radius R on a shaft of the same
//   cone    a point of half angle θ between axis and side
#pragma once

#include <string>

#include "glisson/indentation.h"

namespace glisson::lab {

using fit::Indenter, fit::IndenterContact, fit::IndenterShape, fit::Layer;

/// About the radius of contact with a thick layer [m]: a, √(R d), 2/π d tan θ        [Sneddon1965]
double contact_radius(const Indenter& indenter, double depth);

/// Force of a frictionless indenter on a thick layer of little strain, over E/(1 − ν²) [m²]       [Sneddon1965]
///   flat 2 a d,   sphere 4/3 √R d^(3/2) (Hertz),   cone 2/π d² tan θ
double thick_layer_force(const Indenter& indenter, double depth);

/// The power of the depth in that: 1, 3/2, 2.
double depth_power(IndenterShape shape);

/// Young's modulus of a thick incompressible layer of little strain that answers with a force [Pa].
double thick_layer_modulus(const Indenter& indenter, double depth, double force);

/// How far a point has entered along the normal of the surface, with derivatives by its radius and height. Not of sharp ones.
struct Entry {
  double depth = 0.0;  ///< [m], < 0 outside
  double by_r = 0.0, by_z = 0.0, rr = 0.0, rz = 0.0, zz = 0.0;
};
/// @param tip  height of the indenter's lowest point @param r, z  of the point [m]
Entry entry_of(const Indenter& indenter, double tip, double r, double z);

/// "a sphere of 2 mm radius".
std::string words_of(const Indenter& indenter);

}  // namespace glisson::lab
