// command_check.cpp — glisson check: what a scene means and what it would cost, from a tenth of a second of each variant.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "cli/advice_lines.h"
#include "cli/check_clock.h"
#include "cli/check_steps.h"
#include "cli/commands.h"
#include "cli/heat_scene.h"
#include "cli/progress.h"
#include "cli/tissue_text.h"
#include "glisson/scene/body_places.h"
#include "program/exit_code.h"
#include "program/mesh_cache.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "report/summary_json.h"

namespace glisson::app {
namespace {

constexpr const char* kCheckFooter =
    "Reads the scene, builds every variant, steps it for a tenth of a second and prints mesh, vertex\n"
    "sets, tissue, stable step, and the steps and the time a run will take. Writes nothing. Exit status 2 if the\n"
    "scene cannot be run, 3 if its numbers end a run within that time, 4 if time ran out before every variant was "
    "looked\n"
    "at. It takes ten seconds at most: what there is no time for is left out, and said.\n"
    "\n"
    "Examples:\n"
    "  glisson check scenes/paper/figure3b.toml\n"
    "  glisson check scenes/organs/own_liver.toml --mesh liver.vtu --set tissue.poisson_ratio=0.45";

struct CheckOptions {
  SceneOptions scene;
  int threads = 1;
};

std::string tissue_text(const Tissue& t) { return fmt::format("{}, ρ = {:.6g} kg/m³", law_text(t), t.density); }

void print_mesh(const VariantAtRest& rest) {
  const MeshReport& report = rest.report;
  const Vec3d size = report.box_max - report.box_min;
  say("  mesh     {} vertices, {} tets, {:.4g} × {:.4g} × {:.4g} mm, {:.4g} ml, {:.4g} g; shape {:.3f} worst, {:.3f} "
      "median\n",
      report.vertices, report.tets, 1e3 * size.x, 1e3 * size.y, 1e3 * size.z, 1e6 * report.volume, 1e3 * rest.mass_kg,
      report.worst_mean_ratio, report.median_mean_ratio);
}

/// A set by its vertices that hold and bear: those of tets.
std::string set_text(const TetMesh& mesh, const std::string& set) {
  const auto found = mesh.vertex_sets.find(set);
  if (found == mesh.vertex_sets.end()) return fmt::format("\"{}\", 0 vertices", set);
  const std::vector<char> in_tet = vertices_in_tets(mesh);
  const auto bearing =
      std::count_if(found->second.begin(), found->second.end(), [&](auto v) { return in_tet[v] != 0; });
  const auto left_out = std::ssize(found->second) - bearing;
  return fmt::format("\"{}\", {} vertices", set, bearing) +
         (left_out > 0 ? fmt::format(" (left out: {} in no tet, which bear nothing)", left_out) : "");
}

std::string axes_text(const Axes& axes) {
  return std::string(axes.x ? "x" : "") + (axes.y ? "y" : "") + (axes.z ? "z" : "");
}

/// The word of `kind` for what a variant holds; what no scene file gives has none.
template <class... T>
std::string kind_word(const std::variant<T...>& what) {
  const auto word = []<class What>(const What& x) -> std::string {
    if constexpr (std::is_same_v<What, ContactOptions>)
      return kind_word(x.shape);
    else if constexpr (requires { What::kName; })
      return std::string(What::kName);
    else
      return "program's own";
  };
  return std::visit(word, what);
}

/// Membranes that a needle has to break on its way.
void print_membranes(const InstrumentSpec& instrument) {
  const auto* needle = std::get_if<NeedleOptions>(&instrument.what);
  const std::vector<InnerMembrane> all = needle ? membranes_of(*needle) : std::vector<InnerMembrane>{};
  if (all.empty()) return;
  const auto [weak, strong] =
      std::minmax_element(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.puncture < b.puncture; });
  say("           {} membrane{} below the surface, {} of them drawn, from {:.4g} to {:.4g} mm, of {:.4g} to {:.4g} N\n",
      all.size(), all.size() == 1 ? "" : "s", all.size() - needle->membranes.size(), 1e3 * all.front().depth,
      1e3 * all.back().depth, weak->puncture, strong->puncture);
}

/// Where an instrument starts that the body places.
void print_start(const InstrumentSpec& x, const TetMesh& mesh) {
  if (!x.aim) return;
  const Vec3d tip = start_pose(x, mesh).position;
  const auto mm = [](double metres) { return std::round(1e9 * metres) * 1e-6 + 0.0; };  // to a nanometre: no -1e-15
  say("           starts at ({:.4g}, {:.4g}, {:.4g}) mm\n", mm(tip.x), mm(tip.y), mm(tip.z));
}

void print_interactions(const Variant& v, const TetMesh& mesh, const std::vector<Advice>& advice) {
  for (const CapsuleSpec& x : v.capsules) {
    say("  capsule  \"{}\" on {}: {:.4g} mm, E = {:.6g} Pa\n", x.options.name,
        x.set.empty() ? "all of the surface" : set_text(mesh, x.set), 1e3 * x.options.thickness,
        x.options.youngs_modulus);
  }
  if (v.container) {
    say("  vessel   {}, {}\n", kind_word(v.container->options.vessel), word_of(v.container->hold));
  }
  for (std::size_t i = 0; i < v.instruments.size(); ++i) {
    const InstrumentSpec& x = v.instruments[i];
    const std::optional<double> end = make_driver(x)->end();
    say("  tool     \"{}\", {}: {}{}\n", x.name, kind_word(x.what), kind_word(x.motion.how),
        end ? fmt::format(", until {:.4g} s", *end) : "");
    print_start(x, mesh);
    print_membranes(x);
    print_advice(advice, Advice::About::instrument, i);
  }
}

std::string vector_text(const Vec3d& v) { return fmt::format("{:.4g}, {:.4g}, {:.4g}", v.x, v.y, v.z); }

/// What acts, by its keys: `traction_Pa = [0, 0, 100], follows`.
std::string load_text(const SurfaceLoad& load) {
  std::string text;
  const auto say_of = [&](const auto& f) {
    const auto& value = load.*f.member;
    using T = std::remove_cvref_t<decltype(value)>;
    if (value == T{}) return;
    text += (text.empty() ? "" : ", ") + f.key();
    if constexpr (std::is_same_v<T, Vec3d>) text += " = [" + vector_text(value) + "]";
    if constexpr (std::is_same_v<T, double>) text += fmt::format(" = {:.4g}", value);
  };
  each_field<SurfaceLoad>(say_of);
  return text.empty() ? "nothing, all its values are 0" : text;
}

/// What holds a body that no support holds.
std::string what_holds(const Variant& v) {
  const bool sprung = std::any_of(v.loads.begin(), v.loads.end(), [](const LoadSpec& l) {
    return l.load.spring != Vec3d{} || l.load.spring_per_area != Vec3d{};
  });
  if (sprung) return "springs hold the body";
  if (v.container) return "it lies in its container";
  if (v.tools.empty()) return "the body is free to drift";
  return "it is held by the sets of its tools, from the start of their motion on";
}

void print_tool(const ToolSpec& tool, const TetMesh& mesh) {
  const PressMotion& m = tool.motion;
  if (tool.rotation || tool.poses) {
    say("  tool     \"{}\" on {}: {}, from {:.4g} s to {:.4g} s\n", tool.name, set_text(mesh, tool.set),
        tool.rotation ? "turns about (" + vector_text(tool.rotation->axis) + ") through (" +
                            vector_text(tool.rotation->center) + ") m"
                      : std::to_string(tool.poses->motion.times.size()) + " poses",
        tool_start(tool), tool_path(tool).end.value_or(0.0));
  } else if (tool.record) {
    say("  tool     \"{}\" on {}: a recorded path of {} points, from {:.4g} s to {:.4g} s\n", tool.name,
        set_text(mesh, tool.set), tool.record->motion.times.size(), tool_start(tool),
        tool_path(tool).end.value_or(0.0));
  } else {
    say("  tool     \"{}\" on {}: {:.4g} mm at {:.4g} mm/s, from {:.4g} s to {:.4g} s\n", tool.name,
        set_text(mesh, tool.set), 1e3 * m.depth, 1e3 * m.velocity, m.start, press_end(m));
  }
}

void print_body(const Variant& v, const VariantAtRest& rest) {
  const std::vector<Advice> advice = advise_on_body(v, rest);
  const auto advise_on = [&](Advice::About about, std::optional<std::size_t> index = {}) {
    print_advice(advice, about, index);
  };
  print_mesh(rest);
  for (const Advice::About about : {Advice::About::mesh, Advice::About::set, Advice::About::region}) advise_on(about);
  say("  tissue   \"{}\": {}\n", v.tissue.name, tissue_text(v.tissue));
  advise_on(Advice::About::tissue, 0);
  for (std::size_t i = 0; i < v.regions.size(); ++i) {
    say("  region   \"{}\": {}\n", v.regions[i].name, tissue_text(v.regions[i].tissue));
    advise_on(Advice::About::tissue, i + 1);
  }
  for (const FixedSpec& fixed : v.fixed) {
    const std::string moved = fixed.record ? ", moved by " + fixed.record->path.filename().string() : "";
    say("  fixed    {}, in {}{}\n", set_text(rest.mesh, fixed.set), axes_text(fixed.axes), moved);
  }
  if (v.fixed.empty()) say("  fixed    nothing: {}\n", what_holds(v));
  for (const LoadSpec& load : v.loads) {
    say("  load     {}: {}\n", set_text(rest.mesh, load.set), load_text(load.load));
  }
  for (std::size_t i = 0; i < v.tools.size(); ++i) {
    print_tool(v.tools[i], rest.mesh);
    advise_on(Advice::About::tool, i);
  }
  print_interactions(v, rest.mesh, advice);
}

/// What is known of all variants.
struct Whole {
  double total = 0.0, longest = 0.0;  ///< times by the clock [s]
  bool ends = false;                  ///< numbers end a run early
  bool knows_cost = true;
};

void check_variant(const Variant& variant, const MeshLoader& load, CheckClock& clock, Whole& whole) {
  Taste taste(clock);
  clock.begin("the mesh and the stable step of " + variant.name);
  const RunSummary summary = run_variant(variant, load, taste, taste.stop);
  const Cost cost = cost_of(variant, taste, summary);
  clock.begin("what is said of " + variant.name);
  say("\n{}\n", variant.label == variant.name ? variant.name : variant.name + " — " + variant.label);
  print_body(variant, taste.rest);
  print_time(variant, load, taste, cost, summary, clock);
  if (!summary.trouble.empty()) say("  trouble  {}\n", trouble_text(summary));
  if (summary.steps == 0 && summary.trouble.empty()) {
    clock.leave_out("the cost of a step of " + variant.name);
    whole.knows_cost = false;
  }
  whole.ends = whole.ends || !summary.trouble.empty();
  whole.total += cost.wall_s;
  whole.longest = std::max(whole.longest, cost.wall_s);
}

int check_all(const Scene& scene, const CheckOptions& options, CheckClock& clock) {
  MeshCache meshes(false);
  Whole whole;
  std::size_t looked_at = 0;
  for (const Variant& variant : scene.variants) {
    if (looked_at > 0 && !clock.has_time()) {
      clock.leave_out("variant " + variant.name);
    } else {
      check_variant(variant, meshes.loader(), clock, whole);
      ++looked_at;
    }
    clock.done(variant.name);
  }
  print_advice(advise_on_laws(scene.variants), Advice::About::scene);
  const std::string others = clock.left_out();
  const double wall = std::max(whole.longest, whole.total / options.threads);
  const std::string time =
      whole.knows_cost ? fmt::format("about {}{} on {} thread{}", duration_text(wall), others.empty() ? "" : " or more",
                                     options.threads, options.threads == 1 ? "" : "s")
                       : "of unknown cost";
  const bool all = looked_at == scene.variants.size();
  const char* can = whole.ends ? "Its numbers end a run early, see `trouble`"
                    : all      ? "The scene can be run"
                               : "What was looked at can be run";
  say("\n{} variant{}, {}. {}.\n{}{}", scene.variants.size(), scene.variants.size() == 1 ? "" : "s", time, can, others,
      all ? std::string() : CheckClock::not_a_pass());
  if (whole.ends) return kNumericalEnd;
  return all ? kDone : kUnfinished;
}

int check(const CheckOptions& options) {
  const Scene scene = open_scene(options.scene);
  say("{}: {}\n", scene.file.string(), scene.title);
  if (is_heat_scene(scene)) {
    MeshCache meshes(false);
    return check_heat_scene(scene, meshes.loader());
  }
  std::vector<std::string> names;
  for (const Variant& variant : scene.variants) names.push_back(variant.name);
  CheckClock clock(std::move(names));
  return clock.run([&] { return check_all(scene, options, clock); });
}

}  // namespace

void add_check(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("check", "check a scene and its cost, without running it");
  const auto options = std::make_shared<CheckOptions>();
  add_scene_options(*command, options->scene);
  add_threads_option(*command, options->threads);
  command->footer(kCheckFooter);
  command->callback([options, &action] { action = [options] { return check(*options); }; });
}

}  // namespace glisson::app
