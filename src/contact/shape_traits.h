// shape_traits.h — what the contact solver asks of a shape beside its distance.
#pragma once

#include "glisson/contact/shape.h"

namespace glisson {

/// What can be known of a shape before anything is near it.
struct ShapeTraits {
  double thickness = 0.0;  ///< the least way through it [m]; infinite for a half space
  /// Whether it can press on a triangle and on none of its corners: shapes that are neither flat nor hollow.
  bool presses_between = true;
  bool flat = false;    ///< φ is linear
  bool hollow = false;  ///< φ is not convex
};

ShapeTraits traits_of(const Shape& shape);

}  // namespace glisson
