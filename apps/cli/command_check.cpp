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

#include "cli/check_clock.h"
#include "cli/check_steps.h"
#include "cli/commands.h"
#include "cli/edge_cells.h"
#include "cli/near_bounds.h"
#include "cli/progress.h"
#include "cli/tissue_text.h"
#include "glisson/material/locking.h"
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

constexpr double kCoarseEdge = 0.08, kFineEdge = 0.04;  // cells across a sharp edge, of its size (docs/contact.md)

std::string tissue_text(const Tissue& t) { return fmt::format("{}, ρ = {:.6g} kg/m³", law_text(t), t.density); }

/// @param imported  from a file, whose reader has warned already
void print_mesh(const TetMesh& mesh, double mass_kg, bool imported) {
  const MeshReport report = inspect(mesh);
  const Vec3d size = report.box_max - report.box_min;
  say("  mesh     {} vertices, {} tets, {:.4g} × {:.4g} × {:.4g} mm, {:.4g} ml, {:.4g} g; shape {:.3f} worst, {:.3f} "
      "median\n",
      report.vertices, report.tets, 1e3 * size.x, 1e3 * size.y, 1e3 * size.z, 1e6 * report.volume, 1e3 * mass_kg,
      report.worst_mean_ratio, report.median_mean_ratio);
  if (imported) return;
  for (const std::string& warning : report.warnings) say("           warning: {}\n", warning);
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

/// That cells are too coarse for a sharp edge, and which would do.
void print_edge(const Variant& v, const InstrumentSpec& instrument, const TetMesh& mesh) {
  const std::optional<EdgeCells> cells = cells_under_edge(mesh, instrument);
  if (!cells || cells->share() <= kCoarseEdge) return;
  const double finer = cells->share() / kFineEdge;
  say("  edge     \"{}\": cells of {:.3g} mm across its sharp edge are {:.2g} of its {} of {:.4g} mm, and its force "
      "may be "
      "wrong by\n           about that share; cells of {:.2g} mm there, {:.2g} of it, keep it within 2 %: use a mesh "
      "graded "
      "at the edge,\n           ",
      instrument.name, 1e3 * cells->across, cells->share(),
      kind_word(instrument.what) == Block::kName ? "half width" : "radius", 1e3 * cells->size,
      1e3 * kFineEdge * cells->size, kFineEdge);
  if (const auto* cylinder = std::get_if<CylinderOptions>(&v.mesh)) {
    const double radial = std::ceil(finer * cylinder->radial_cells), axial = std::ceil(finer * cylinder->axial_cells);
    say("radial_cells = {:.0f} and axial_cells = {:.0f} here ({:.2g} million tets), ", radial, axial,
        18e-6 * radial * radial * axial);
  }
  say("or round the edge by a cell: edge_radius_mm = {:.2g}\n", 1e3 * cells->across);
}

/// The keys that make a generated mesh so many times as fine.
std::string finer_mesh(const MeshSource& mesh, double factor) {
  const auto times = [&](int cells) { return std::ceil(factor * cells - 1e-9); };
  if (const auto* box = std::get_if<BoxOptions>(&mesh)) {
    return fmt::format("mesh.cells = [{}, {}, {}]", times(box->cells[0]), times(box->cells[1]), times(box->cells[2]));
  }
  if (const auto* cylinder = std::get_if<CylinderOptions>(&mesh)) {
    return fmt::format("mesh.radial_cells = {} and mesh.axial_cells = {}", times(cylinder->radial_cells),
                       times(cylinder->axial_cells));
  }
  if (const auto* body = std::get_if<ImplicitBody>(&mesh)) {
    return fmt::format("mesh.edge_mm = {:.2g}, or that edge there alone by [[mesh.size]]", 1e3 * body->edge / factor);
  }
  if (const auto* liver = std::get_if<LiverOptions>(&mesh)) {
    return fmt::format("mesh.edge_mm = {:.2g}, or that edge there alone by [[mesh.size]]", 1e3 * liver->edge / factor);
  }
  return fmt::format("a mesh {:.2g} times as fine there", factor);
}

/// That a pad or instrument acts on few or large faces, and which mesh would do.
void print_faces(const Variant& v, const std::string& name, const PressedFaces& faces) {
  if (!faces.coarse()) return;
  const std::string few = faces.count < PressedFaces::kFew ? fmt::format("{} ", faces.count) : "";
  const std::string large = faces.count > 0 ? fmt::format(" with edges of {:.3g} mm, {:.2g} of its {:.3g} mm",
                                                          1e3 * faces.edge, faces.edge / faces.size, 1e3 * faces.size)
                                            : "";
  say("  coarse   \"{}\" acts on {}faces{}: its force may be far off; {} or more with edges\n           of a third of "
      "that or less take {}\n",
      name, few, large, PressedFaces::kFew, finer_mesh(v.mesh, faces.finer()));
}

/// That the mesh does not resolve a needle's zone, and what would do.
void print_zone(const Variant& v, const InstrumentSpec& instrument, const TetMesh& mesh) {
  const std::optional<ZoneEdges> edges = edges_in_zone(mesh, instrument);
  if (!edges || edges->share() <= ZoneEdges::kResolved) return;
  say("  zone     \"{}\": edges of {:.3g} mm around it are {:.2g} of its zone of {:.3g} mm: its force and depth belong "
      "to "
      "this mesh;\n           half a zone resolves it: zone_mm = {:.2g}, or {}\n",
      instrument.name, 1e3 * edges->edge, edges->share(), 1e3 * edges->zone, 2e3 * edges->edge,
      finer_mesh(v.mesh, 2.0 * edges->share()));
}

/// That linear tets lock in a tissue, and the key that mends it.
void print_locking(const std::string& table, const Tissue& t) {
  const std::optional<double> nu = locking_ratio(t);
  if (!nu) return;
  say("  locking  ν = {:.3g} with volume_change = \"element\": tets that keep their own volumes are too stiff;\n"
      "           {}.volume_change = \"average_nodal\" mends it\n",
      *nu, table);
}

/// Whether a tissue's forces are a secant law's, whose closed cycles give or take work of their own.
bool has_cycle_work(const Tissue& t) {
  return !t.hyperelastic && !t.has_constant_moduli() && t.law_form == LawForm::secant;
}

/// Says once of a scene which tissues have such a law, and the way out.
void print_cycle_work(const Scene& scene) {
  std::vector<std::string> names;
  const auto look = [&](const Tissue& tissue) {
    const std::string name = "\"" + tissue.name + "\"";
    if (has_cycle_work(tissue) && std::ranges::find(names, name) == names.end()) names.push_back(name);
  };
  for (const Variant& v : scene.variants) {
    look(v.tissue);
    for (const RegionSpec& region : v.regions) look(region.tissue);
  }
  if (names.empty()) return;
  say("\nThe stiffness law of {} is in secant form, the paper's, and stores no energy: over a closed cycle of "
      "deformation it can give\n"
      "work that nothing paid, and a body that nothing damps may gain energy. law_form = \"energy\" gives the force of "
      "an energy\n"
      "(docs/laws.md). A run says where that happens.\n",
      fmt::join(names, ", "));
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

/// That an instrument's path passes the body by.
void print_meeting(const Variant& v, const InstrumentSpec& x, const TetMesh& mesh) {
  const std::optional<PathMeeting> meeting = meets_body(x, mesh, run_duration(v));
  if (!meeting || meeting->meets) return;
  say("  misses   \"{}\" never meets the body at rest: its tip passes {:.3g} mm from it; move `tip_m`, turn "
      "`direction`, move\n           deeper, or give `aim` in place of `tip_m`, which finds the body\n",
      x.name, 1e3 * meeting->beside);
}

void print_interactions(const Variant& v, const Taste& taste) {
  for (const CapsuleSpec& x : v.capsules) {
    say("  capsule  \"{}\" on {}: {:.4g} mm, E = {:.6g} Pa\n", x.options.name,
        x.set.empty() ? "all of the surface" : set_text(taste.mesh, x.set), 1e3 * x.options.thickness,
        x.options.youngs_modulus);
  }
  if (v.container) {
    say("  vessel   {}, {}\n", kind_word(v.container->options.vessel), word_of(v.container->hold));
  }
  for (const InstrumentSpec& x : v.instruments) {
    const std::optional<double> end = make_driver(x)->end();
    say("  tool     \"{}\", {}: {}{}\n", x.name, kind_word(x.what), kind_word(x.motion.how),
        end ? fmt::format(", until {:.4g} s", *end) : "");
    print_start(x, taste.mesh);
    print_meeting(v, x, taste.mesh);
    print_membranes(x);
    print_edge(v, x, taste.mesh);
    print_zone(v, x, taste.mesh);
    if (const std::optional<PressedFaces> faces = faces_under(taste.mesh, x)) print_faces(v, x.name, *faces);
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

void print_body(const Variant& v, const Taste& taste) {
  print_mesh(taste.mesh, taste.mass_kg, std::holds_alternative<MeshFile>(v.mesh));
  print_near_bounds(v, taste.mesh);
  say("  tissue   \"{}\": {}\n", v.tissue.name, tissue_text(v.tissue));
  print_locking("tissue", v.tissue);
  for (const RegionSpec& region : v.regions) {
    say("  region   \"{}\": {}\n", region.name, tissue_text(region.tissue));
    if (!(region.tissue.volume_change == v.tissue.volume_change)) print_locking("its tissue", region.tissue);
  }
  for (const FixedSpec& fixed : v.fixed) {
    const std::string moved = fixed.record ? ", moved by " + fixed.record->path.filename().string() : "";
    say("  fixed    {}, in {}{}\n", set_text(taste.mesh, fixed.set), axes_text(fixed.axes), moved);
  }
  if (v.fixed.empty()) say("  fixed    nothing: {}\n", what_holds(v));
  for (const LoadSpec& load : v.loads) {
    say("  load     {}: {}\n", set_text(taste.mesh, load.set), load_text(load.load));
  }
  for (const ToolSpec& tool : v.tools) {
    const PressMotion& m = tool.motion;
    if (tool.rotation || tool.poses) {
      say("  tool     \"{}\" on {}: {}, from {:.4g} s to {:.4g} s\n", tool.name, set_text(taste.mesh, tool.set),
          tool.rotation ? "turns about (" + vector_text(tool.rotation->axis) + ") through (" +
                              vector_text(tool.rotation->center) + ") m"
                        : std::to_string(tool.poses->motion.times.size()) + " poses",
          tool_start(tool), tool_path(tool).end.value_or(0.0));
    } else if (tool.record) {
      say("  tool     \"{}\" on {}: a recorded path of {} points, from {:.4g} s to {:.4g} s\n", tool.name,
          set_text(taste.mesh, tool.set), tool.record->motion.times.size(), tool_start(tool),
          tool_path(tool).end.value_or(0.0));
    } else {
      say("  tool     \"{}\" on {}: {:.4g} mm at {:.4g} mm/s, from {:.4g} s to {:.4g} s\n", tool.name,
          set_text(taste.mesh, tool.set), 1e3 * m.depth, 1e3 * m.velocity, m.start, press_end(m));
    }
    print_faces(v, tool.name, faces_of_pad(taste.mesh, tool.set));
  }
  print_interactions(v, taste);
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
  print_body(variant, taste);
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
  print_cycle_work(scene);
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
