#include "cli/near_bounds.h"

#include <string>

#include "base/text.h"
#include "glisson/scene/near_bounds.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr std::size_t kShare = 100;  // one of so many just outside may be chance, where vertices lie in no order

std::string lies(std::size_t count) { return count == 1 ? "lies" : "lie"; }

/// @param one, @param several  names of what is counted
void print_near(const std::string& label, const NearBounds& near, const char* one, const char* several) {
  if (near.by_rounding > 0) {
    say("  {}: {}, {} of them outside of its bounds by rounding alone: what lies within {:.2g} mm of these counts\n",
        label, detail::count_text(near.inside, one, several), near.by_rounding, 1e3 * near.tolerance);
  }
  if (near.just_outside == 0 || near.just_outside * kShare < near.inside) return;
  say("  {}: {}; {} more {} outside of its bounds by {:.2g} mm or less, which is no rounding:\n"
      "           if they belong to it, widen the bounds by that\n",
      label, detail::count_text(near.inside, one, several), near.just_outside, lies(near.just_outside),
      1e3 * near.farthest);
}

}  // namespace

void print_near_bounds(const Variant& variant, const TetMesh& mesh) {
  for (const auto& [name, selection] : variant.sets) {
    print_near("set      \"" + name + "\"", near_bounds(mesh, selection), "vertex", "vertices");
  }
  for (const RegionSpec& region : variant.regions) {
    print_near("region   \"" + region.name + "\"", near_bounds(mesh, region), "tet", "tets");
  }
}

}  // namespace glisson::app
