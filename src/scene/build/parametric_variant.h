// parametric_variant.h — an experiment that is read once, and of which some numbers are then set again and again.
//
// Reading a scene anew for each forward run of a fit would cost more than a cheap run itself. Here text, variants, presets
// and overrides are gone through once; what is kept is the tree of the experiment and the places in it where the
// parameters went. with() copies the tree, sets the numbers, and reads it with all checks of ranges and contradictions.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/scene/scene.h"
#include "scene/parse/document.h"

namespace glisson::scene {

class ParametricVariant {
 public:
  /// @param text       of a scene @param name  stands for its file in messages @param base  where relative paths start
  /// @param overrides  laid over it first, as --set
  /// @param variant    which experiment; empty: the only one
  /// @param keys       keys of numbers as --set takes them; a trailing [i] means an element of a list of numbers
  /// @throws SceneError for a scene or keys that cannot be used
  ParametricVariant(std::string_view text, const std::string& name, const std::filesystem::path& base,
                    std::span<const Override> overrides, const std::string& variant, std::span<const std::string> keys);

  /// The experiment at values of the keys. @throws SceneError for values that are not allowed
  Variant with(std::span<const double> values) const;
  /// Its [tissue] alone, in half the time. @throws SceneError
  Tissue tissue_with(std::span<const double> values) const;
  /// The keys of its [tissue] with their values, presets put in; for files of tissues.
  Node tissue_tree(std::span<const double> values) const;
  /// Whether the keys change nothing but [tissue].
  bool only_tissue() const { return only_tissue_; }

 private:
  /// Where the value of a key goes: the members and elements to go down by.
  struct Place {
    std::size_t key = 0;
    std::vector<std::size_t> path;
  };
  void set(Node& root, std::span<const Place> places, std::span<const double> values) const;

  std::string name_;
  std::filesystem::path base_;
  Node experiment_, tissue_;
  std::vector<Place> places_, tissue_places_;
  bool only_tissue_ = true;
};

}  // namespace glisson::scene
