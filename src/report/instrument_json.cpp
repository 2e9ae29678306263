// instrument_json.cpp — see instrument_json.h.
#include "report/instrument_json.h"

#include <cmath>
#include <vector>

#include "glisson/instruments/blade.h"
#include "glisson/instruments/contact.h"
#include "glisson/instruments/needle.h"

namespace glisson {
namespace {

using nlohmann::json;

json numbers(const Vec3d& v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }

Vec3d in_axes_of(const Pose& pose, const Vec3d& point) {
  const Vec3d off = point - pose.position;
  Vec3d own;
  for (std::size_t k = 0; k < 3; ++k)
    own[k] = pose.axes(0, k) * off.x + pose.axes(1, k) * off.y + pose.axes(2, k) * off.z;
  return own;
}

/// The sizes that the page needs to draw a shape; lengths in metres, along its own z from its tip.
struct FormOf {
  json operator()(const FlatPunch& x) const {
    return {{"kind", "punch"}, {"radius_m", x.radius}, {"length_m", x.length}};
  }
  json operator()(const Ball& x) const { return {{"kind", "ball"}, {"radius_m", x.radius}}; }
  json operator()(const NeedleShape& x) const {
    const double tip = x.tip == TipForm::conical    ? 0.5 * x.diameter / std::tan(0.5 * x.tip_angle)
                       : x.tip == TipForm::bevelled ? x.diameter / std::tan(x.tip_angle)
                                                    : 0.5 * x.diameter;
    return {{"kind", "probe"}, {"radius_m", 0.5 * x.diameter}, {"length_m", x.length}, {"tip_m", tip}};
  }
  json operator()(const Plate&) const { return {{"kind", "plate"}}; }
  json operator()(const CylinderWall& x) const { return {{"kind", "wall"}, {"radius_m", x.radius}}; }
  json operator()(const Block& x) const { return {{"kind", "block"}, {"size_m", numbers(x.size)}}; }
};

}  // namespace

json instrument_form_json(const Instrument& instrument) {
  json form{{"kind", "point"}};
  if (const auto* needle = dynamic_cast<const Needle*>(&instrument)) {
    form = {{"kind", "needle"}, {"radius_m", 0.5 * needle->options().diameter}};
  } else if (const auto* tool = dynamic_cast<const ContactTool*>(&instrument)) {
    form = std::visit(FormOf{}, tool->options().shape);
  } else if (const auto* blade = dynamic_cast<const Blade*>(&instrument)) {
    form = {{"kind", "blade"}, {"size_m", json::array()}};
    for (const Vec3d& end : {blade->edge().from, blade->edge().to}) {
      for (const json& x : numbers(in_axes_of(instrument.pose(), end))) form["size_m"].push_back(x);
    }
  }
  form["name"] = instrument.name();
  return form;
}

json instrument_place_json(const Instrument& instrument) {
  std::vector<Vec3d> points{instrument.pose().position};
  if (const auto* needle = dynamic_cast<const Needle*>(&instrument)) points = needle->centre_line();
  json line = json::array(), axes = json::array();
  for (const Vec3d& p : points) {
    for (const json& x : numbers(p)) line.push_back(x);
  }
  for (const auto& row : instrument.pose().axes.m) {
    for (const double x : row) axes.push_back(static_cast<float>(x));
  }
  return {{"points", std::move(line)}, {"axes", std::move(axes)}};
}

}  // namespace glisson
