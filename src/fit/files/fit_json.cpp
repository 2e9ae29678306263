// fit_json.cpp — see fit_json.h.
#include "fit/files/fit_json.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glisson/version.h"

namespace glisson {
namespace {

using Json = nlohmann::ordered_json;
using fit::FitResult;
using fit::Interval;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }
Json number(const std::optional<double>& x) { return x ? number(*x) : Json(nullptr); }

Json numbers(const std::vector<double>& list) {
  Json json = Json::array();
  for (const double x : list) json.push_back(number(x));
  return json;
}

Json interval(const std::optional<Interval>& x) {
  return x ? Json::array({number(x->low), number(x->high)}) : Json(nullptr);
}

/// Ends that the curves leave open are null.
Json open_interval(const std::optional<Interval>& x) {
  if (!x) return nullptr;
  return Json::array({x->low_open ? Json(nullptr) : number(x->low), x->high_open ? Json(nullptr) : number(x->high)});
}

Json parameter_json(const fit::ParameterResult& p) {
  return {{"name", p.parameter.name},
          {"unit", p.parameter.unit},
          {"scale", word_of(p.parameter.scale)},
          {"low", p.parameter.low},
          {"high", p.parameter.high},
          {"value", number(p.value)},
          {"sd", number(p.sd)},
          {"ci95", interval(p.ci95())},
          {"ci95_curvature", interval(p.by_curvature)},
          {"ci95_profile", open_interval(p.by_profile)},
          {"ci95_bootstrap", interval(p.by_bootstrap)},
          {"further95", open_interval(p.further)},
          {"further_batch95", open_interval(p.further_batch)},
          {"verdict", p.verdict},
          {"words", p.words}};
}

/// What stands along an axis of a curve's chart: a label with its unit, and what turns SI into it.
struct AxisOf {
  std::string label;
  double scale = 1.0;
};
Json axis_json(const AxisOf& axis) { return {{"label", axis.label}, {"scale", axis.scale}}; }

/// The driven number: a strain where the height is known.
AxisOf driven_axis(const fit::Measurement& m, const FitResult& result) {
  const double height = result.height.value_or(1.0);
  if (m.test == fit::LabTest::oscillation) return {"frequency [Hz]", 1.0};
  if (m.heat) return {"time [s]", 1.0};
  if (m.deforming == fit::Deforming::indentation)
    return m.loaded() ? AxisOf{"force [N]", 1.0} : AxisOf{"depth [mm]", 1e3};
  if (m.drive_unit == "rad") return {"angle [°]", 180.0 / std::numbers::pi};
  if (m.loaded()) return {"nominal stress [kPa]", 1e-3 / result.area.value_or(1.0)};
  if (m.deforming == fit::Deforming::simple_shear) return {"shear [%]", 100.0 / height};
  if (result.height)
    return {m.deforming == fit::Deforming::compression ? "strain [%]" : "extension [%]", 100.0 / height};
  return {"displacement [mm]", 1000.0};
}

/// Of a scene of heat: sizes in mm, mm² and cm³, shares in percent.
AxisOf heat_axis(const fit::Measurement& m) {
  if (m.unit == "m") return {"length [mm]", 1e3};
  if (m.unit == "m²") return {"area [mm²]", 1e6};
  if (m.unit == "m³") return {"volume [cm³]", 1e6};
  if (m.unit == "-") return {"share [%]", 100.0};
  return {m.unit == "°C" ? "temperature [°C]" : "measured [" + m.unit + "]", 1.0};
}

/// The measured number: a stress where the area is known.
AxisOf measured_axis(const fit::Measurement& m, const FitResult& result) {
  const double stress = 1e-3 / result.area.value_or(1.0);
  switch (m.measured) {
    case fit::Measured::cauchy:
      return {"Cauchy stress [kPa]", stress};
    case fit::Measured::second_piola:
      return {"second Piola–Kirchhoff stress [kPa]", stress};
    case fit::Measured::torque:
      return {"torque [mN m]", 1e3};
    case fit::Measured::axial:
      return {"axial force [mN]", 1e3};
    case fit::Measured::strain:
      if (m.deforming == fit::Deforming::indentation) return {"depth [mm]", 1e3};
      return {"strain [%]", 100.0 / result.height.value_or(1.0)};
    case fit::Measured::storage:
      return {"storage modulus [kPa]", 1e-3};
    case fit::Measured::loss:
      return {"loss modulus [kPa]", 1e-3};
    case fit::Measured::heat:
      return heat_axis(m);
    case fit::Measured::nominal:
      break;
  }
  if (!result.area) return {"force [N]", 1.0};
  return {m.deforming == fit::Deforming::simple_shear ? "shear stress [kPa]" : "nominal stress [kPa]", stress};
}

/// Whether an indenter rests at its depth for most of the time.
bool is_held(const fit::Curve& c) {
  if (c.measurement.deforming != fit::Deforming::indentation || !c.measurement.timed) return false;
  const double deepest = *std::max_element(c.displacement.begin(), c.displacement.end());
  const auto arrived =
      std::find_if(c.displacement.begin(), c.displacement.end(), [&](double d) { return d > 0.98 * deepest; });
  const bool stays = c.displacement.back() > 0.98 * deepest;
  return stays && c.time[static_cast<std::size_t>(arrived - c.displacement.begin())] - c.time.front() <
                      0.5 * (c.time.back() - c.time.front());
}

/// Along x: time where the test goes by it, else what is driven.
Json curve_x(const fit::Curve& curve, const FitResult& result) {
  const fit::Measurement& m = curve.measurement;
  const bool by_time = m.heat || m.test == fit::LabTest::relaxation || m.test == fit::LabTest::creep || is_held(curve);
  Json axis = axis_json(by_time ? AxisOf{"time [s]", 1.0} : driven_axis(m, result));
  axis["of"] = by_time ? "time" : "drive";
  axis["log"] = m.test == fit::LabTest::oscillation;
  return axis;
}

/// Numbers of a press are named by their units; those of other tests stand beside theirs.
Json curve_json(const fit::CurveResult& c, const FitResult& result, const std::string& account) {
  const std::vector<double> none(c.curve.size(), std::nan(""));
  const fit::Measurement& m = c.curve.measurement;
  const bool newtons = m.unit == "N" && m.drive_unit == "m";
  const std::string n = newtons ? "_N" : "";
  return {{"name", c.curve.name},
          {"group", c.curve.group},
          {"test", word_of(m.test)},
          {"deforming", m.heat ? Json(nullptr) : Json(word_of(m.deforming))},
          {"velocity_m_s", number(c.curve.velocity)},
          {"held_out", c.curve.held_out},
          {"unit", m.unit},
          {"drive_unit", m.drive_unit},
          {"x", curve_x(c.curve, result)},
          {"y", axis_json(measured_axis(m, result))},
          {"time_s", m.timed ? numbers(c.curve.time) : Json::array()},
          {newtons ? "displacement_m" : "drive", numbers(c.curve.displacement)},
          {"measured" + n, numbers(c.curve.force)},
          {"fitted" + n, numbers(c.fitted.empty() ? none : c.fitted)},
          {"further_low" + n, numbers(c.further_low)},
          {"further_high" + n, numbers(c.further_high)},
          {"noise" + n, number(c.curve.noise)},
          {"rms" + n, number(c.rms)},
          {"account", account}};
}

Json groups_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::GroupResult& g : result.groups)
    list.push_back(
        {{"name", g.name}, {"held_out", g.held_out}, {"rms_N", number(g.rms)}, {"spread_N", number(g.spread)}});
  return list;
}

/// Of each test what the fit of all makes of it, and fits to one test alone.
Json tests_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::TestResult& t : result.tests) {
    Json alone = Json::object();
    for (std::size_t a = 0; a < t.r2_of_alone.size(); ++a) {
      if (!result.tests[a].held_out) alone[result.tests[a].name] = number(t.r2_of_alone[a]);
    }
    list.push_back({{"name", t.name},
                    {"test", word_of(t.test)},
                    {"r2", number(t.r2)},
                    {"rms", number(t.rms)},
                    {"unit", t.unit},
                    {"points", t.points},
                    {"held_out", t.held_out},
                    {"r2_of_alone", alone}});
  }
  return list;
}

Json basins_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::BasinResult& b : result.basins)
    list.push_back(
        {{"cost", number(b.cost)}, {"found", b.found}, {"values", numbers(b.values)}, {"best", list.empty()}});
  return list;
}

Json starts_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::StartResult& s : result.starts) {
    if (s.basin >= 0) list.push_back({{"cost", number(s.cost)}, {"basin", s.basin}});
  }
  return list;
}

Json profiles_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::ProfileResult& p : result.profiles)
    list.push_back({{"parameter", p.parameter},
                    {"values", numbers(p.values)},
                    {"rise", numbers(p.rise)},
                    {"threshold", number(p.threshold)},
                    {"words", p.words}});
  return list;
}

Json laws_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::LawResult& l : result.laws)
    list.push_back({{"name", l.name},
                    {"parameters", l.parameters},
                    {"rms_fit", number(l.rms_fit)},
                    {"rms_heldout", number(l.rms_heldout)},
                    {"aic", number(l.aic)},
                    {"bic", number(l.bic)},
                    {"best", l.best},
                    {"words", l.words}});
  return list;
}

Json discovered_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::DiscoveredLaw& d : result.discovered)
    list.push_back({{"name", d.name},
                    {"terms", d.terms},
                    {"parameters", d.parameters},
                    {"cost", number(d.cost)},
                    {"least_r2", number(d.r2)},
                    {"taken", d.taken}});
  return list;
}

Json designs_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::DesignResult& d : result.designs)
    list.push_back({{"what", d.what},
                    {"parameter", d.parameter},
                    {"width_now", number(d.width_now)},
                    {"width_after", number(d.width_after)}});
  return list;
}

/// Of each path what was looked at, and beyond which stretch or shear the law is not stable.
Json stability_json(const FitResult& result) {
  Json list = Json::array();
  for (const fit::StabilityResult& s : result.stability)
    list.push_back({{"path", s.path},
                    {"low", number(s.low)},
                    {"high", number(s.high)},
                    {"stable", !s.lost_below && !s.lost_above},
                    {"lost_below", number(s.lost_below)},
                    {"lost_above", number(s.lost_above)}});
  return list;
}

/// Strain and stress where the specimen's size is known, else displacement and force: of most curves, and of all errors.
Json axis_x(const FitResult& result) {
  const bool heat = !result.curves.empty() && result.curves.front().curve.measurement.heat;
  if (heat) return axis_json({"time [s]", 1.0});
  if (result.height) return {{"label", "strain [%]"}, {"scale", 100.0 / *result.height}};
  return {{"label", "displacement [mm]"}, {"scale", 1000.0}};
}
Json axis_y(const FitResult& result) {
  if (result.unit.empty()) return {{"label", "part of the largest [%]"}, {"scale", 100.0}};
  if (result.unit == "°C") return {{"label", "temperature [°C]"}, {"scale", 1.0}};
  if (result.unit == "Pa") return {{"label", "stress [kPa]"}, {"scale", 1e-3}};
  if (result.unit == "N" && result.area) return {{"label", "nominal stress [kPa]"}, {"scale", 1e-3 / *result.area}};
  return {{"label", result.unit == "N" ? "force [N]" : "measured [" + result.unit + "]"}, {"scale", 1.0}};
}

}  // namespace

Json fit_json(const FitResult& result, const FitHeading& heading) {
  Json parameters = Json::array(), curves = Json::array(), correlation = Json::array(), replicates = Json::array();
  for (const fit::ParameterResult& p : result.parameters) parameters.push_back(parameter_json(p));
  for (std::size_t c = 0; c < result.curves.size(); ++c)
    curves.push_back(curve_json(result.curves[c], result, c < result.accounts.size() ? result.accounts[c] : ""));
  for (const std::vector<double>& row : result.correlation) correlation.push_back(numbers(row));
  for (const std::vector<double>& row : result.bootstrap) replicates.push_back(numbers(row));
  Json bootstrap = nullptr;
  if (!result.bootstrap.empty()) bootstrap = {{"replicates", result.bootstrap.size()}, {"values", replicates}};
  Json json{{"name", heading.name},
            {"title", heading.title},
            {"description", heading.description},
            {"notes", heading.notes},
            {"version", GLISSON_VERSION},
            {"law", result.law},
            {"complete", result.complete},
            {"parameters", parameters},
            {"rms_fit", number(result.rms_fit)},
            {"rms_heldout", number(result.rms_heldout)},
            {"spread_N", number(result.spread)},
            {"forward_runs", result.forward_runs},
            {"forward_run_s", number(result.forward_run_s)},
            {"wall_s", number(result.wall_s)},
            {"basins", basins_json(result)},
            {"start_costs", starts_json(result)},
            {"starts", result.starts.size()},
            {"starts_planned", result.starts_planned},
            {"forward", result.forward},
            {"forward_error_N", number(result.forward_error)},
            {"correlation", correlation},
            {"groups", groups_json(result)},
            {"tests", tests_json(result)},
            {"unit", result.unit},
            {"profiles", profiles_json(result)},
            {"bootstrap", bootstrap},
            {"laws", laws_json(result)},
            {"discovered", discovered_json(result)},
            {"designs", designs_json(result)},
            {"stability", stability_json(result)},
            {"conclusions", result.conclusions},
            {"x", axis_x(result)},
            {"y", axis_y(result)},
            {"curves", curves},
            {"tissue", result.tissue},
            {"result_file", result.result_file},
            {"source", heading.source}};
  return json;
}

}  // namespace glisson
