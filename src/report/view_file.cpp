// view_file.cpp — see view_file.h.
#include "report/view_file.h"

#include <nlohmann/json.hpp>

#include "report/body_surface.h"
#include "report/instrument_json.h"
#include "report/json_text.h"

namespace glisson {
namespace {

using nlohmann::json;

json tool_json(const Instrument& x) {
  const Vec3d& d = x.direction();
  return {
      {"name", x.name()}, {"instrument", x.form().kind != InstrumentForm::Kind::none}, {"direction", {d.x, d.y, d.z}}};
}

/// The vessel about the body; a wall without end has no height here. None: null.
json container_json(const Variant& variant) {
  if (!variant.container) return nullptr;
  json form = vessel_json(variant.container->options, {});
  if (!(form["height_m"] > 0.0)) form["height_m"] = nullptr;
  return form;
}

json head(const std::string& scene, const Variant& variant,
          const std::vector<std::shared_ptr<Instrument>>& instruments) {
  json tools = json::array(), held = json::array(), driven = json::array();
  for (const auto& x : instruments) tools.push_back(tool_json(*x));
  for (const ToolSpec& x : variant.tools) driven.push_back(x.set);
  for (const FixedSpec& x : variant.fixed) held.push_back(x.set);
  return {{"format", 1},
          {"scene", scene},
          {"label", variant.label.empty() ? variant.name : variant.label},
          {"tools", std::move(tools)},
          {"held", std::move(held)},
          {"driven", std::move(driven)},
          {"container", container_json(variant)},
          {"instruments", instrument_forms_json(instruments)}};
}

}  // namespace

ViewFile::ViewFile(const std::filesystem::path& folder, const std::string& scene, const Variant& variant,
                   std::vector<std::shared_ptr<Instrument>> instruments)
    : file_(folder / "view.jsonl"), instruments_(std::move(instruments)) {
  file_.write(json_text(head(scene, variant, instruments_)));
}

void ViewFile::add(double time) {
  json line{{"time_s", time}, {"instruments", instrument_places_json(instruments_)}};
  if (std::vector<Triangle> torn = torn_triangles(capsules_); torn != torn_) {
    json& vertices = line["torn"] = json::array();
    for (const Triangle& triangle : torn) {
      for (const std::uint32_t v : triangle) vertices.push_back(v);
    }
    torn_ = std::move(torn);
  }
  file_.write(json_text(line));
}

}  // namespace glisson
