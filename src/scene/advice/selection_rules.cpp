// selection_rules.cpp — the mesh as it is, and sets and regions whose size hangs on rounding.
#include "scene/advice/rules.h"

namespace glisson::advice {

using detail::count_text;

Texts mesh_warnings(const Variant& v, const VariantAtRest& rest) {
  return std::holds_alternative<MeshFile>(v.mesh) ? Texts{} : rest.report.warnings;
}

Texts loaded(const VariantAtRest& rest) {
  if (!rest.largest_shift) return {};
  return {fill("the run starts loaded: a vertex of the unloaded shape is up to {} mm from its place in the mesh",
               {digits(3, 1e3 * *rest.largest_shift)})};
}

Texts rounding(const NearSelection& s) {
  if (s.near.by_rounding == 0) return {};
  return {fill("\"{}\": {}, {} of them outside of its bounds by rounding alone: what lies within {} mm of these counts",
               {s.name, count_text(s.near.inside, s.one, s.several), std::to_string(s.near.by_rounding),
                digits(2, 1e3 * s.near.tolerance)})};
}

Texts just_outside(const NearSelection& s) {
  constexpr std::size_t kShare = 100;  // one of so many just outside may be chance, where vertices lie in no order
  if (s.near.just_outside == 0 || s.near.just_outside * kShare < s.near.inside) return {};
  return {
      fill("\"{}\": {}; {} more {} outside of its bounds by {} mm or less, which is no rounding:\n"
           "if they belong to it, widen the bounds by that",
           {s.name, count_text(s.near.inside, s.one, s.several), std::to_string(s.near.just_outside),
            s.near.just_outside == 1 ? "lies" : "lie", digits(2, 1e3 * s.near.farthest)})};
}

}  // namespace glisson::advice
