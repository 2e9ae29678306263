// scene.cpp — text in, checked scene out.
#include "glisson/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "base/input_file.h"
#include "base/nearest.h"
#include "glisson/image/read_image.h"
#include "glisson/scene/surface_file.h"
#include "scene/build/build_instruments.h"
#include "scene/build/select.h"
#include "scene/parse/expand.h"
#include "scene/parse/result_names.h"
#include "scene/parse/sections.h"
#include "scene/parse/word_table.h"

namespace glisson {
namespace {

using namespace scene;

std::vector<std::string> generated_sets(const MeshSource& mesh) {
  if (std::holds_alternative<BoxOptions>(mesh)) return {"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
  if (std::holds_alternative<CylinderOptions>(mesh)) return {"bottom", "top", "wall", "axis"};
  if (const auto* liver = std::get_if<LiverOptions>(&mesh)) {
    std::vector<std::string> sets{"bare_area",
                                  "dome",
                                  "visceral_face",
                                  "vena_cava",
                                  "coronary_ligament",
                                  "right_triangular_ligament",
                                  "left_triangular_ligament",
                                  "falciform_ligament"};
    if (liver->gallbladder) sets.emplace_back("gallbladder");
    return sets;
  }
  if (const auto* body = std::get_if<ImageBody>(&mesh)) return image_set_names(*body);
  return {};
}

/// Complains about sets that are used and exist nowhere, as far as that is known before a mesh is read.
void check_sets(const Variant& variant, const Node& experiment, Problems& problems) {
  if (std::holds_alternative<MeshFile>(variant.mesh)) return;
  std::vector<std::string> known = generated_sets(variant.mesh);
  for (const auto& [name, selection] : variant.sets) known.push_back(name);
  for (const char* user : {"fixed", "load", "tool", "capsule", "probe"}) {
    const Node* list = experiment.find(user);
    for (std::size_t i = 0; list && i < list->array()->size(); ++i) {
      if (!(*list->array())[i].find("set")) continue;
      const Node& set = *(*list->array())[i].find("set");
      if (std::find(known.begin(), known.end(), *set.text()) != known.end()) continue;
      problems.add(set.where, std::string(user) + "." + std::to_string(i) + ".set", no_such_set(*set.text(), known));
    }
  }
}

/// What a scene of heat alone has no use for.
void check_heat_alone(const Node& experiment, Problems& problems) {
  for (const char* key : {"tissue", "motion", "fixed", "load", "tool", "instrument", "container", "capsule", "probe"}) {
    if (const Node* given = experiment.find(key))
      problems.add(
          given->where, key,
          "belongs to mechanics, and a scene with [heat] is one of heat alone; leave it out, or give [heat.ice], with "
          "which the body moves and freezes");
  }
  const Node* regions = experiment.find("region");
  for (std::size_t i = 0; regions && i < regions->array()->size(); ++i) {
    const Node* tissue = (*regions->array())[i].find("tissue");
    if (tissue && !tissue->table()->empty())
      problems.add(tissue->where, "region." + std::to_string(i) + ".tissue",
                   "belongs to mechanics; give a [[heat.tissue]] with `region` = the name of this one");
  }
  const Node* output = experiment.find("output");
  for (const char* key : {"sample_rate_hz", "stored_energy"}) {
    if (const Node* given = output ? output->find(key) : nullptr)
      problems.add(given->where, std::string("output.") + key,
                   "belongs to mechanics; lines of temperature.csv are `heat.sample_every_s` apart");
  }
}

/// A second end of a run beside that of heat.
void check_one_end(const Node& experiment, Problems& problems) {
  const Node* motion = experiment.find("motion");
  const Node* given = motion ? motion->find("duration_s") : nullptr;
  if (given)
    problems.add(given->where, "motion.duration_s", "the run ends at `heat.duration_s` with [heat.ice]; leave it out");
}

/// Sets that boundaries of heat name and are not there.
void check_heat_sets(const Variant& variant, const Node& experiment, Problems& problems) {
  if (std::holds_alternative<MeshFile>(variant.mesh)) return;
  std::vector<std::string> known = generated_sets(variant.mesh);
  for (const auto& [name, selection] : variant.sets) known.push_back(name);
  for (std::size_t i = 0; i < variant.heat->boundaries.size(); ++i) {
    const std::string& set = variant.heat->boundaries[i].set;
    if (set.empty() || std::find(known.begin(), known.end(), set) != known.end()) continue;
    const Node& given = *(*experiment.find("heat")->find("boundary")->array())[i].find("set");
    problems.add(given.where, "heat.boundary." + std::to_string(i) + ".set", no_such_set(set, known));
  }
}

/// Complains about every element of `list` whose `name` an earlier one has.
void check_names(const Array& list, const std::string& path, Problems& problems) {
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const Node* name = list[i].find("name");
    const std::string own = name && name->text() ? *name->text() : path;
    if (seen.insert(folded(own)).second) continue;
    problems.add(name ? name->where : list[i].where, path + "." + std::to_string(i) + ".name",
                 "\"" + own + "\" is taken (upper and lower case count as the same); names must differ");
  }
}

/// A tool and an instrument of one name would share a file.
void check_shared_names(const Variant& variant, const Node& experiment, Problems& problems) {
  for (std::size_t i = 0; i < variant.instruments.size(); ++i) {
    for (const ToolSpec& tool : variant.tools) {
      if (folded(tool.name) != folded(variant.instruments[i].name)) continue;
      problems.add((*experiment.find("instrument")->array())[i].where, "instrument." + std::to_string(i) + ".name",
                   "\"" + variant.instruments[i].name +
                       "\" is taken by a tool (upper and lower case count as the same); names must differ");
    }
  }
}

void check_end(const Variant& variant, const Node& experiment, Problems& problems) {
  if (variant.max_steps || std::isfinite(run_duration(variant))) return;
  const Node* motion = experiment.find("motion");
  problems.add(
      motion ? motion->where : experiment.where, "motion",
      "nothing says when the run ends: give `duration_s` or `max_steps`, or a [[tool]] or [[instrument]] whose "
      "motion ends it, or a [[fixed]] set with a record");
}

using Interactions = std::vector<std::shared_ptr<Interaction>>;

/// The container and the capsules beside the instruments: what acts on the body besides supports, tools and loads; not attached.
Interactions with_others(Interactions all, const Variant& variant) {
  if (variant.container) all.push_back(std::make_shared<Container>(variant.container->options));
  for (const CapsuleSpec& x : variant.capsules) all.push_back(std::make_shared<Capsule>(x.options));
  return all;
}

/// Why an integrator does not support the interactions of a variant, after its word; empty: it does.
std::string refusal(const Variant& variant, const Interactions& interactions) {
  const Capabilities can = capabilities(variant.simulation.integrator);
  if (can.supports(is_viscous(variant))) return "";
  if (can.supports_contact) {
    for (const auto& x : interactions) {
      if (const std::string why = x->refuses_long_steps(); !why.empty())
        return " does not support " + x->label() + ", which " + why;
    }
    return "";
  }
  const std::string what = !variant.instruments.empty() ? "[[instrument]]"
                           : variant.container          ? "[container]"
                           : !variant.capsules.empty()  ? "[[capsule]]"
                                                        : "";
  if (what.empty()) return "";
  return (can.supports_interactions ? " with viscous tissue supports no " : " supports no ") + what + "; take " +
         supporting_integrators() + " (Maxwell branches may stay)";
}

/// Complains about an integrator that does not support the interactions of a variant.
void check_integrator(const Variant& variant, const Interactions& interactions, const Node& experiment,
                      Problems& problems) {
  const std::string why = refusal(variant, interactions);
  if (why.empty()) return;
  const Node& key = *experiment.find("motion")->find("integrator");
  problems.add(key.where, "motion.integrator", "\"" + *key.text() + "\"" + why);
}

/// Complains about more stages of drag than an interaction supports.
void check_stages(const Variant& variant, const Interactions& interactions, const Node& experiment,
                  Problems& problems) {
  const int stages = variant.simulation.drag_stages;
  if (stages == SimulationOptions{}.drag_stages) return;
  for (const auto& x : interactions) {
    const int most = x->most_drag_stages();
    if (stages <= most) continue;
    return problems.add(experiment.find("motion")->find("drag_stages")->where, "motion.drag_stages",
                        std::to_string(stages) + " is outside the allowed range with " + x->label() + ", 1 to " +
                            std::to_string(most) +
                            ": tissue would yield to it; take fewer stages, or integrator = \"implicit\"");
  }
}

/// Reads the file of a recorded motion along a direction.
void complete_record(RecordSpec& record, const Vec3d& along, const std::filesystem::path& base) {
  if (record.path.is_relative()) record.path = base / record.path;
  record.motion = load_record(record.path, unit(along));
}

void complete_poses(PosesSpec& poses, const std::filesystem::path& base) {
  if (poses.path.is_relative()) poses.path = base / poses.path;
  poses.motion = load_poses(poses.path);
}

/// Reads the files of recorded motions, and tries all tools and instruments with their motions.
/// @return the instruments, as they are before there is a body
Interactions complete_motions(Variant& variant, const Node& experiment, const std::filesystem::path& base,
                              Problems& problems) {
  Interactions instruments;
  for (std::size_t i = 0; i < variant.fixed.size(); ++i) {
    FixedSpec& x = variant.fixed[i];
    if (!x.record) continue;
    try {
      complete_record(*x.record, x.direction, base);
      support_path(x);
    } catch (const std::exception& error) {
      const Node& table = (*experiment.find("fixed")->array())[i];
      problems.add(table.where, "fixed." + std::to_string(i) + ".record", error.what());
    }
  }
  for (std::size_t i = 0; i < variant.tools.size(); ++i) {
    ToolSpec& x = variant.tools[i];
    if (!x.record && !x.rotation && !x.poses) continue;
    const std::string how = x.record ? "record" : x.rotation ? "rotation" : "poses";
    try {
      if (x.record) complete_record(*x.record, x.motion.direction, base);
      if (x.poses) complete_poses(*x.poses, base);
      tool_path(x);
    } catch (const std::exception& error) {
      problems.add((*experiment.find("tool")->array())[i].where, "tool." + std::to_string(i) + "." + how, error.what());
    }
  }
  for (std::size_t i = 0; i < variant.instruments.size(); ++i) {
    InstrumentSpec& x = variant.instruments[i];
    const Node& motion = *(*experiment.find("instrument")->array())[i].find("motion");
    const std::string path = "instrument." + std::to_string(i) + ".motion";
    try {
      if (auto* record = std::get_if<RecordSpec>(&x.motion.how))
        complete_record(*record, x.motion.direction.value_or(x.direction), base);
      if (auto* poses = std::get_if<PosesSpec>(&x.motion.how)) complete_poses(*poses, base);
      instruments.push_back(make_instrument(x));
    } catch (const std::exception& error) {
      problems.add(motion.where, path, error.what());
    }
  }
  return instruments;
}

/// Reads the files of surfaces among a body's shapes.
void complete_surfaces(ImplicitBody& body, const Node& experiment, const std::filesystem::path& base,
                       Problems& problems) {
  for (std::size_t i = 0; i < body.shapes.size(); ++i) {
    auto* surface = std::get_if<SurfaceShape>(&body.shapes[i].what);
    if (surface == nullptr) continue;
    const Node& key = *(*experiment.find("mesh")->find("shape")->array())[i].find("path");
    try {
      if (surface->path.is_relative()) surface->path = base / surface->path;
      *surface = load_surface(surface->path, surface->scale);
    } catch (const std::invalid_argument& error) {
      problems.add(key.where, "mesh.shape." + std::to_string(i) + ".path", error.what());
    }
  }
}

/// Looks whether an image is there and has the labels' names.
void complete_image(ImageBody& body, const Node& experiment, const std::filesystem::path& base, Problems& problems) {
  const Node& mesh = *experiment.find("mesh");
  resolve_paths(body, base);
  try {
    image_set_names(body);
  } catch (const ImageError& error) {
    problems.add(mesh.find("path")->where, "mesh.path", error.what());
  } catch (const std::invalid_argument& error) {
    problems.add(mesh.find("labels")->where, "mesh", error.what());
  }
}

/// Looks whether images of stiffness are there.
void complete_stiffness(Variant& variant, const Node& experiment, const std::filesystem::path& base,
                        Problems& problems) {
  for (std::size_t i = 0; i < variant.stiffness.size(); ++i) {
    const Node& table = (*experiment.find("stiffness")->array())[i];
    StiffnessImage& image = variant.stiffness[i];
    for (const auto& [key, path] : {std::pair("path", &image.path), std::pair("loss", &image.loss)}) {
      if (path->empty()) continue;
      if (path->is_relative()) *path = base / *path;
      try {
        read_image_grid(*path);
      } catch (const ImageError& error) {
        problems.add(table.find(key)->where, "stiffness." + std::to_string(i) + "." + key, error.what());
      }
    }
  }
}

void read_measured(MeasuredSpec& m) {
  const WordTable table = read_word_table(m.path);
  const std::size_t x = table.column(m.x), y = table.column(m.y);
  for (const auto& [at, name] : {std::pair(x, m.x), std::pair(y, m.y)}) {
    if (at < table.names.words.size()) continue;
    throw std::runtime_error(m.path.string() + ": no column \"" + name + "\"; it has: " + listed(table.names.words));
  }
  for (const WordTable::Row& row : table.rows) {
    m.xs.push_back(m.x_scale * (WordTable::number(row, x) - m.x_offset));
    m.ys.push_back(m.y_scale * WordTable::number(row, y));
  }
}

/// Charts and checks may name variants, of those that there are.
template <class Naming>
void check_variants(const std::string& what, const std::vector<Naming>& list, const Scene& scene, const Node& node,
                    Problems& problems) {
  std::vector<std::string> known;
  for (const Variant& v : scene.variants) known.push_back(v.name);
  for (std::size_t i = 0; i < list.size(); ++i) {
    for (std::size_t k = 0; k < list[i].variants.size(); ++k) {
      const std::string& name = list[i].variants[k];
      if (std::find(known.begin(), known.end(), name) != known.end()) continue;
      const Node& word = (*(*node.find(what)->array())[i].find("variants")->array())[k];
      problems.add(word.where, what + "." + std::to_string(i) + ".variants",
                   "no variant \"" + name + "\"; the scene has: " + listed(known));
    }
  }
}

/// Reads what charts show of measurements.
void load_measured(Scene& scene, const Node& node, const std::filesystem::path& base, Problems& problems) {
  for (std::size_t i = 0; i < scene.charts.size(); ++i) {
    for (std::size_t k = 0; k < scene.charts[i].measured.size(); ++k) {
      MeasuredSpec& m = scene.charts[i].measured[k];
      const Node& chart = (*node.find("chart")->array())[i];
      if (m.path.is_relative()) m.path = base / m.path;
      try {
        read_measured(m);
      } catch (const std::exception& error) {
        problems.add((*chart.find("measured")->array())[k].where, "chart." + std::to_string(i) + ".measured",
                     error.what());
      }
    }
  }
}

/// Says in the notes of a scene what was done to close surfaces.
void note_repairs(Scene& scene) {
  for (const Variant& variant : scene.variants) {
    for (const std::string& repair : surface_repairs(variant)) {
      if (std::find(scene.notes.begin(), scene.notes.end(), repair) == scene.notes.end()) scene.notes.push_back(repair);
    }
  }
}

}  // namespace

int most_drag_stages(const Variant& variant) {
  int most = kMostDragStages;
  Interactions instruments;
  for (const InstrumentSpec& x : variant.instruments) instruments.push_back(make_instrument(x));
  for (const auto& x : with_others(std::move(instruments), variant)) most = std::min(most, x->most_drag_stages());
  return most;
}

Variant scene::read_variant(const Node& experiment, const std::filesystem::path& base, Problems& problems) {
  Variant variant;
  variant.scene_name = problems.file();
  const std::size_t before = problems.count();
  read_section(variant_section(), experiment, &variant, {problems, "", experiment.where});
  if (problems.count() > before) return variant;
  if (variant.heat) {
    is_heat_alone(variant) ? check_heat_alone(experiment, problems) : check_one_end(experiment, problems);
    check_heat_sets(variant, experiment, problems);
  }
  auto* file = std::get_if<MeshFile>(&variant.mesh);
  if (file && file->path.is_relative()) file->path = base / file->path;
  if (auto* body = std::get_if<ImplicitBody>(&variant.mesh)) complete_surfaces(*body, experiment, base, problems);
  if (auto* body = std::get_if<ImageBody>(&variant.mesh)) complete_image(*body, experiment, base, problems);
  complete_stiffness(variant, experiment, base, problems);
  if (problems.count() > before) return variant;
  Interactions instruments = complete_motions(variant, experiment, base, problems);
  if (problems.count() > before) return variant;
  if (const Node* tools = experiment.find("tool")) check_names(*tools->array(), "tool", problems);
  if (const Node* list = experiment.find("instrument")) check_names(*list->array(), "instrument", problems);
  check_shared_names(variant, experiment, problems);
  if (const Node* regions = experiment.find("region")) check_names(*regions->array(), "region", problems);
  if (const Node* probes = experiment.find("probe")) check_names(*probes->array(), "probe", problems);
  check_sets(variant, experiment, problems);
  const Interactions interactions = with_others(std::move(instruments), variant);
  check_integrator(variant, interactions, experiment, problems);
  check_stages(variant, interactions, experiment, problems);
  check_end(variant, experiment, problems);
  return variant;
}

std::vector<std::string> surface_repairs(const Variant& variant) {
  std::vector<std::string> repairs;
  const auto* body = std::get_if<ImplicitBody>(&variant.mesh);
  for (std::size_t i = 0; body != nullptr && i < body->shapes.size(); ++i) {
    const auto* surface = std::get_if<SurfaceShape>(&body->shapes[i].what);
    if (surface != nullptr && !surface->repaired.empty()) repairs.push_back(surface->repaired);
  }
  return repairs;
}

Scene parse_scene(std::string_view text, const std::string& name, const std::filesystem::path& base,
                  std::span<const Override> overrides) {
  const Node root = parse_document(text, name);
  Problems problems(name, {&scene_section(), &variant_section()});
  const Expanded expanded = expand(root, overrides, base, problems);
  Scene result;
  result.file = name;
  result.source = text;
  read_section(scene_section(), expanded.scene, &result, {problems, "", root.where});
  read_section(variant_section(), expanded.base, nullptr, {problems, "", root.where});
  for (const Node& experiment : expanded.variants) result.variants.push_back(read_variant(experiment, base, problems));
  if (problems.count() == 0) {
    check_names(expanded.variants, "variant", problems);
    const auto is_heat = [](const Variant& v) { return v.heat.has_value(); };
    if (!std::all_of(result.variants.begin(), result.variants.end(), is_heat) &&
        std::any_of(result.variants.begin(), result.variants.end(), is_heat)) {
      problems.add(root.where, "variant",
                   "some variants have [heat] and others have not; put these into a scene of their own");
    }
    check_variants("chart", result.charts, result, expanded.scene, problems);
    check_variants("check", result.checks, result, expanded.scene, problems);
    load_measured(result, expanded.scene, base, problems);
  }
  problems.throw_if_any();
  note_repairs(result);
  if (result.title.empty()) result.title = result.file.stem().string();
  return result;
}

Scene load_scene(const std::filesystem::path& file, std::span<const Override> overrides) {
  const detail::InputFile input = detail::read_input(file, detail::kTomlInput);
  if (!input.problem.empty()) throw SceneError(input.problem);
  return parse_scene(input.bytes, file.string(), file.parent_path(), overrides);
}

}  // namespace glisson
