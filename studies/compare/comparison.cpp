// comparison.cpp — see comparison.h.
#include "compare/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "compare/models/engine.h"
#include "compare/viscous_reference.h"
#include "glisson/mesh_refinement.h"
#include "glisson/scene/convergence_order.h"
#include "glisson/scene/convergence_variant.h"

namespace glisson::app {
namespace {

using models::Answer;
using models::Problem;
using models::Rival;

constexpr double kMostTets = 4e6;  // of the reference: some 8 GB

models::Tool tool_of(const ToolSpec& spec, const TetMesh& mesh) {
  models::Tool tool{.vertices = mesh.vertex_set(spec.set), .axes = {}, .motion = Motion{}, .start = tool_start(spec)};
  const Vec3d& d = spec.motion.direction;
  if (spec.sideways_free) tool.axes = {d.x != 0.0, d.y != 0.0, d.z != 0.0};
  if (auto turning = turning_path(spec)) {
    const Vec3d axis = spec.rotation ? spec.rotation->axis : Vec3d{};
    if (spec.axial_free) tool.axes = {axis.x == 0.0, axis.y == 0.0, axis.z == 0.0};
    tool.motion = std::move(turning->pose);
  } else {
    tool.motion = tool_path(spec).displacement;
  }
  return tool;
}

void require_comparable(const Variant& v) {
  std::vector<std::string> odd;
  if (!v.instruments.empty()) odd.emplace_back("[[instrument]]");
  if (!v.capsules.empty()) odd.emplace_back("[[capsule]]");
  if (v.container) odd.emplace_back("[container]");
  if (v.start == Start::loaded) odd.emplace_back("motion.start = \"loaded\"");
  if (!v.loads.empty()) odd.emplace_back("[[load]]");
  const auto moves = [](const FixedSpec& f) { return f.record.has_value(); };
  if (std::any_of(v.fixed.begin(), v.fixed.end(), moves)) odd.emplace_back("a [[fixed]] set that moves");
  if (!odd.empty()) {
    throw SceneError(
        fmt::format("{}: variant {} has {}; other models are given a mesh, a tissue, [[fixed]], [[tool]] and gravity "
                    "alone. Take these out, for example with a variant of the scene that has only a [[tool]]",
                    v.scene_name, v.name, fmt::join(odd, ", ")));
  }
  if (!std::isfinite(run_duration(v)))
    throw SceneError(fmt::format("{}: variant {} has no end; give motion.duration_s", v.scene_name, v.name));
  if (v.fixed.empty() && v.tools.empty())
    throw SceneError(fmt::format("{}: variant {} has no [[fixed]] and no [[tool]]; there is no force to compare",
                                 v.scene_name, v.name));
}

/// @param tets  of the scene's mesh @param count  of meshes, each with eight times the tets of the one before
void require_size(const Variant& variant, std::size_t tets, int count) {
  const double finest = static_cast<double>(tets) * std::pow(8.0, count - 1);
  if (finest <= kMostTets) return;
  throw SceneError(
      fmt::format("{}: compare: the reference would have {:.3g} tets; at most {:.3g}. Take a smaller compare.meshes or "
                  "compare.finer, or a coarser mesh",
                  variant.scene_name, finest, kMostTets));
}

/// The scene's mesh and others, each with the tets of the one before split in eight: vertices keep their numbers.
std::vector<TetMesh> meshes_of(const Variant& variant, const MeshLoader& load, int count) {
  std::vector<TetMesh> meshes{build_mesh(variant, load)};
  require_size(variant, meshes.front().tets.size(), count);
  while (meshes.size() < static_cast<std::size_t>(count)) {
    const RefinedVariant finer = on_split_mesh(variant, refined(meshes.back()));
    meshes.push_back(build_mesh(finer.variant, finer.load));
  }
  return meshes;
}

}  // namespace

std::vector<const Rival*> chosen_models(const Scene& scene) {
  std::vector<const Rival*> list;
  for (const Rival& rival : models::rivals()) {
    const auto& wanted = scene.compare.models;
    if (wanted.empty() || std::find(wanted.begin(), wanted.end(), rival.name) != wanted.end()) list.push_back(&rival);
  }
  for (const std::string& name : scene.compare.models) {
    const auto has_name = [&](const Rival& rival) { return rival.name == name; };
    if (std::any_of(models::rivals().begin(), models::rivals().end(), has_name)) continue;
    std::vector<std::string_view> names;
    for (const Rival& rival : models::rivals()) names.push_back(rival.name);
    throw SceneError(fmt::format("{}: compare.models: there is no model \"{}\"; there are {}", scene.file.string(),
                                 name, fmt::join(names, ", ")));
  }
  return list;
}

namespace {

/// Takes the tets of the region compare.cut out of the body when it says.
void plan_cut(Problem& problem, const Scene& scene) {
  const CompareSpec& spec = scene.compare;
  if (spec.cut.empty()) return;
  models::Cut cut{.time = spec.cut_at, .tets = {}};
  for (std::uint32_t t = 0; t < problem.mesh.tets.size(); ++t) {
    const auto name = problem.mesh.region_names.find(problem.mesh.region_of(t));
    if (name != problem.mesh.region_names.end() && name->second == spec.cut) cut.tets.push_back(t);
  }
  if (cut.tets.empty() || cut.tets.size() == problem.mesh.tets.size()) {
    throw SceneError(
        fmt::format("{}: compare.cut: region \"{}\" has {} of the {} tets; name a [[region]] that has some",
                    scene.file.string(), spec.cut, cut.tets.size(), problem.mesh.tets.size()));
  }
  if (spec.cut_at >= problem.duration) {
    throw SceneError(fmt::format("{}: compare.cut_at_s: {} s is not before the end of the run, {} s",
                                 scene.file.string(), spec.cut_at, problem.duration));
  }
  problem.cut = std::move(cut);
}

/// Vertices of the surface with a component that is free and a tet that stays.
std::vector<std::uint32_t> free_surface(const Problem& problem) {
  std::set<std::uint32_t> vertices, kept;
  for (const Triangle& t : boundary_triangles(problem.mesh)) vertices.insert(t.begin(), t.end());
  std::vector<bool> gone(problem.mesh.tets.size(), false);
  if (problem.cut) {
    for (const std::uint32_t t : problem.cut->tets) gone[t] = true;
  }
  for (std::size_t t = 0; t < gone.size(); ++t) {
    if (!gone[t]) kept.insert(problem.mesh.tets[t].begin(), problem.mesh.tets[t].end());
  }
  std::erase_if(vertices, [&](std::uint32_t v) { return !kept.contains(v); });
  const auto leave_out = [&](const std::vector<std::uint32_t>& held, const Axes& axes) {
    if (!axes.x || !axes.y || !axes.z) return;
    for (const std::uint32_t v : held) vertices.erase(v);
  };
  for (const models::Support& s : problem.supports) leave_out(s.vertices, s.axes);
  for (const models::Tool& t : problem.tools) leave_out(t.vertices, t.axes);
  return {vertices.begin(), vertices.end()};
}

double largest(std::span<const Vec3d> vectors) {
  double most = 0.0;
  for (const Vec3d& v : vectors) most = std::max(most, norm(v));
  return most;
}

double error_of_sizes(std::span<const Vec3d> forces, std::span<const double> measured) {
  double sum = 0.0;
  for (std::size_t i = 0; i < measured.size(); ++i) sum += std::pow(norm(forces[i]) - measured[i], 2);
  return std::sqrt(sum / static_cast<double>(measured.size())) / *std::max_element(measured.begin(), measured.end());
}

void require_measured(const Scene& scene, const Problem& problem) {
  const std::vector<double>& measured = scene.compare.measured;
  if (measured.empty()) return;
  if (problem.moment_about) {
    throw SceneError(scene.file.string() +
                     ": compare.measured_N: the first tool turns, so that moments are compared; leave it out");
  }
  if (measured.size() != problem.stations.size() || *std::max_element(measured.begin(), measured.end()) <= 0.0) {
    throw SceneError(
        fmt::format("{}: compare.measured_N: {} forces; give one for each of the {} stations, the largest above 0",
                    scene.file.string(), measured.size(), problem.stations.size()));
  }
}

void find_errors(ComparedRow& row, const Reference& reference, std::span<const double> measured,
                 std::span<const std::uint32_t> surface) {
  const Answer& a = row.answer;
  if (!a.trouble.empty()) return;
  if (!measured.empty() && a.forces.size() == measured.size()) row.error_measured = error_of_sizes(a.forces, measured);
  if (a.forces.size() == reference.forces.size()) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.forces.size(); ++i) {
      const Vec3d d = a.forces[i] - reference.forces[i];
      sum += dot(d, d);
    }
    const double scale = largest(reference.forces);
    if (scale > 0.0) row.error_force = std::sqrt(sum / static_cast<double>(a.forces.size())) / scale;
  }
  double sum = 0.0, scale = 0.0;
  for (const std::uint32_t v : surface) {
    const Vec3d d = a.displacement[v] - reference.displacement[v];
    sum += dot(d, d);
    scale = std::max(scale, norm(reference.displacement[v]));
  }
  if (scale > 0.0 && !surface.empty()) row.error_surface = std::sqrt(sum / static_cast<double>(surface.size())) / scale;
}

/// The highest order of convergence that the edges of the body allow, also those that a cut makes.
double order_of(const Variant& variant, const Problem& problem) {
  if (!problem.cut) return largest_order(variant, problem.mesh);
  TetMesh left = problem.mesh;
  const std::set<std::uint32_t> gone(problem.cut->tets.begin(), problem.cut->tets.end());
  left.tets.clear(), left.regions.clear(), left.fibres.clear();
  for (std::uint32_t t = 0; t < problem.mesh.tets.size(); ++t) {
    if (!gone.contains(t)) left.tets.push_back(problem.mesh.tets[t]);
  }
  return largest_order(variant, left);
}

/// The scene's own tissue on all meshes: the finest is the reference, the others say how far it is from the limit of fine meshes.
/// @param order  the highest that the body's edges allow (convergence_order.h)
Reference make_reference(const std::vector<Problem>& problems, double order, const std::atomic<bool>& stop,
                         const std::function<void(const std::string&)>& say) {
  if (models::is_viscous(problems.front())) return make_viscous_reference(problems, order, stop, say);
  std::vector<MeshResult> results;
  Reference reference;
  std::vector<std::vector<Vec3d>> shapes;  // of the mesh before; those of the next are near
  for (std::size_t k = 0; k < problems.size(); ++k) {
    const Problem& problem = problems[k];
    say(fmt::format("reference, {} tets", problem.mesh.tets.size()));
    for (std::vector<Vec3d>& shape : shapes) shape = refined(problems[k - 1].mesh, shape);
    auto [answer, found] = models::equilibria(problem, shapes, stop);
    if (stop) return reference;
    shapes = std::move(found);
    if (!answer.trouble.empty()) throw SceneError("the reference finds no equilibrium: " + answer.trouble);
    results.push_back({cell_size(problem.mesh), norm(answer.forces.back())});
    reference.tets = problem.mesh.tets.size();
    reference.forces = std::move(answer.forces);
    reference.displacement = std::move(answer.displacement);
  }
  const double change = reference.take_limit(grid_convergence(results, order), results.back().value);
  for (Vec3d& f : reference.forces) f *= 1.0 + change;
  return reference;
}

std::vector<double> stations_of(const Variant& variant, const CompareSpec& spec) {
  const double end = run_duration(variant);
  std::vector<double> stations;
  for (int i = 1; spec.times.empty() && i <= spec.stations; ++i) stations.push_back(end * i / spec.stations);
  for (const double time : spec.times) {
    if (!stations.empty() && time <= stations.back()) {
      throw SceneError(fmt::format("{}: compare.times_s: {} s comes after {} s; give the times in ascending order",
                                   variant.scene_name, time, stations.back()));
    }
    if (time > end * (1.0 + 1e-9)) {
      throw SceneError(fmt::format(
          "{}: compare.times_s: {} s is beyond the end of variant {} at {} s; leave it out, or give motion.duration_s",
          variant.scene_name, time, variant.name, end));
    }
    stations.push_back(std::min(time, end));
  }
  if (stations.back() < end) stations.push_back(end);
  return stations;
}

/// How long the experiment of the middle variant lasts [s].
double middle_duration(const Scene& scene) {
  std::vector<double> durations;
  for (const Variant& variant : scene.variants) durations.push_back(run_duration(variant));
  std::sort(durations.begin(), durations.end());
  return durations[durations.size() / 2];
}

}  // namespace

double Reference::take_limit(const GridConvergence& found, double finest) {
  words = verdict_text(found);
  extrapolated = low = high = 0.0;
  if (!found.extrapolates() || finest <= 0.0) return 0.0;
  extrapolated = found.extrapolated / finest - 1.0;
  low = found.low / found.extrapolated - 1.0, high = found.high / found.extrapolated - 1.0;
  return extrapolated;
}

const ComparedRow* Comparison::quickest(std::string_view model) const {
  const auto within = [&](const ComparedRow& row) {
    return row.error_force >= 0.0 && row.error_force <= target && row.error_surface <= target;
  };
  const ComparedRow* best = nullptr;
  for (const ComparedRow& row : rows) {
    if (row.model != model || (best != nullptr && best->wall_s() <= row.wall_s())) continue;
    const bool stays = std::all_of(rows.begin(), rows.end(), [&](const ComparedRow& more) {
      const bool spends_more = more.model == model && more.tets >= row.tets && more.effort.steps >= row.effort.steps &&
                               more.effort.iterations >= row.effort.iterations;
      return !spends_more || within(more);
    });
    if (stays) best = &row;
  }
  return best;
}

models::Problem problem_of(const Variant& variant, TetMesh mesh, const CompareSpec& spec) {
  require_comparable(variant);
  Problem problem;
  problem.tissues = region_tissues(variant, mesh);
  problem.motion = variant.simulation;
  for (const FixedSpec& f : variant.fixed) problem.supports.push_back({mesh.vertex_set(f.set), f.axes});
  for (const ToolSpec& t : variant.tools) problem.tools.push_back(tool_of(t, mesh));
  problem.duration = run_duration(variant);
  problem.stations = stations_of(variant, spec);
  if (!variant.tools.empty() && variant.tools.front().rotation) {
    problem.moment_about = variant.tools.front().rotation->center;
  }
  problem.mesh = std::move(mesh);
  return problem;
}

namespace {

Problem problem_on(TetMesh mesh, const Scene& scene, const Variant& variant, double test_time) {
  Problem problem = problem_of(variant, std::move(mesh), scene.compare);
  problem.test_time = test_time;
  plan_cut(problem, scene);
  return problem;
}

Comparison compare_variant(const Scene& scene, const Variant& variant, double test_time, const MeshLoader& load,
                           const std::atomic<bool>& stop, const std::function<void(const std::string&)>& say) {
  const std::vector<const Rival*> list = chosen_models(scene);
  const auto meshes = static_cast<std::size_t>(scene.compare.meshes);
  std::vector<Problem> problems;
  for (TetMesh& mesh : meshes_of(variant, load, scene.compare.meshes + scene.compare.finer)) {
    problems.push_back(problem_on(std::move(mesh), scene, variant, test_time));
  }
  require_measured(scene, problems.front());
  Comparison result;
  result.measured = scene.compare.measured;
  result.title = scene.title.empty() ? scene.file.stem().string() : scene.title;
  result.description = scene.description;
  if (scene.variants.size() > 1) result.variant = variant.label.empty() ? variant.name : variant.label;
  result.moments = problems.front().moment_about.has_value();
  result.target = scene.compare.target;
  result.stations = problems.front().stations;
  result.reference = make_reference(problems, order_of(variant, problems.front()), stop, say);
  result.surface = free_surface(problems.front());
  for (const Rival* rival : list) {
    for (std::size_t k = 0; k < meshes; ++k) {
      for (const models::Effort& effort : rival->efforts) {
        if (stop) return result;
        const std::size_t tets = problems[k].mesh.tets.size();
        say(fmt::format("{}, {} tets", rival->name, tets));
        ComparedRow row{.model = std::string(rival->name), .effort = effort, .tets = tets, .answer = {}};
        row.answer = rival->run(problems[k], effort, stop);
        if (stop) return result;
        find_errors(row, result.reference, result.measured, result.surface);
        result.rows.push_back(std::move(row));
      }
    }
  }
  problems.resize(meshes);
  result.problems = std::move(problems);
  return result;
}

/// The reference of viscous tissue looks at explicit steps on the coarsest mesh, whatever it then takes.
std::optional<ExpectedTime> time_of_reference(const Problem& coarsest, const std::atomic<bool>& stop) {
  if (!models::is_viscous(coarsest)) return std::nullopt;
  const auto own = std::ranges::find(models::rivals(), "glisson", &Rival::name);
  ExpectedTime expected = expected_time(*own, coarsest, 1, stop);
  expected.model = "reference";
  return expected;
}

void add(std::vector<ExpectedTime>& all, const ExpectedTime& one) {
  if (one.steps <= 0.0) return;
  const auto found = std::ranges::find(all, one.model, &ExpectedTime::model);
  if (found == all.end()) return all.push_back(one);
  found->steps += one.steps;
  found->wall_s += one.wall_s;
}

}  // namespace

std::vector<ExpectedTime> expected_times(const Scene& scene, const MeshLoader& load, const std::atomic<bool>& stop) {
  for (const Variant& variant : scene.variants) require_comparable(variant);
  const std::vector<const Rival*> list = chosen_models(scene);
  std::vector<ExpectedTime> all;
  for (const Variant& variant : scene.variants) {
    const Problem coarsest = problem_on(build_mesh(variant, load), scene, variant, middle_duration(scene));
    require_size(variant, coarsest.mesh.tets.size(), scene.compare.meshes + scene.compare.finer);
    require_measured(scene, coarsest);
    for (const Rival* rival : list) {
      if (stop) return all;
      add(all, expected_time(*rival, coarsest, scene.compare.meshes, stop));
    }
    if (const auto reference = time_of_reference(coarsest, stop)) add(all, *reference);
  }
  return all;
}

std::vector<Comparison> compare(const Scene& scene, const MeshLoader& load, const std::atomic<bool>& stop,
                                const std::function<void(const std::string&)>& say) {
  for (const Variant& variant : scene.variants) require_comparable(variant);
  const double test_time = middle_duration(scene);
  std::vector<Comparison> results;
  for (const Variant& variant : scene.variants) {
    if (stop) break;
    if (scene.variants.size() > 1) say(fmt::format("variant {}", variant.name));
    results.push_back(compare_variant(scene, variant, test_time, load, stop, say));
  }
  return results;
}

}  // namespace glisson::app
