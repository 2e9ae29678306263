// grip.h — how the faces of a cylinder meet the plates, and what holds them there.
#pragma once

namespace glisson::lab {

/// How a cylinder's faces meet the plates.
enum class Faces {
  smooth,    ///< without friction: it deforms alike all over
  friction,  ///< they slide against adhesion and Coulomb's friction
  bonded     ///< they do not slide
};

/// What holds a face that slides.
struct Grip {
  double friction = 0.0;  ///< f ≥ 0 [-]
  double adhesion = 0.0;  ///< τ ≥ 0, on the area at rest [Pa]
};

}  // namespace glisson::lab
