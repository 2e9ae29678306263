// implant.h — bodies that are put into an image: a ball or an ellipsoid, from a word.
#pragma once

#include <string>

#include "glisson/implicit.h"

namespace glisson::image {

struct Implant {
  std::string name;
  Vec3d center{};     ///< [m]
  Vec3d semi_axes{};  ///< [m]; three equal ones are a ball

  double volume() const;  ///< [m³]
  bool contains(const Vec3d& p) const;
  BodyRegion region() const;
  /// A point of its surface. @param direction  of length 1
  Vec3d surface_point(const Vec3d& direction) const { return center + component_product(semi_axes, direction); }
};

/// `NAME=ball:X,Y,Z,DIAMETERmm`, `NAME=ellipsoid:X,Y,Z,A,B,Cmm`: centre and diameter or semi-axes [mm].
/// @throws std::invalid_argument naming the word and what is wrong with it
Implant implant_of(const std::string& word);

}  // namespace glisson::image
