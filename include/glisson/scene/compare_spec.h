// compare_spec.h — the table [compare] of a scene.
#pragma once

#include <string>
#include <vector>

#include "glisson/field.h"

namespace glisson {

/// What `glisson compare` does with a scene.
struct CompareSpec {
  std::vector<std::string> models;  ///< names; empty: all
  int meshes = 2, finer = 1, stations = 5;
  std::vector<double> times;  ///< [s], ascending; empty: `stations` of them
  double target = 0.01;
  std::string cut;               ///< name of a region that is taken out; empty: none
  double cut_at = 0.0;           ///< when [s]
  std::vector<double> measured;  ///< sizes of the force at the stations [N]; empty: none were

  template <class Take>
  static constexpr auto fields(Take take) {
    using C = CompareSpec;
    return take(
        field("models", &C::models, "names of the models, as `glisson compare --list` prints them").otherwise("all"),
        field("meshes", &C::meshes, between(1, 4),
              "meshes that each model is run on: the scene's, and others, each twice as fine as the one before"),
        field("finer", &C::finer, between(1, 3),
              "how often the reference's mesh is twice as fine as the finest of them"),
        field("stations", &C::stations, between(1, 100),
              "times at which forces are compared, evenly spaced, the last at the end"),
        field(
            "times", &C::times, "s", above(0),
            "times at which forces are compared, ascending, in the place of `stations`; the end is one of them anyway")
            .otherwise("evenly spaced"),
        field("target", &C::target, "-", strictly_between(0, 1),
              "error of force and surface within which the models' times are compared"),
        field("cut", &C::cut, "name of a `[[region]]` whose tets are taken out during the run").otherwise("none"),
        field("cut_at", &C::cut_at, "s", at_least(0),
              "when they are taken out; stations before and after see the body whole and cut"),
        field("measured", &C::measured, "N", at_least(0),
              "size of the tool's force at each station as it was measured, which models are compared with, too")
            .otherwise("none"));
  }
};

}  // namespace glisson
