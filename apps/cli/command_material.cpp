// command_material.cpp — glisson material: the curve of a tissue in a homogeneous test.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <regex>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/exit_code.h"
#include "cli/scene_options.h"
#include "cli/standard_streams.h"
#include "cli/tissue_text.h"
#include "glisson/material_point.h"
#include "glisson/scene/scene.h"
#include "glisson/scene/tissue_presets.h"
#include "report/json_text.h"
#include "report/output_file.h"

namespace glisson::app {
namespace {

constexpr double kOwnRate = 0.01;    // of stretch, where none is given [1/s]
constexpr double kOwnStretch = 1.3;  // where no end is given
constexpr double kOwnShear = 0.5;

struct MaterialOptions {
  std::string tissue, test = "uniaxial";
  std::vector<double> to;
  bool stress = false;
  std::optional<double> rate;
  double hold = 0.0;
  std::size_t points = 20;
  std::size_t between = 10;
  std::string csv;
  bool json = false;
};

/// A preset by its name, or the tissue of a scene's first variant; a file of a tissue alone, as a fit writes it, will do.
Tissue open_tissue(const std::string& name) {
  const std::filesystem::path file(name);
  if (file.extension() != ".toml") return tissue_preset(name).tissue;
  std::ifstream in(file);
  if (!in) throw std::invalid_argument(name + ": there is no such file");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::regex mesh(R"((^|\n)[ \t]*\[?[ \t]*mesh\b)");
  if (!std::regex_search(text, mesh)) text += "\n[mesh]\nkind = \"box\"\n[motion]\nmax_steps = 1\n";
  const Scene scene = parse_scene(text, name, file.parent_path());
  return scene.variants.front().tissue;
}

MaterialTest test_of(const std::string& name) {
  std::string known;
  for (const auto& w : kWords<MaterialTest>) {
    if (w.word == name) return w.value;
    known += (known.empty() ? "" : ", ") + std::string(w.word);
  }
  throw std::invalid_argument("--test " + name + ": there is no such test; allowed: " + known);
}

/// The driven value over time: from rest to each end in turn at the rate, then held.
struct Course {
  std::vector<double> times, values;
};

Course course_of(const MaterialOptions& o, MaterialTest test) {
  const bool shear = test == MaterialTest::simple_shear;
  if (o.stress && o.to.empty()) {
    throw std::invalid_argument("--stress: --to is missing: the nominal stress to go to [Pa], such as --to 500");
  }
  const std::vector<double> ends = o.to.empty() ? std::vector{shear ? kOwnShear : kOwnStretch} : o.to;
  double value = o.stress || shear ? 0.0 : 1.0, time = 0.0;
  Course course;
  for (const double end : ends) {
    if (!o.stress && !shear && !(end > 0.0)) {
      throw std::invalid_argument(
          fmt::format("--to {:g}: a stretch is above 0; 1 is rest, 0.7 is pressed by 30 %", end));
    }
    const double way = std::abs(end - value);
    const double length = way > 0.0 ? way / o.rate.value_or(o.stress ? way : kOwnRate) : 0.0;
    for (std::size_t i = 1; i <= o.points && way > 0.0; ++i) {
      const double share = static_cast<double>(i) / static_cast<double>(o.points);
      course.times.push_back(time + share * length);
      course.values.push_back(i == o.points ? end : value + share * (end - value));
    }
    value = end, time += length;
  }
  for (std::size_t i = 1; i <= o.points && o.hold > 0.0; ++i) {
    course.times.push_back(time + o.hold * static_cast<double>(i) / static_cast<double>(o.points));
    course.values.push_back(value);
  }
  if (course.times.empty())
    throw std::invalid_argument("--to: the test ends where it starts; give another end, or --hold");
  return course;
}

struct Column {
  std::string name, unit;
  std::vector<double> values;
};

/// What of the states belongs to a test: the driven stretch and stress, and what is free.
std::vector<Column> columns_of(MaterialTest test, const std::vector<MaterialState>& states) {
  const bool shear = test == MaterialTest::simple_shear;
  const std::size_t i = shear || test == MaterialTest::equibiaxial ? 0 : 2, j = shear ? 2 : i;
  std::vector<Column> columns;
  const auto add = [&](std::string name, std::string unit, const auto& value) {
    columns.push_back({std::move(name), std::move(unit), {}});
    for (const MaterialState& s : states) columns.back().values.push_back(value(s));
  };
  add("time", "s", [](const MaterialState& s) { return s.time; });
  add(shear ? "shear" : "stretch", "", [=](const MaterialState& s) { return s.deformation(i, j); });
  add("nominal_stress", "Pa", [=](const MaterialState& s) { return s.nominal(i, j); });
  add("cauchy_stress", "Pa", [=](const MaterialState& s) { return s.cauchy(i, j); });
  if (shear) add("normal_stress", "Pa", [](const MaterialState& s) { return s.cauchy(2, 2); });
  if (test == MaterialTest::uniaxial || test == MaterialTest::planar) {
    add("lateral_stretch", "", [](const MaterialState& s) { return s.deformation(0, 0); });
  }
  if (test == MaterialTest::equibiaxial)
    add("lateral_stretch", "", [](const MaterialState& s) { return s.deformation(2, 2); });
  if (!shear) add("volume_ratio", "", [](const MaterialState& s) { return determinant(s.deformation); });
  return columns;
}

std::string heading(const Column& c) { return c.unit.empty() ? c.name : c.name + "_" + c.unit; }

std::string csv_text(const std::vector<Column>& columns) {
  std::string text;
  for (const Column& c : columns) text += (text.empty() ? "" : ",") + heading(c);
  for (std::size_t row = 0; row < columns.front().values.size(); ++row) {
    for (std::size_t k = 0; k < columns.size(); ++k)
      text += fmt::format("{}{}", k == 0 ? "\n" : ",", columns[k].values[row]);
  }
  return text + "\n";
}

void print_table(const std::vector<Column>& columns) {
  for (const Column& c : columns) say("{:>21}", c.unit.empty() ? c.name : c.name + " [" + c.unit + "]");
  say("\n");
  for (std::size_t row = 0; row < columns.front().values.size(); ++row) {
    for (const Column& c : columns) say("{:>21.6g}", c.values[row]);
    say("\n");
  }
}

void print_json(const MaterialOptions& options, const Tissue& tissue, const std::vector<Column>& columns) {
  nlohmann::ordered_json json;
  json["tissue"] = tissue.name;
  json["test"] = options.test;
  for (const Column& c : columns) json["columns"][heading(c)] = c.values;
  say("{}\n", json_text(json, 2));
}

int material(const MaterialOptions& options) {
  const MaterialTest test = test_of(options.test);
  const Tissue tissue = open_tissue(options.tissue);
  const Course course = course_of(options, test);
  const bool past = tissue.viscosity > 0.0 || !tissue.maxwell.empty();
  std::vector<MaterialState> states =
      material_test(tissue, test, options.stress ? MaterialControl::nominal_stress : MaterialControl::deformation,
                    course.times, course.values, past ? options.between : 1);
  std::string trouble;
  if (!states.back().converged) {
    trouble = states.back().message;
    states.pop_back();
  }
  if (!states.empty()) {
    const std::vector<Column> columns = columns_of(test, states);
    if (!options.csv.empty()) write_whole(options.csv, csv_text(columns));
    if (options.json) {
      print_json(options, tissue, columns);
    } else {
      say("{}: {}\n{}\n\n", tissue.name, law_text(tissue), options.test);
      print_table(columns);
      if (!options.csv.empty()) say("written: {}\n", options.csv);
    }
  }
  if (trouble.empty()) return kDone;
  tell("glisson: {}\n", trouble);
  return kFailed;
}

}  // namespace

void add_material(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("material", "print the curve of a tissue in a homogeneous test");
  const auto options = std::make_shared<MaterialOptions>();
  command->add_option("tissue", options->tissue, "a preset (glisson tissues), or a scene or tissue.toml with [tissue]")
      ->required()
      ->type_name("TISSUE");
  command->add_option("--test", options->test, "uniaxial, equibiaxial, planar, simple_shear, volumetric")
      ->type_name("NAME")
      ->capture_default_str();
  command
      ->add_option("--to", options->to,
                   "stretches to go to from 1, one after the other (of simple_shear its amount, from 0); default 1.3 "
                   "(0.5)")
      ->type_name("LIST")
      ->delimiter(',');
  command->add_flag("--stress", options->stress, "--to is nominal stress [Pa]: creep with --hold");
  command
      ->add_option("--rate", options->rate,
                   "of the driven value [1/s, Pa/s]; default 0.01, with --stress a second for each end")
      ->type_name("R")
      ->check(CLI::PositiveNumber);
  command->add_option("--hold", options->hold, "time for which the last value is held [s]")
      ->type_name("S")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  command->add_option("--points", options->points, "lines for each end, and for the hold")
      ->type_name("N")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--between", options->between, "steps for each line, where the tissue has viscosity or branches")
      ->type_name("N")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  command->add_option("--csv", options->csv, "write the table to this file too")->type_name("FILE");
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "z is the axis of the specimen; of equibiaxial tests x and y are driven, in simple shear x moves with z.\n"
      "Nominal stress is force over area at rest.\n\n"
      "Examples:\n  glisson material brain_miller --to 0.7\n"
      "  glisson material phantom_ef10_100t --test simple_shear --to 0.5,0\n"
      "  glisson material out/fit/tissue.toml --to 0.8 --rate 0.1 --hold 60 --csv hold.csv\n"
      "  glisson material liver_mre --stress --to 200 --hold 10");
  command->callback([options, &action] { action = [options] { return material(*options); }; });
}

}  // namespace glisson::app
