#include "cli/material_tests.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "glisson/indentation.h"
#include "glisson/material_point.h"
#include "glisson/oscillation.h"
#include "glisson/torsion.h"

namespace glisson::app {
namespace {

constexpr double kOwnRate = 0.01;    // of stretch, where none is given [1/s]
constexpr double kOwnStretch = 1.3;  // where no end is given
constexpr double kOwnShear = 0.5;
constexpr double kOwnAngle = 30.0;     // [deg]
constexpr double kOwnAngleRate = 1.0;  // [deg/s]
constexpr double kOwnSize = 10.0;      // radius and length [mm]
constexpr double kFromHz = 0.01, kToHz = 100.0;
constexpr std::size_t kOwnPoints = 20, kOwnBetween = 10;

constexpr double kOwnDepth = 1.0, kOwnDepthRate = 1.0;  // [mm], [mm/s]
constexpr double kOwnHalfAngle = 60.0;                  // [deg]

constexpr const char *kTorsion = "torsion", *kOscillation = "oscillation", *kIndentation = "indentation";

template <class Enum>
Enum by_word(const std::string& option, const std::string& name, const std::string& known) {
  for (const auto& w : kWords<Enum>) {
    if (w.word == name) return w.value;
  }
  throw std::invalid_argument(option + " " + name + ": there is no such word; allowed: " + known);
}

template <class Enum>
std::string all_words() {
  std::string known;
  for (const auto& w : kWords<Enum>) known += (known.empty() ? "" : ", ") + std::string(w.word);
  return known;
}

/// Refuses what a test does not read, rather than to let it pass unread.
void refuse_strangers(const MaterialOptions& o) {
  const bool torsion = o.test == kTorsion, oscillation = o.test == kOscillation, indentation = o.test == kIndentation;
  struct Given {
    const char* option;
    bool given, read;
    const char* of;
  };
  for (const Given& g : {
           Given{"--to", !o.to.empty(), !oscillation, "tests over time"},
           {"--rate", o.rate.has_value(), !oscillation, "tests over time"},
           {"--hold", o.hold.has_value(), !oscillation, "tests over time"},
           {"--between", o.between.has_value(), !oscillation && !indentation, "tests over time, but of indentation"},
           {"--stress", o.stress, !oscillation && !torsion && !indentation, "a homogeneous test over time"},
           {"--radius-mm", o.radius_mm.has_value(), torsion || (indentation && o.indenter.value_or("") != "cone"),
            "--test torsion, and --test indentation of a sphere or flat punch"},
           {"--indenter", o.indenter.has_value(), indentation, "--test indentation"},
           {"--half-angle-deg", o.half_angle_deg.has_value(), indentation && o.indenter.value_or("") == "cone",
            "--test indentation --indenter cone"},
           {"--edge-radius-mm", o.edge_radius_mm.has_value(), indentation && o.indenter.value_or("") == "flat",
            "--test indentation --indenter flat"},
           {"--thickness-mm", o.thickness_mm.has_value(), indentation, "--test indentation"},
           {"--diameter-mm", o.diameter_mm.has_value(), indentation, "--test indentation"},
           {"--bonded", o.bonded, indentation, "--test indentation"},
           {"--force", o.force, indentation, "--test indentation"},
           {"--length-mm", o.length_mm.has_value(), torsion, "--test torsion"},
           {"--stretch", o.stretch.has_value(), torsion || oscillation, "--test torsion and --test oscillation"},
           {"--from-hz", o.from_hz.has_value(), oscillation, "--test oscillation"},
           {"--to-hz", o.to_hz.has_value(), oscillation, "--test oscillation"},
           {"--mode", o.mode.has_value(), oscillation, "--test oscillation"},
       }) {
    if (!g.given || g.read) continue;
    throw std::invalid_argument(fmt::format("{}: it belongs to {}, and the test is {}", g.option, g.of, o.test));
  }
}

double above_zero(const char* option, double value) {
  if (value > 0.0 && std::isfinite(value)) return value;
  throw std::invalid_argument(fmt::format("{} {:g}: outside the allowed range, > 0", option, value));
}

/// A driven value over time: from rest to each end in turn at its rate, then held.
struct Timeline {
  std::vector<double> times, values;
};

/// @param rate  0: a second for each end
Timeline timeline(const MaterialOptions& o, double value, const std::vector<double>& ends, double rate) {
  const std::size_t points = o.points.value_or(kOwnPoints);
  double time = 0.0;
  Timeline line;
  for (const double end : ends) {
    const double way = std::abs(end - value);
    const double length = rate > 0.0 ? way / rate : (way > 0.0 ? 1.0 : 0.0);
    for (std::size_t i = 1; i <= points && way > 0.0; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(points);
      line.times.push_back(time + share * length);
      line.values.push_back(i == points ? end : value + share * (end - value));
    }
    value = end, time += length;
  }
  const double hold = o.hold.value_or(0.0);
  for (std::size_t i = 1; i <= points && hold > 0.0; ++i) {
    line.times.push_back(time + hold * static_cast<double>(i) / static_cast<double>(points));
    line.values.push_back(value);
  }
  if (line.times.empty())
    throw std::invalid_argument("--to: the test ends where it starts; give another end, or --hold");
  return line;
}

Timeline timeline_of(const MaterialOptions& o, MaterialTest test) {
  const bool shear = test == MaterialTest::simple_shear;
  if (o.stress && o.to.empty()) {
    throw std::invalid_argument("--stress: --to is missing: the nominal stress to go to [Pa], such as --to 500");
  }
  for (const double end : o.to) {
    if (o.stress || shear || end > 0.0) continue;
    throw std::invalid_argument(fmt::format("--to {:g}: a stretch is above 0; 1 is rest, 0.7 is pressed by 30 %", end));
  }
  const std::vector<double> ends = o.to.empty() ? std::vector{shear ? kOwnShear : kOwnStretch} : o.to;
  return timeline(o, o.stress || shear ? 0.0 : 1.0, ends, o.rate.value_or(o.stress ? 0.0 : kOwnRate));
}

std::size_t steps_between(const MaterialOptions& o, const Tissue& tissue) {
  return tissue.viscosity > 0.0 || !tissue.maxwell.empty() ? o.between.value_or(kOwnBetween) : 1;
}

/// A column of what is read of each state.
template <class State, class Read>
Column column(std::string name, std::string unit, const std::vector<State>& states, const Read& read) {
  Column c{std::move(name), std::move(unit), {}};
  c.values.reserve(states.size());
  for (const State& s : states) c.values.push_back(read(s));
  return c;
}

/// What of the states belongs to a test: the driven stretch and stress, and what is free.
std::vector<Column> columns_of(MaterialTest test, const std::vector<MaterialState>& states) {
  using S = MaterialState;
  const bool shear = test == MaterialTest::simple_shear;
  const std::size_t i = shear || test == MaterialTest::equibiaxial ? 0 : 2, j = shear ? 2 : i;
  std::vector<Column> columns;
  const auto add = [&](const char* name, const char* unit, const auto& read) {
    columns.push_back(column(name, unit, states, read));
  };
  add("time", "s", [](const S& s) { return s.time; });
  add(shear ? "shear" : "stretch", "", [=](const S& s) { return s.deformation(i, j); });
  add("nominal_stress", "Pa", [=](const S& s) { return s.nominal(i, j); });
  add("cauchy_stress", "Pa", [=](const S& s) { return s.cauchy(i, j); });
  if (shear) add("normal_stress", "Pa", [](const S& s) { return s.cauchy(2, 2); });
  if (test == MaterialTest::uniaxial || test == MaterialTest::planar) {
    add("lateral_stretch", "", [](const S& s) { return s.deformation(0, 0); });
  }
  if (test == MaterialTest::equibiaxial) add("lateral_stretch", "", [](const S& s) { return s.deformation(2, 2); });
  if (!shear) add("volume_ratio", "", [](const S& s) { return determinant(s.deformation); });
  for (Column& c : columns) c.rest = c.unit.empty() && c.name != "shear" ? 1.0 : 0.0;
  return columns;
}

MaterialResult homogeneous(const MaterialOptions& o, const Tissue& tissue) {
  const auto test = by_word<MaterialTest>("--test", o.test, material_test_names());
  const Timeline line = timeline_of(o, test);
  std::vector<MaterialState> states =
      material_test(tissue, test, o.stress ? MaterialControl::nominal_stress : MaterialControl::deformation, line.times,
                    line.values, steps_between(o, tissue));
  MaterialResult result;
  if (!states.back().converged) {
    result.trouble = states.back().message;
    states.pop_back();
  }
  if (states.empty()) return result;
  result.columns = columns_of(test, states);
  const bool shear = test == MaterialTest::simple_shear;
  result.charts.push_back({shear ? "Stress against shear" : "Stress against stretch", "stress", 1, {2, 3}});
  if (shear) result.charts.back().y.push_back(4);
  if (o.hold.value_or(0.0) > 0.0) {
    result.charts.push_back(o.stress ? MaterialChart{shear ? "Shear against time" : "Stretch against time", "", 0, {1}}
                                     : MaterialChart{"Stress against time", "stress", 0, {2, 3}});
  }
  return result;
}

MaterialResult twisted(const MaterialOptions& o, const Tissue& tissue) {
  const double radius = 1e-3 * above_zero("--radius-mm", o.radius_mm.value_or(kOwnSize)),
               length = 1e-3 * above_zero("--length-mm", o.length_mm.value_or(kOwnSize)),
               stretch = above_zero("--stretch", o.stretch.value_or(1.0));
  const double per_degree = std::numbers::pi / 180.0 / length;
  const std::vector<double> ends = o.to.empty() ? std::vector{kOwnAngle} : o.to;
  Timeline line = timeline(o, 0.0, ends, o.rate.value_or(kOwnAngleRate));
  for (double& value : line.values) value *= per_degree;
  const std::vector<TorsionState> states =
      torsion(tissue, radius, line.times, line.values, {.stretch = stretch, .between = steps_between(o, tissue)});
  using S = TorsionState;
  MaterialResult result;
  result.columns = {column("time", "s", states, [](const S& s) { return s.time; }),
                    column("angle", "deg", states, [=](const S& s) { return s.twist / per_degree; }),
                    column("twist", "rad/m", states, [](const S& s) { return s.twist; }),
                    column("torque", "N m", states, [](const S& s) { return s.torque; }),
                    column("axial_force", "N", states, [](const S& s) { return s.axial_force; })};
  const bool held = o.hold.value_or(0.0) > 0.0;
  const std::size_t x = held ? 0 : 1;
  const std::string over = held ? " against time" : " against angle";
  result.charts = {{"Torque" + over, "", x, {3}}, {"Axial force" + over, "", x, {4}, false, stretch == 1.0}};
  result.words = fmt::format("A cylinder of radius {:g} mm and length {:g} mm at rest, between bonded plates",
                             1e3 * radius, 1e3 * length) +
                 (stretch == 1.0 ? "." : fmt::format(", stretched by {:g} before and relaxed.", stretch));
  return result;
}

/// The indenter of the options, and words for it.
std::pair<fit::Indenter, std::string> indenter_of(const MaterialOptions& o) {
  using fit::Indenter, fit::IndenterShape;
  const std::string word = o.indenter.value_or(std::string(word_of(Indenter{}.shape)));
  Indenter indenter{.shape = by_word<IndenterShape>("--indenter", word, all_words<IndenterShape>()),
                    .contact = o.bonded ? fit::IndenterContact::bonded : fit::IndenterContact::frictionless};
  if (Indenter::has(indenter.shape, "half_angle")) {
    const double degrees = o.half_angle_deg.value_or(kOwnHalfAngle);
    if (!Indenter::kHalfAngles.contains(degrees))
      throw std::invalid_argument(
          fmt::format("--half-angle-deg {:g}: outside the allowed range, {}", degrees, Indenter::kHalfAngles.text()));
    indenter.half_angle = degrees * Indenter::kDegree;
    return {indenter, fmt::format("a cone of {:g}° half angle", degrees)};
  }
  indenter.radius = 1e-3 * above_zero("--radius-mm", o.radius_mm.value_or(kOwnSize));
  indenter.edge_radius = 1e-3 * o.edge_radius_mm.value_or(0.0);
  return {indenter, fmt::format("a {} of {:g} mm radius", indenter.shape == IndenterShape::flat ? "flat punch" : word,
                                1e3 * indenter.radius)};
}

MaterialResult indented(const MaterialOptions& o, const Tissue& tissue) {
  const auto [indenter, words] = indenter_of(o);
  fit::Layer layer;
  if (o.thickness_mm) layer.thickness = 1e-3 * above_zero("--thickness-mm", *o.thickness_mm);
  if (o.diameter_mm) layer.radius = 0.5e-3 * above_zero("--diameter-mm", *o.diameter_mm);
  if (o.force && o.to.empty()) throw std::invalid_argument("--force needs --to, the forces to go to [N]");
  Timeline line =
      timeline(o, 0.0, o.to.empty() ? std::vector{kOwnDepth} : o.to, o.rate.value_or(o.force ? 0.0 : kOwnDepthRate));
  MaterialResult result;
  try {
    std::vector<double> depths = line.values, forces = line.values;  // [mm], [N]
    if (o.force) {
      depths = fit::indentation_depths(tissue, indenter, layer, line.times, forces);
      for (double& d : depths) d *= 1e3;
    } else {
      for (double& d : line.values) d *= 1e-3;
      forces = fit::indentation(tissue, indenter, layer, line.times, line.values);
    }
    result.columns = {{"time", "s", line.times}, {"depth", "mm", std::move(depths)}, {"force", "N", std::move(forces)}};
  } catch (const std::runtime_error& error) {
    result.trouble = error.what();
    return result;
  }
  const bool held = o.hold.value_or(0.0) > 0.0;
  result.charts = {{held ? "Force against time" : "Force against depth", "", held ? std::size_t{0} : 1, {2}}};
  if (o.force && held) result.charts = {{"Depth against time", "", 0, {1}}};
  result.words = (o.thickness_mm ? fmt::format("A layer of {:g} mm, bonded to its floor, under ", *o.thickness_mm)
                                 : std::string("A half-space under ")) +
                 words + (o.bonded ? ", bonded to it." : ", without friction.");
  return result;
}

MaterialResult oscillating(const MaterialOptions& o, const Tissue& tissue) {
  const double from = above_zero("--from-hz", o.from_hz.value_or(kFromHz)),
               to = above_zero("--to-hz", o.to_hz.value_or(std::max(kToHz, from)));
  const double stretch = above_zero("--stretch", o.stretch.value_or(1.0));
  if (to < from) throw std::invalid_argument(fmt::format("--to-hz {:g}: it is below --from-hz {:g}", to, from));
  const auto mode = by_word<OscillationMode>("--mode", o.mode.value_or("simple_shear"), all_words<OscillationMode>());
  const std::size_t points = to > from ? o.points.value_or(kOwnPoints + 1) : 1;
  std::vector<double> frequencies(points, from);
  for (std::size_t k = 1; k < points; ++k) {
    frequencies[k] = from * std::pow(to / from, static_cast<double>(k) / static_cast<double>(points - 1));
  }
  if (points > 1) frequencies.back() = to;
  const std::vector<ComplexModulus> moduli = oscillation(tissue, frequencies, stretch, mode);
  using M = ComplexModulus;
  MaterialResult result;
  result.columns = {Column{"frequency", "Hz", frequencies},
                    column("storage_modulus", "Pa", moduli, [](const M& m) { return m.storage; }),
                    column("loss_modulus", "Pa", moduli, [](const M& m) { return m.loss; }),
                    column("magnitude", "Pa", moduli, [](const M& m) { return m.magnitude(); }),
                    column("loss_tangent", "", moduli, [](const M& m) { return m.loss_tangent(); })};
  result.charts = {{"Complex modulus", "modulus", 0, {1, 2}, true, false}, {"Loss tangent", "", 0, {4}, true, false}};
  result.words = std::string("A small oscillation in ") +
                 (mode == OscillationMode::simple_shear ? "simple shear: G*" : "tension: E*") +
                 (stretch == 1.0 ? "." : fmt::format(", about a static stretch of {:g}.", stretch));
  return result;
}

}  // namespace

std::string Column::heading() const {
  std::string text = unit.empty() ? name : name + "_" + unit;
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == ' ' || c == '/'; }, '_');
  return text;
}

std::string material_test_names() {
  return all_words<MaterialTest>() + ", " + kTorsion + ", " + kOscillation + ", " + kIndentation;
}

MaterialResult run_material_test(const MaterialOptions& options, const Tissue& tissue) {
  refuse_strangers(options);
  if (options.test == kTorsion) return twisted(options, tissue);
  if (options.test == kIndentation) return indented(options, tissue);
  if (options.test == kOscillation) return oscillating(options, tissue);
  return homogeneous(options, tissue);
}

}  // namespace glisson::app
