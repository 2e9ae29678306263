// recorded_scene.cpp — see recorded_scene.h.
#include "scene/recorded_scene.h"

#include <algorithm>
#include <sstream>

#include "scene/document.h"
#include "scene/expand.h"
#include "scene/problems.h"

namespace glisson::scene {
namespace {

Node text_node(const std::string& text) { return {text, {}}; }
Node number_node(double value) { return {value, {}}; }

void set(Node& table, const std::string& key, Node value) {
  if (Node* known = table.find(key)) {
    *known = std::move(value);
  } else {
    table.table()->push_back({key, {}, std::move(value)});
  }
}

void drop(Node& table, std::initializer_list<std::string_view> keys) {
  std::erase_if(*table.table(),
                [&](const Member& m) { return std::find(keys.begin(), keys.end(), m.key) != keys.end(); });
}

Node& section(Node& table, const std::string& key) {
  if (table.find(key) == nullptr) table.table()->push_back({key, {}, {Table{}, {}}});
  return *table.find(key);
}

const Node& experiment_called(const Array& experiments, const std::string& name) {
  for (const Node& x : experiments) {
    const Node* own = x.find("name");
    if (own && own->text() && *own->text() == name) return x;
  }
  return experiments.front();
}

/// What sliders change, as it is now.
void put_tissue(Node& tissue, const Tissue& now) {
  if (!now.hyperelastic) {
    drop(tissue, {"lambda_Pa", "mu_Pa"});
    set(tissue, "youngs_modulus_Pa", number_node(now.youngs_modulus));
    set(tissue, "poisson_ratio", number_node(now.poisson_ratio));
  }
  set(tissue, "viscosity_Pa_s", number_node(now.viscosity));
}

void put_tissues(Node& experiment, const Variant& variant) {
  put_tissue(section(experiment, "tissue"), variant.tissue);
  Node* regions = experiment.find("region");
  if (!regions || !regions->array()) return;
  for (std::size_t i = 0; i < std::min(regions->array()->size(), variant.regions.size()); ++i)
    put_tissue(section((*regions->array())[i], "tissue"), variant.regions[i].tissue);
}

void put_ways(Node& experiment, const RecordedWays& ways) {
  std::size_t way = 0;
  const auto each = [&](const char* key, auto put) {
    Node* list = experiment.find(key);
    if (!list || !list->array()) return;
    for (Node& tool : *list->array()) {
      if (way < ways.files.size()) put(tool, text_node(ways.files[way++]));
    }
  };
  each("tool", [](Node& tool, const Node& path) {
    drop(tool, {"velocity_mm_s", "depth_mm", "start_s", "ramp_s", "hold_s", "returns", "record"});
    set(section(tool, "record"), "path", path);
  });
  each("instrument", [](Node& tool, const Node& path) {
    drop(tool, {"motion"});
    set(section(tool, "motion"), "kind", text_node("record"));
    set(section(tool, "motion"), "path", path);
  });
}

void write_table(std::ostringstream& out, const Node& table) {
  for (const Member& m : *table.table()) out << toml_key(m.key) << " = " << toml_text(m.value) << "\n";
}

bool is_list_of_tables(const Node& node) {
  const Array* list = node.array();
  return list && !list->empty() && std::all_of(list->begin(), list->end(), [](const Node& x) { return x.table(); });
}

/// Plain keys first: after a heading they would belong to it.
void write_members(std::ostringstream& out, const Table& table) {
  for (const Member& m : table) {
    if (!m.value.table() && !is_list_of_tables(m.value)) out << toml_key(m.key) << " = " << toml_text(m.value) << "\n";
  }
  for (const Member& m : table) {
    if (m.value.table()) {
      out << "\n[" << toml_key(m.key) << "]\n";
      write_table(out, m.value);
    } else if (is_list_of_tables(m.value)) {
      for (const Node& x : *m.value.array()) {
        out << "\n[[" << toml_key(m.key) << "]]\n";
        write_table(out, x);
      }
    }
  }
}

std::string comment(const std::string& head) {
  std::istringstream lines(head);
  std::string text, line;
  while (std::getline(lines, line)) text += line.empty() ? "#\n" : "# " + line + "\n";
  return text;
}

}  // namespace

std::string recorded_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                           std::span<const Override> overrides, const Variant& variant, const RecordedWays& ways) {
  Problems problems(name);
  Expanded expanded = expand(parse_document(text, name), overrides, base, problems);
  problems.throw_if_any();
  Node experiment = experiment_called(expanded.variants, variant.name);
  drop(experiment, {"name", "label"});
  drop(expanded.scene, {"chart", "variant"});
  put_tissues(experiment, variant);
  put_ways(experiment, ways);
  Node& motion = section(experiment, "motion");
  drop(motion, {"max_steps"});
  set(motion, "duration_s", number_node(ways.duration));
  set(section(experiment, "output"), "sample_rate_hz", number_node(ways.sample_rate));
  std::ostringstream out;
  out << comment(ways.head) << "\n";
  Table all = *expanded.scene.table();
  all.insert(all.end(), experiment.table()->begin(), experiment.table()->end());
  write_members(out, all);
  return out.str();
}

}  // namespace glisson::scene
