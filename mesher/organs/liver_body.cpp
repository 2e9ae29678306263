// liver_body.cpp — the outside of the liver and its regions; the veins are in liver_veins.cpp, its supports in liver_sets.cpp.
//
// All lengths here in millimetres: x to the left, y to the back, z to the head (docs/liver.md).
#include <algorithm>

#include "base/require_fields.h"
#include "glisson/liver.h"
#include "mesher/organs/liver_parts.h"

namespace glisson {
namespace {

using detail::LiverParts;

/// Lobes joined softly, then what neighbours press into them.
void add_outside(LiverParts& parts) {
  parts.ellipsoid("right_lobe_upright", {0, 0, 0}, {62, 55, 81}, 2.4);
  parts.place("right_lobe", "right_lobe_upright", {0, 1, 0}, 8.0, {-38, 0, -4});
  parts.ellipsoid("left_lobe_level", {0, 0, 0}, {62, 36, 31}, 2.2);
  parts.place("left_lobe", "left_lobe_level", {0, 1, 0}, -8.0, {44, -12, 42});
  parts.unite("lobes", {"right_lobe", "left_lobe"}, 30);
  parts.ball("stomach", {70, 14, -64}, 80);
  parts.ball("kidney", {-54, 80, -66}, 48);
  parts.ball("colon", {-22, -8, -122}, 52);
  parts.subtract("visceral", {"lobes", "stomach", "kidney", "colon"}, 14);
  parts.ellipsoid("caudate_lobe", {10, 30, 18}, {18, 16, 32}, 2.0);
  parts.unite("with_caudate", {"visceral", "caudate_lobe"}, 8);
  parts.tube("vena_cava", detail::vena_cava());
  parts.ellipsoid("falciform_notch", {20, -52, 0}, {4, 24, 26}, 2.0);
  parts.tube("gallbladder_fossa", {{{-16, -46, -66}, 13}, {{-6, -14, -54}, 11}, {{0, 8, -38}, 6}});
  parts.ellipsoid("porta", {4, 14, -26}, {20, 6, 7}, 2.0);
  parts.subtract("whole", {"with_caudate", "vena_cava", "falciform_notch", "gallbladder_fossa", "porta"}, 5);
}

}  // namespace

Fault LiverOptions::check() const {
  std::vector<std::string> regions{"tumour", "hepatic_veins", "portal_veins", "parenchyma"};
  if (gallbladder) regions.emplace_back("gallbladder");
  const SizeFault fault = check_sizes(sizes, edge, regions);
  if (fault.what.empty()) return {};
  return {"(" + fault.key + " of size " + std::to_string(fault.index) + "): " + fault.what, "sizes"};
}

ImplicitBody liver_body(const LiverOptions& options) {
  detail::require_fields("liver", options);
  LiverParts parts(options.scale);
  add_outside(parts);
  if (options.tumour_radius > 0.0) {
    parts.ball("tumour_ball", options.tumour_center * 1e3, options.tumour_radius * 1e3);
    parts.region("tumour", "tumour_ball", "whole");
  }
  if (options.gallbladder) {
    // A millimetre wider than its bed, so that the two grow together wherever they meet.
    parts.tube("gallbladder", {{{-16, -46, -66}, 14}, {{-6, -14, -54}, 12}, {{0, 8, -38}, 7}});
    parts.region("gallbladder");
  }
  const auto edge_near = [&](const std::string& region) {
    double edge = options.edge;
    for (const MeshSize& s : options.sizes) {
      if (s.near == region || s.surface == region) edge = std::min(edge, s.edge);
    }
    return 1e3 * edge / options.scale;
  };
  if (options.vessels) detail::add_veins(parts, edge_near("hepatic_veins"), edge_near("portal_veins"));
  ImplicitBody body = parts.body();
  body.regions.push_back({"parenchyma", "whole", false});
  body.edge = options.edge;
  body.max_tets = options.max_tets;
  body.sizes = options.sizes;
  body.growth = options.growth;
  return body;
}

RegionMesh liver_mesh(const LiverOptions& options, std::function<bool(double)> progress) {
  RegionMesh made = implicit_mesh(liver_body(options), std::move(progress));
  detail::add_liver_sets(made.mesh, options);
  return made;
}

}  // namespace glisson
