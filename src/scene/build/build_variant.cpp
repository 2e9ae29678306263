// build_variant.cpp — from a variant's description to a body with its supports, loads and tools.
#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <set>

#include "base/nearest.h"
#include "glisson/scene/heat_run.h"
#include "glisson/scene/scene.h"
#include "mesh/inspect/vertex_set.h"
#include "mesh/topology/require_valid.h"
#include "scene/build/build_instruments.h"
#include "scene/build/loaded_start.h"
#include "scene/build/select.h"
#include "scene/build/stiffness.h"
#include "scene/build/supports.h"

namespace glisson {
namespace {

[[noreturn]] void fail(const Variant& variant, const std::string& origin, const std::string& what) {
  const std::string name = variant.name == "main" ? "" : ": variant " + variant.name;
  throw SceneError((origin.empty() ? variant.scene_name + name : origin) + ": " + what);
}

TetMesh source_mesh(const Variant& variant, const MeshLoader& load, const std::function<bool(double)>& progress) {
  if (const auto* file = std::get_if<MeshFile>(&variant.mesh)) {
    if (!load) fail(variant, "", "no reader for mesh files was given, and [mesh] needs " + file->path.string());
    return load(*file);
  }
  try {
    if (const auto* box = std::get_if<BoxOptions>(&variant.mesh)) return box_mesh(*box);
    if (const auto* body = std::get_if<ImplicitBody>(&variant.mesh)) return implicit_mesh(*body, progress).mesh;
    if (const auto* liver = std::get_if<LiverOptions>(&variant.mesh)) return liver_mesh(*liver, progress).mesh;
    if (const auto* body = std::get_if<ImageBody>(&variant.mesh)) return image_mesh(*body, progress).mesh;
    return cylinder_mesh(std::get<CylinderOptions>(variant.mesh));
  } catch (const std::invalid_argument& error) {
    fail(variant, "", std::string("mesh: ") + error.what());
  }
}

void require_not_empty(const Variant& variant, const TetMesh& mesh) {
  if (mesh.vertices.empty() || mesh.tets.empty()) {
    fail(variant, "",
         "mesh: " + std::to_string(mesh.vertices.size()) + " vertices and " + std::to_string(mesh.tets.size()) +
             " tets; at least one tetrahedron is needed");
  }
}

/// `4, 7 (vessel)`: the regions of a mesh.
std::string region_list(const TetMesh& mesh) {
  std::set<int> numbers;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) numbers.insert(mesh.region_of(t));
  std::vector<std::string> regions;
  for (const int n : numbers) {
    const auto name = mesh.region_names.find(n);
    const bool named = name != mesh.region_names.end() && !name->second.empty();
    regions.push_back(std::to_string(n) + (named ? " (" + name->second + ")" : ""));
  }
  return scene::listed(regions);
}

bool has_tets(const TetMesh& mesh, int region) {
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (mesh.region_of(t) == region) return true;
  }
  return false;
}

/// Gives the tets of a region a number of their own, after checking that there are any.
void mark_region(const Variant& variant, const RegionSpec& region, TetMesh& mesh) {
  const int own = scene::region_number(mesh, region.name);
  if (std::holds_alternative<std::monostate>(region.where)) {
    if (own < 0) {
      fail(variant, region.origin,
           "the mesh has no region \"" + region.name + "\"; it has: " + region_list(mesh) +
               ". Give `box_m` or `sphere_m` to make one");
    }
    if (!has_tets(mesh, own)) {
      fail(variant, region.origin,
           "no tet of the mesh is in its region \"" + region.name + "\"; there are tets in " + region_list(mesh) +
               ". Of volumes that overlap in the file the first has the tets: leave these out of it there");
    }
    return;
  }
  if (own >= 0) {
    fail(variant, region.origin,
         "the mesh has a region \"" + region.name +
             "\" already; choose another name, or leave out "
             "the box or ball to give that region this tissue");
  }
  const std::vector<std::size_t> tets = scene::tets_within(mesh, region);
  if (tets.empty()) {
    fail(variant, region.origin,
         "no tet has its centroid in the region \"" + region.name + "\"; the mesh spans " + scene::extent_text(mesh));
  }
  if (mesh.regions.empty()) mesh.regions.assign(mesh.tets.size(), 0);
  int number = *std::max_element(mesh.regions.begin(), mesh.regions.end());
  if (!mesh.region_names.empty()) number = std::max(number, mesh.region_names.rbegin()->first);
  if (number == std::numeric_limits<int>::max()) fail(variant, region.origin, "the mesh has no free region number");
  for (const std::size_t t : tets) mesh.regions[t] = number + 1;
  mesh.region_names[number + 1] = region.name;
}

/// A vertex set by name, or what sets there are.
const std::vector<std::uint32_t>& set_called(const Variant& variant, const TetMesh& mesh, const std::string& name,
                                             const std::string& origin) {
  const auto it = mesh.vertex_sets.find(name);
  if (it == mesh.vertex_sets.end()) {
    std::vector<std::string> known;
    for (const auto& [set, vertices] : mesh.vertex_sets) known.push_back(set);
    fail(variant, origin, scene::no_such_set(name, known));
  }
  if (it->second.empty()) fail(variant, origin, "the vertex set \"" + name + "\" of the mesh is empty");
  return it->second;
}

/// Refuses sets that hold and bear nothing.
void require_sets(const Variant& variant, const TetMesh& mesh) {
  const std::vector<char> in_tet = vertices_in_tets(mesh);
  const auto require_set = [&](const std::string& name, const std::string& origin) {
    const std::vector<std::uint32_t>& set = set_called(variant, mesh, name, origin);
    if (std::any_of(set.begin(), set.end(), [&](auto v) { return v >= in_tet.size() || in_tet[v] != 0; })) return;
    fail(variant, origin,
         "none of the " + std::to_string(set.size()) + " vertices of the set \"" + name +
             "\" belongs to a tet, so that nothing holds, moves or loads the body by it; name a set of vertices of the "
             "body, or look for missing tets");
  };
  for (const FixedSpec& x : variant.fixed) require_set(x.set, x.origin);
  for (const LoadSpec& x : variant.loads) require_set(x.set, x.origin);
  for (const ToolSpec& x : variant.tools) require_set(x.set, x.origin);
  for (const CapsuleSpec& x : variant.capsules) {
    if (!x.set.empty()) require_set(x.set, x.origin);
  }
}

/// Runs `make`, saying of what it throws where the scene asked for it.
template <class Make>
auto located(const Variant& variant, const std::string& origin, Make make) {
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    fail(variant, origin, error.what());
  }
}

/// The same of what holds or drives vertices. @param asked  its name, for messages
template <class Make>
auto constrained(const Variant& variant, const std::string& origin, const std::string& asked, Make make) {
  return located(variant, origin, [&] {
    try {
      return make();
    } catch (const Contradiction& found) {
      throw std::invalid_argument(scene::contradiction_text(variant, found, asked));
    }
  });
}

const Variant& with_mechanics(const Variant& variant) {
  if (is_heat_alone(variant)) {
    fail(variant, variant.heat->origin,
         "the scene is one of heat alone, without [heat.ice], which `glisson run` and `glisson check` take, BuiltHeat "
         "and run_heat in C++, and "
         "HeatSimulation in Python; what was asked for needs mechanics");
  }
  return variant;
}

std::vector<std::shared_ptr<Instrument>> make_instruments(const Variant& variant, const TetMesh& mesh) {
  std::vector<std::shared_ptr<Instrument>> made;
  for (const ToolSpec& x : variant.tools) {
    const auto& set = set_called(variant, mesh, x.set, x.origin);
    made.push_back(located(variant, x.origin, [&] { return scene::make_tool(x, set); }));
  }
  for (const InstrumentSpec& x : variant.instruments) {
    made.push_back(located(variant, x.origin, [&] { return scene::make_instrument(x, mesh); }));
  }
  return made;
}

Simulation simulation_of(const Variant& variant, TetMesh mesh,
                         std::span<const std::shared_ptr<Instrument>> instruments) {
  try {
    scene::split_by_stiffness(variant, mesh);
    std::map<int, Tissue> tissues = region_tissues(variant, mesh);
    SimulationOptions options = variant.simulation;
    for (const auto& x : instruments) options.mesh_changes = options.mesh_changes || x->changes_body();
    return Simulation(std::move(mesh), std::move(tissues), options);
  } catch (const std::bad_alloc&) {
    throw;                                 // no fault of the scene
  } catch (const std::exception& error) {  // also an eigenvalue search that fails on an odd body
    fail(variant, "", error.what());
  }
}

/// The mesh with its vertices at other places.
TetMesh at_places(const TetMesh& mesh, const std::vector<Vec3d>& places) {
  TetMesh moved = mesh;
  moved.vertices = places;
  return moved;
}

/// Lets a body start where it is in equilibrium.
void take_loaded(const TetMesh& loaded, const UnloadedShape& shape, Simulation& simulation) {
  std::vector<Vec3d> u(loaded.vertices.size());
  for (std::size_t v = 0; v < u.size(); ++v) u[v] = loaded.vertices[v] - shape.rest[v];
  simulation.set_state(u, std::vector<Vec3d>(u.size()));
}

/// The course of a load in time; none: always 1.
TimeFunction<double> course_of(const LoadSpec& load) {
  if (!load.times.empty()) {
    const auto between = [times = load.times, factors = load.factors](double t) {
      const auto after = std::upper_bound(times.begin(), times.end(), t) - times.begin();
      if (after == 0) return factors.front();
      const auto i = static_cast<std::size_t>(after);
      if (i == times.size()) return factors.back();
      return std::lerp(factors[i - 1], factors[i], (t - times[i - 1]) / (times[i] - times[i - 1]));
    };
    return {between, CornerTimes(load.times)};
  }
  if (load.ramp <= 0.0) return {};
  return {[seconds = load.ramp](double t) { return std::min(1.0, t / seconds); }, CornerTimes({load.ramp})};
}

/// Capsules first: what they pull is known when instruments solve for what holds at the end of the step.
void attach_interactions(const Variant& variant, BuiltVariant& built) {
  Simulation& simulation = built.simulation;
  for (const CapsuleSpec& x : variant.capsules) {
    std::span<const std::uint32_t> set;
    if (!x.set.empty()) set = set_called(variant, simulation.mesh(), x.set, x.origin);
    built.capsules.push_back(located(variant, x.origin, [&] {
      auto capsule = scene::make_capsule(x, set);
      simulation.attach(capsule);
      return capsule;
    }));
  }
  if (variant.container) {
    built.container = located(variant, variant.container->origin, [&] {
      auto container = std::make_shared<Container>(variant.container->options);
      simulation.attach(container);
      return container;
    });
  }
  for (std::size_t i = 0; i < variant.instruments.size(); ++i) {
    const auto& instrument = built.instruments[variant.tools.size() + i];
    located(variant, variant.instruments[i].origin, [&] { simulation.attach(instrument); });
  }
  scene::join(built.instruments, built.capsules);
}

void attach_heat(const Variant& variant, BuiltVariant& built) {
  located(variant, variant.heat->origin, [&] {
    built.heat = std::make_shared<HeatCoupling>(variant, built.simulation.mesh());
    built.simulation.attach(built.heat->ice());
    built.simulation.attach(built.heat);
    if (!built.heat->trouble().empty()) throw std::invalid_argument(built.heat->trouble());
  });
}

/// The tip of an instrument that a probe names.
std::function<ProbeTip()> tip_of(const ProbeSpec& probe, const BuiltVariant& built, std::size_t tools) {
  std::vector<std::string> known;
  for (std::size_t i = tools; i < built.instruments.size(); ++i) {
    const std::shared_ptr<Instrument>& x = built.instruments[i];
    if (x->name() == probe.tip) return [x] { return ProbeTip{x->centre_line().back(), x->direction()}; };
    known.push_back(x->name());
  }
  const std::string meant = scene::nearest(probe.tip, known);
  throw std::invalid_argument(
      "tip = \"" + probe.tip + "\" is no [[instrument]]; " +
      (known.empty() ? "there is none (a [[tool]] moves a set and has no tip)" : "there are: " + scene::listed(known)) +
      (meant.empty() ? "" : "; did you mean \"" + meant + "\"?"));
}

/// Each probe is tried on its own first, so that the message names its place in the scene.
/// @param loaded  the body of a variant that starts loaded, in which the places of probes are; null: they are in that at rest
Probes probes_of(const Variant& variant, const BuiltVariant& built, const TetMesh* loaded) {
  std::vector<ProbeOptions> options;
  for (const ProbeSpec& x : variant.probes) {
    options.push_back(x.options);
    located(variant, x.origin, [&] {
      if (!x.tip.empty()) options.back().tip = tip_of(x, built, variant.tools.size());
      if (loaded) scene::move_to_rest(*loaded, built.simulation.mesh().vertices, options.back());
      return Probes(built.simulation, {options.back()});
    });
  }
  return {built.simulation, std::move(options)};
}

}  // namespace

TetMesh build_mesh(const Variant& variant, const MeshLoader& load, const std::function<bool(double)>& progress) {
  TetMesh mesh = source_mesh(variant, load, progress);
  require_not_empty(variant, mesh);
  located(variant, "", [&] { detail::require_indices(mesh); });
  for (const auto& [name, selection] : variant.sets)
    mesh.vertex_sets[name] = scene::select_vertices(mesh, name, selection);
  for (const RegionSpec& region : variant.regions) mark_region(variant, region, mesh);
  require_sets(variant, mesh);
  return mesh;
}

std::map<int, Tissue> region_tissues(const Variant& variant, const TetMesh& mesh) {
  std::map<int, Tissue> tissues;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) tissues.try_emplace(mesh.region_of(t), variant.tissue);
  for (const RegionSpec& region : variant.regions) {
    const auto it = tissues.find(scene::region_number(mesh, region.name));
    if (it != tissues.end()) it->second = region.tissue;
  }
  scene::set_band_tissues(variant, mesh, tissues);
  return tissues;
}

BuiltVariant::BuiltVariant(const Variant& variant, const MeshLoader& load)
    : BuiltVariant(build_mesh(with_mechanics(variant), load), variant) {}

BuiltVariant::BuiltVariant(TetMesh whole, const Variant& variant)
    : BuiltVariant(whole, unload(variant, whole), variant) {}

/// The shape at rest of a variant that starts loaded; none of another one.
std::optional<UnloadedShape> BuiltVariant::unload(const Variant& variant, const TetMesh& mesh) {
  if (variant.start != Start::loaded) return {};
  const std::string at = variant.start_origin.empty() ? "motion.start: " : "";
  if (const std::string why = scene::refuses_loaded_start(variant); !why.empty())
    fail(variant, variant.start_origin, at + why);
  const Variant still = scene::still_variant(variant);
  Variant part = still;
  const auto body = [&](TetMesh rest, double share) {
    scene::take_share(still, share, part);
    return std::move(BuiltVariant(std::move(rest), {}, part).simulation);
  };
  try {
    return find_unloaded_shape(mesh, body);
  } catch (const NoUnloadedShape& error) {
    fail(variant, variant.start_origin, at + error.what());
  } catch (const std::invalid_argument& error) {
    fail(variant, variant.start_origin, at + error.what());
  }
}

namespace {

/// Without an unloaded shape the mesh itself, which is moved from.
TetMesh mesh_at_rest(TetMesh& whole, const std::optional<UnloadedShape>& shape) {
  return shape ? at_places(whole, shape->rest) : std::move(whole);
}

}  // namespace

BuiltVariant::BuiltVariant(TetMesh whole, const std::optional<UnloadedShape>& shape, const Variant& variant)
    : instruments(make_instruments(variant, whole)),
      simulation(simulation_of(variant, mesh_at_rest(whole, shape), instruments)) {
  const TetMesh& mesh = simulation.mesh();
  if (shape) take_loaded(whole, *shape, simulation);
  for (std::size_t i = 0; i < variant.fixed.size(); ++i) {
    const FixedSpec& x = variant.fixed[i];
    const auto& set = set_called(variant, mesh, x.set, x.origin);
    supports.push_back(constrained(variant, x.origin, scene::support_text(x),
                                   [&] { return scene::add_support(variant, i, set, simulation); }));
  }
  for (std::size_t i = 0; i < variant.tools.size(); ++i) {
    const ToolSpec& x = variant.tools[i];
    constrained(variant, x.origin, "[[tool]] \"" + x.name + "\"", [&] { simulation.attach(instruments[i]); });
  }
  for (const LoadSpec& x : variant.loads) {
    const auto& set = set_called(variant, mesh, x.set, x.origin);
    located(variant, x.origin, [&] { return simulation.add_surface_load(set, x.load, course_of(x)); });
  }
  attach_interactions(variant, *this);
  if (shape) {
    take_loaded(whole, *shape, simulation);  // with the energy of what was attached
    unloaded = shape->figures;
  }
  probes = probes_of(variant, *this, shape ? &whole : nullptr);
  if (variant.heat && variant.heat->ice) attach_heat(variant, *this);
}

PosesMotion started(const PosesSpec& spec) {
  PosesMotion motion = spec.motion;
  motion.start = spec.start;
  return motion;
}

BuiltVariant build_variant(const Variant& variant, const MeshLoader& load) { return {variant, load}; }

ToolPath support_path(const FixedSpec& fixed) {
  if (!fixed.record) return {};
  RecordedMotion motion = fixed.record->motion;
  motion.start = fixed.record->start;
  return recorded_path(motion);
}

double tool_start(const ToolSpec& tool) {
  if (tool.path) return 0.0;
  if (tool.rotation) return tool.rotation->times.empty() ? tool.rotation->start : tool.rotation->times.front();
  if (tool.poses) return tool.poses->start;
  return tool.record ? tool.record->start : tool.motion.start;
}

ToolPath tool_path(const ToolSpec& tool) {
  if (tool.path) return *tool.path;
  if (tool.rotation || tool.poses) return {[](double) { return Vec3d{}; }, turning_path(tool)->end};
  if (!tool.record) return {press(tool.motion), press_end(tool.motion)};
  RecordedMotion motion = tool.record->motion;
  motion.start = tool.record->start;
  return recorded_path(motion);
}

std::optional<RigidPath> turning_path(const ToolSpec& tool) {
  if (!tool.rotation && !tool.poses) return {};
  RigidPath turning = tool.rotation ? rotation_path(*tool.rotation) : poses_path(started(*tool.poses));
  if (!tool.path) return turning;
  const auto both = [turn = turning.pose, way = tool.path->displacement](double t) {
    Pose pose = turn(t);
    pose.position += way(t);
    return pose;
  };
  return RigidPath{{both, turning.pose.corners.with(tool.path->displacement.corners)}, turning.end};
}

double run_duration(const Variant& variant) {
  if (variant.heat) return variant.heat->duration;
  if (variant.duration) return *variant.duration;
  double end = 0.0;
  bool ends = false;
  const auto until = [&](std::optional<double> time) {
    if (time) end = std::max(end, *time);
    ends = ends || time;
  };
  for (const ToolSpec& tool : variant.tools) until(tool_path(tool).end);
  for (const InstrumentSpec& x : variant.instruments) until(make_driver(x)->end());
  for (const FixedSpec& x : variant.fixed) {
    if (variant.tools.empty() && variant.instruments.empty() && x.record) until(support_path(x).end);
  }
  return ends ? end : std::numeric_limits<double>::infinity();
}

}  // namespace glisson
