// recorded_scene.cpp — see glisson/scene/recorded_scene.h.
#include "glisson/scene/recorded_scene.h"

#include <algorithm>
#include <sstream>

#include "scene/parse/document.h"
#include "scene/parse/expand.h"
#include "scene/parse/problems.h"

namespace glisson::scene {
namespace {

Node text_node(const std::string& text) { return {text, {}}; }
Node number_node(double value) { return {value, {}}; }
Node list_node(const std::vector<double>& values) {
  Array list;
  for (const double x : values) list.push_back(number_node(x));
  return {std::move(list), {}};
}

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

/// `{ kind = …, … }` of a law, by the keys it describes itself with.
template <class Laws>
Node law_node(const Laws& laws) {
  Node node{Table{}, {}};
  const auto put = [&](const std::string& key, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      set(node, key, number_node(value));
    } else {
      set(node, key, list_node(value));
    }
  };
  std::visit(
      [&](const auto& law) {
        using Law = std::decay_t<decltype(law)>;
        set(node, "kind", text_node(std::string(Law::kName)));
        each_field<Law>([&](const auto& x) { put(x.key(), law.*x.member); });
      },
      laws);
  return node;
}

void put_elasticity(Node& tissue, const Tissue& now) {
  if (now.hyperelastic) return set(tissue, "hyperelastic", law_node(*now.hyperelastic));
  drop(tissue, {"lambda_Pa", "mu_Pa"});
  set(tissue, "youngs_modulus_Pa", number_node(now.youngs_modulus));
  set(tissue, "poisson_ratio", number_node(now.poisson_ratio));
  if (now.lambda_law) set(tissue, "lambda_law", law_node(*now.lambda_law));
  if (now.mu_law) set(tissue, "mu_law", law_node(*now.mu_law));
  if (!now.lambda_law && !now.mu_law) set(tissue, "law", law_node(now.law));
}

/// What sliders change, as it is now.
void put_tissue(Node& tissue, const Tissue& now) {
  put_elasticity(tissue, now);
  set(tissue, "viscosity_Pa_s", number_node(now.viscosity));
  if (now.fibres) set(section(tissue, "fibres"), "stiffness_Pa", number_node(now.fibres->stiffness));
  if (now.maxwell.empty()) return;
  Array branches;
  for (const MaxwellBranch& b : now.maxwell) {
    Node& branch = branches.emplace_back(Node{Table{}, {}});
    set(branch, "share", number_node(b.share));
    set(branch, "time_s", number_node(b.time));
    if (b.time_law) set(branch, "time_law", law_node(*b.time_law));
  }
  set(tissue, "maxwell", {std::move(branches), {}});
}

void put_tissues(Node& experiment, const Variant& variant) {
  put_tissue(section(experiment, "tissue"), variant.tissue);
  Node* regions = experiment.find("region");
  if (!regions || !regions->array()) return;
  for (std::size_t i = 0; i < std::min(regions->array()->size(), variant.regions.size()); ++i)
    put_tissue(section((*regions->array())[i], "tissue"), variant.regions[i].tissue);
}

void put_paths(Node& experiment, const RecordedPaths& ways) {
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
}  // namespace glisson::scene

namespace glisson {

std::string recorded_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                           std::span<const Override> overrides, const Variant& variant, const RecordedPaths& ways) {
  using namespace scene;
  Problems problems(name);
  Expanded expanded = expand(parse_document(text, name), overrides, base, problems);
  problems.throw_if_any();
  Node experiment = experiment_called(expanded.variants, variant.name);
  drop(experiment, {"name", "label"});
  drop(expanded.scene, {"chart", "variant"});
  put_tissues(experiment, variant);
  put_paths(experiment, ways);
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

}  // namespace glisson
