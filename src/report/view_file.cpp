// view_file.cpp — see view_file.h.
#include "report/view_file.h"

#include <nlohmann/json.hpp>

#include "report/instrument_json.h"
#include "report/json_text.h"

namespace glisson {
namespace {

using nlohmann::json;

json tool_json(const std::string& name, bool instrument, const Vec3d& direction) {
  const Vec3d d = direction * (1.0 / norm(direction));
  return {{"name", name}, {"instrument", instrument}, {"direction", {d.x, d.y, d.z}}};
}

json head(const std::string& scene, const Variant& variant,
          const std::vector<std::shared_ptr<Instrument>>& instruments) {
  json tools = json::array(), held = json::array(), driven = json::array(), forms = json::array();
  for (const ToolSpec& x : variant.tools) {
    tools.push_back(tool_json(x.name, false, x.motion.direction));
    driven.push_back(x.set);
  }
  for (const InstrumentSpec& x : variant.instruments) tools.push_back(tool_json(x.name, true, x.direction));
  for (const FixedSpec& x : variant.fixed) held.push_back(x.set);
  for (const auto& x : instruments) forms.push_back(instrument_form_json(*x));
  return {{"format", 1},
          {"scene", scene},
          {"label", variant.label.empty() ? variant.name : variant.label},
          {"tools", std::move(tools)},
          {"held", std::move(held)},
          {"driven", std::move(driven)},
          {"instruments", std::move(forms)}};
}

}  // namespace

ViewFile::ViewFile(const std::filesystem::path& folder, const std::string& scene, const Variant& variant,
                   std::vector<std::shared_ptr<Instrument>> instruments)
    : file_(folder / "view.jsonl"), instruments_(std::move(instruments)) {
  file_.write(json_text(head(scene, variant, instruments_)));
}

void ViewFile::add(double time) {
  json places = json::array();
  for (const auto& x : instruments_) places.push_back(instrument_place_json(*x));
  file_.write(json_text(json{{"time_s", time}, {"instruments", std::move(places)}}));
}

}  // namespace glisson
