// command_material.cpp — glisson material: the curve of a tissue in a test of the material.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/commands.h"
#include "cli/material_picture.h"
#include "cli/material_tests.h"
#include "cli/tissue_text.h"
#include "glisson/scene/tissue_presets.h"
#include "program/exit_code.h"
#include "program/option_check.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/json_text.h"
#include "report/output_file.h"

namespace glisson::app {
namespace {

/// A preset by its name, or the tissue of a scene's first variant; a file of a tissue alone, as a fit writes it, will do.
Tissue open_tissue(const std::string& name) {
  const std::filesystem::path file(name);
  if (file.extension() != ".toml") return tissue_preset(name).tissue;
  std::ifstream in(file);
  if (!in) throw std::invalid_argument(name + ": there is no such file");
  std::string text{std::istreambuf_iterator<char>(in), {}};
  return tissue_of_toml(std::move(text), name, file.parent_path());
}

std::string csv_text(const std::vector<Column>& columns) {
  std::string text;
  for (const Column& c : columns) text += (text.empty() ? "" : ",") + c.heading();
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
  for (const Column& c : columns) json["columns"][c.heading()] = c.values;
  say("{}\n", json_text(json, 2));
}

int material(const MaterialOptions& options) {
  if (!options.picture.empty() && std::filesystem::path(options.picture).extension() != ".html") {
    throw std::invalid_argument("--picture " + options.picture +
                                ": the picture is a page; give a name that ends in .html");
  }
  const Tissue tissue = open_tissue(options.tissue);
  const MaterialResult result = run_material_test(options, tissue);
  if (!result.columns.empty()) {
    if (!options.csv.empty()) write_whole(options.csv, csv_text(result.columns));
    if (!options.picture.empty()) write_whole(options.picture, material_page(options, tissue, result));
    if (options.json) {
      print_json(options, tissue, result.columns);
    } else {
      say("{}: {}\n{}\n\n", tissue.name, law_text(tissue), options.test);
      print_table(result.columns);
      for (const std::string& file : {options.csv, options.picture}) {
        if (!file.empty()) say("written: {}\n", file);
      }
    }
  }
  if (result.trouble.empty()) return kDone;
  tell("glisson: {}\n", result.trouble);
  return kFailed;
}

}  // namespace

void add_material(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("material", "print the curve of a tissue in a test of the material");
  const auto options = std::make_shared<MaterialOptions>();
  command->add_option("tissue", options->tissue, "a preset (glisson tissues), or a scene or tissue.toml with [tissue]")
      ->required()
      ->type_name("TISSUE");
  command->add_option("--test", options->test, material_test_names())->type_name("NAME")->capture_default_str();
  command
      ->add_option(
          "--to", options->to,
          "stretches to go to from 1, one after the other; of simple_shear its amount, of torsion angles [deg] "
          "and of indentation depths [mm], from 0;\ndefault 1.3, 0.5, 30, 1")
      ->type_name("LIST")
      ->delimiter(',');
  command->add_flag("--stress", options->stress, "--to is nominal stress [Pa]: creep with --hold");
  command->add_flag("--force", options->force, "of indentation: --to is force [N]: creep with --hold");
  command
      ->add_option(
          "--rate", options->rate,
          "of the driven value [1/s, Pa/s, deg/s, mm/s, N/s]; default 0.01, of torsion and indentation 1, with "
          "--stress and --force a second for each end")
      ->type_name("R")
      ->check(within(above(0), Numbers::all));
  command->add_option("--hold", options->hold, "time for which the last value is held [s]; default 0")
      ->type_name("S")
      ->check(within(at_least(0), Numbers::all));
  command
      ->add_option("--points", options->points,
                   "lines for each end, and for the hold; default 20, of oscillation 21 in all")
      ->type_name("N")
      ->check(within(between(1, 100000), Numbers::whole));
  command
      ->add_option("--between", options->between,
                   "steps for each line, where the tissue has viscosity or branches; default 10")
      ->type_name("N")
      ->check(within(between(1, 100000), Numbers::whole));
  command
      ->add_option(
          "--radius-mm", options->radius_mm,
          "of torsion: radius of the cylinder at rest; of indentation: of the sphere or flat punch; default 10")
      ->type_name("R");
  command->add_option("--length-mm", options->length_mm, "of torsion: its length at rest; default 10")->type_name("L");
  command
      ->add_option("--stretch", options->stretch,
                   "of torsion and oscillation: static stretch along z before, relaxed; default 1")
      ->type_name("X");
  command->add_option("--indenter", options->indenter, "of indentation: sphere, the default, flat or cone")
      ->type_name("WORD");
  command
      ->add_option("--edge-radius-mm", options->edge_radius_mm,
                   "of a flat punch: of its rounded edge; default 0, sharp")
      ->type_name("R");
  command->add_option("--half-angle-deg", options->half_angle_deg, "of a cone: between axis and side; default 60")
      ->type_name("A");
  command->add_option("--thickness-mm", options->thickness_mm, "of indentation: of the layer; default a half-space")
      ->type_name("H");
  command->add_option("--diameter-mm", options->diameter_mm, "of indentation: of the specimen; default wide")
      ->type_name("D");
  command->add_flag("--bonded", options->bonded, "of indentation: tissue sticks to the indenter");
  command->add_option("--from-hz", options->from_hz, "of oscillation: lowest frequency; default 0.01")->type_name("F");
  command->add_option("--to-hz", options->to_hz, "of oscillation: highest frequency; default 100")->type_name("F");
  command->add_option("--mode", options->mode, "of oscillation: simple_shear for G*, the default, or uniaxial for E*")
      ->type_name("WORD");
  command->add_option("--csv", options->csv, "write the table to this file too")->type_name("FILE");
  command->add_option("--picture", options->picture, "draw the curve as a page too: FILE.html")->type_name("FILE");
  command->add_flag("--json", options->json, "print JSON");
  command->footer(
      "z is the axis of the specimen; of equibiaxial tests x and y are driven, in simple shear x moves with z.\n"
      "Nominal stress is force over area at rest. Torsion is that of a cylinder between bonded plates at a fixed\n"
      "distance, oscillation a small one about a static state.\n\n"
      "Examples:\n  glisson material brain_miller --to 0.7\n"
      "  glisson material phantom_ef10_100t --test simple_shear --to 0.5,0\n"
      "  glisson material out/fit/tissue.toml --to 0.8 --rate 0.1 --hold 60 --csv hold.csv\n"
      "  glisson material liver_mre --stress --to 200 --hold 10\n"
      "  glisson material brain_miller --test torsion --radius-mm 15 --length-mm 10 --to 20 --rate 60 --hold 30\n"
      "  glisson material brain_miller --test oscillation --from-hz 0.001 --to-hz 10 --stretch 0.9");
  command->callback([options, &action] { action = [options] { return material(*options); }; });
}

}  // namespace glisson::app
