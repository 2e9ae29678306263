// implant.h — bodies that are put into an image: a ball, an ellipsoid, or labels of another image, from a word.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "glisson/image/clean_labels.h"
#include "glisson/implicit.h"

namespace glisson::image {

/// `NAME=ball:X,Y,Z,DIAMETERmm`, `NAME=ellipsoid:X,Y,Z,A,B,Cmm`: centre and diameter or semi-axes [mm]; `NAME=labels:FILE` or
/// `NAME=labels:FILE:LABELS`, labels as in label_groups, all where none are named.
struct ImplantWord {
  std::string name, kind;
  std::vector<double> numbers;  ///< of shapes [m]
  std::filesystem::path file;   ///< of labels
  std::string labels;

  std::string text() const;  ///< of labels alone
};

/// @throws std::invalid_argument naming the word and what is wrong with it
ImplantWord implant_word(const std::string& word);

struct Implant {
  std::string name;
  Vec3d center{};     ///< [m]
  Vec3d semi_axes{};  ///< [m]; three equal ones are a ball; of labels half the sides of their box
  std::shared_ptr<const GroupImage> labels;  ///< none: a shape
  BodyRegion region;
  std::vector<std::string> notes;  ///< of the file and of cleaning

  double volume() const;
  bool contains(const Vec3d& p) const;
  double radius() const;  ///< of a ball about the centre that holds it
  std::size_t pieces() const { return labels ? labels->pieces().front() : 1; }
  /// A point of a shape's surface. @param direction  of length 1
  Vec3d surface_point(const Vec3d& direction) const { return center + component_product(semi_axes, direction); }
};

/// @param cleaning, smoothing  of labels
/// @throws std::invalid_argument, ImageError for the word and its file
Implant implant_of(const std::string& word, const CleanLabels& cleaning, int smoothing);

}  // namespace glisson::image
