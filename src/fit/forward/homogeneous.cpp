// homogeneous.cpp — whether a scene is a block or cylinder of one tissue between smooth plates, which deforms alike all over.
#include <algorithm>
#include <cmath>

#include "fit/forward/ladder.h"

namespace glisson::fit {
namespace {

std::string axes_text(const Axes& a) { return std::string(a.x ? "x" : "") + (a.y ? "y" : "") + (a.z ? "z" : ""); }

/// Whether a support holds nothing that a homogeneous compression along z moves.
bool is_smooth(const FixedSpec& fixed, bool box) {
  const std::string axes = axes_text(fixed.axes);
  if (fixed.set == (box ? "z_min" : "bottom")) return axes == "z";
  if (box) return (fixed.set == "x_min" && axes == "x") || (fixed.set == "y_min" && axes == "y");
  return fixed.set == "axis" && axes.find('z') == std::string::npos;
}

bool holds_floor(const Variant& v, bool box) {
  return std::any_of(v.fixed.begin(), v.fixed.end(),
                     [&](const FixedSpec& f) { return f.set == (box ? "z_min" : "bottom"); });
}

/// The face of a generated body, whose circle is a polygon: its volume over its height.
Specimen measured(const Variant& v, double height) {
  const TetMesh mesh = build_mesh(v, {});
  double volume = 0.0;
  for (const auto& t : mesh.tets) {
    const Vec3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]], &d = mesh.vertices[t[3]];
    volume += std::abs(dot(b - a, cross(c - a, d - a))) / 6.0;
  }
  return {.area = volume / height, .height = height};
}

}  // namespace

std::optional<Specimen> homogeneous_specimen(const Variant& v, const SceneModelOptions& options) {
  const auto* box = std::get_if<BoxOptions>(&v.mesh);
  const auto* cylinder = std::get_if<CylinderOptions>(&v.mesh);
  const bool plain = (box || cylinder) && v.sets.empty() && v.regions.empty() && v.loads.empty() &&
                     v.instruments.empty() && v.capsules.empty() && !v.container && v.tools.size() == 1 &&
                     options.force != "bottom" && options.force != "side" && norm(v.simulation.gravity) == 0.0;
  if (!plain || !holds_floor(v, box != nullptr)) return {};
  const ToolSpec& tool = v.tools.front();
  if (tool.rotation || tool.poses) return {};
  const Vec3d& d = tool.motion.direction;
  const bool pressed =
      tool.set == (box ? "z_max" : "top") && tool.sideways_free && d.x == 0.0 && d.y == 0.0 && d.z < 0.0;
  const bool smooth =
      std::all_of(v.fixed.begin(), v.fixed.end(), [&](const FixedSpec& f) { return is_smooth(f, box); });
  if (!pressed || !smooth) return {};
  return measured(v, box ? box->size[2] : cylinder->height);
}

}  // namespace glisson::fit
