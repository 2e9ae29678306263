// instrument_json.cpp — see instrument_json.h.
#include "report/instrument_json.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace glisson {
namespace {

using nlohmann::json;

json numbers(const Vec3d& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

json list_of(const InstrumentList& instruments, json (*make)(const Instrument&)) {
  json list = json::array();
  for (const auto& x : instruments) {
    if (x->form().kind != InstrumentForm::Kind::none) list.push_back(make(*x));
  }
  return list;
}

}  // namespace

json instrument_form_json(const Instrument& instrument) {
  const InstrumentForm form = instrument.form();
  json out{{"kind", word_of(form.kind)}, {"name", instrument.name()}};
  const auto length = [&](const char* key, double value) {
    if (value > 0.0) out[key] = value;
  };
  length("radius_m", form.radius);
  length("length_m", form.length);
  length("tip_m", form.tip);
  if (form.kind == InstrumentForm::Kind::block) out["size_m"] = numbers(form.size);
  if (form.kind == InstrumentForm::Kind::blade) {
    out["size_m"] = numbers(form.from);
    for (const json& x : numbers(form.to)) out["size_m"].push_back(x);
  }
  return out;
}

json instrument_place_json(const Instrument& instrument) {
  json line = json::array(), axes = json::array();
  for (const Vec3d& p : instrument.centre_line()) {
    for (const json& x : numbers(p)) line.push_back(x);
  }
  for (const auto& row : instrument.pose().axes.m) {
    for (const double x : row) axes.push_back(static_cast<float>(x));
  }
  return {{"points", std::move(line)}, {"axes", std::move(axes)}};
}

double drawn_wall_height(const Vec3d& floor, const Vec3d& up, std::span<const Vec3d> vertices) {
  constexpr double kAbove = 1.15;  // the body
  double top = 0.0;
  for (const Vec3d& x : vertices) top = std::max(top, dot(x - floor, up));
  return kAbove * top;
}

json vessel_json(const ContainerOptions& container, std::span<const Vec3d> vertices) {
  const Mat3d& axes = container.pose.axes;
  const Vec3d up{axes(0, 2), axes(1, 2), axes(2, 2)};
  json form = std::visit(
      [&](const auto& vessel) -> json {
        const double height =
            std::isfinite(vessel.height) ? vessel.height : drawn_wall_height(container.pose.position, up, vertices);
        json size{{"kind", vessel.kName}, {"height_m", height}};
        if constexpr (requires { vessel.radius; }) {
          size["radius_m"] = vessel.radius;
        } else {
          size["width_m"] = vessel.width;
          size["length_m"] = vessel.length;
        }
        return size;
      },
      container.vessel);
  form["origin"] = numbers(container.pose.position);
  form["axes"] = json::array();
  for (const auto& row : container.pose.axes.m) {
    for (const double x : row) form["axes"].push_back(x);
  }
  return form;
}

json instrument_forms_json(const InstrumentList& instruments) { return list_of(instruments, instrument_form_json); }
json instrument_places_json(const InstrumentList& instruments) { return list_of(instruments, instrument_place_json); }

}  // namespace glisson
