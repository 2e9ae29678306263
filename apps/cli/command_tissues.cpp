// command_tissues.cpp — glisson tissues: the tissues with a source that scenes can start from.
#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>

#include "cli/commands.h"
#include "cli/tissue_text.h"
#include "glisson/scene/tissue_presets.h"
#include "program/exit_code.h"
#include "program/standard_streams.h"
#include "report/json_text.h"

namespace glisson::app {
namespace {

struct TissuesOptions {
  std::string name;
  bool json = false;
};

nlohmann::ordered_json preset_json(const TissuePreset& p) {
  nlohmann::ordered_json json;
  json["name"] = p.name;
  json["what"] = p.what;
  json["law"] = law_text(p.tissue);
  json["fitted_to"] = p.fitted_to;
  json["source"] = p.source;
  json["validity"] = p.validity;
  json["confirmed"] = p.confirmed;
  json["density_kg_m3"] = p.tissue.density;
  json["toml"] = p.toml;
  return json;
}

void print_short(const TissuePreset& p) {
  say("{}\n  {}\n  law        {}\n  fitted to  {}\n  source     {}\n\n", p.name, p.what, law_text(p.tissue),
      p.fitted_to, p.source);
}

void print_whole(const TissuePreset& p) {
  say("{}\n  {}\n\n  law        {}\n  density    {:g} kg/m³\n", p.name, p.what, law_text(p.tissue), p.tissue.density);
  say("  fitted to  {}\n  source     {}\n  validity   {}\n  confirmed  {}\n", p.fitted_to, p.source, p.validity,
      p.confirmed);
  say("\nIn a scene:\n\n[tissue]\npreset = \"{}\"\n\nor, to change more than single keys:\n\n{}", p.name, p.toml);
}

int tissues(const TissuesOptions& options) {
  const bool all = options.name.empty();
  if (options.json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const TissuePreset& p : tissue_presets()) list.push_back(preset_json(p));
    say("{}\n", json_text(all ? list : preset_json(tissue_preset(options.name)), 2));
    return kDone;
  }
  if (!all) {
    print_whole(tissue_preset(options.name));
    return kDone;
  }
  for (const TissuePreset& p : tissue_presets()) print_short(p);
  say("`glisson tissues NAME` shows the validity of a preset and prints it as TOML; docs/tissues.md compares them.\n");
  return kDone;
}

}  // namespace

void add_tissues(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("tissues", "print the tissue presets for scenes");
  const auto options = std::make_shared<TissuesOptions>();
  command->add_option("name", options->name, "print this preset in full");
  command->add_flag("--json", options->json, "print JSON");
  command->footer("Examples:\n  glisson tissues\n  glisson tissues brain_miller");
  command->callback([options, &action] { action = [options] { return tissues(*options); }; });
}

}  // namespace glisson::app
