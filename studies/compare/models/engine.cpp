// engine.cpp — the models that the engine has: the same body, supports and tools, other tissues and integrators.
#include "compare/models/engine.h"

#include <algorithm>
#include <cmath>
#include <exception>

#include "compare/models/boundary.h"
#include "compare/models/stopwatch.h"
#include "glisson/material/hyperelastic_law.h"

namespace glisson::models {
namespace {

std::vector<ConstraintId> hold_and_move(Simulation& simulation, const Problem& problem) {
  std::vector<ConstraintId> read;
  for (const Tool& tool : problem.tools) {
    read.push_back(std::visit(
        [&](const auto& motion) {
          if constexpr (std::is_same_v<std::decay_t<decltype(motion)>, Motion>) {
            return simulation.drive(tool.vertices, motion, tool.axes, tool.start);
          } else {
            return simulation.drive_rigidly(tool.vertices, motion, tool.axes, tool.start);
          }
        },
        tool.motion));
  }
  for (const Support& support : problem.supports) read.push_back(simulation.fix(support.vertices, support.axes));
  return read;
}

/// Moves what is free to a shape; what is held or moved stays where it is.
void approach(Simulation& simulation, const Boundary& boundary, const std::vector<Vec3d>& shape) {
  std::vector<Vec3d> u(simulation.displacement().begin(), simulation.displacement().end());
  for (std::size_t v = 0; v < u.size(); ++v) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      u[v][axis] = boundary.prescribes(v, axis) ? u[v][axis] : shape[v][axis];
  }
  simulation.set_state(u, std::vector<Vec3d>(u.size()));
}

/// Shapes that equilibria are near, where they are known, and those found.
struct Shapes {
  std::span<const std::vector<Vec3d>> near;
  std::vector<std::vector<Vec3d>> found;
};

Answer run(const Problem& problem, const std::map<int, Tissue>& tissues, SimulationOptions options, Shapes* shapes,
           const Stop& stop) {
  Answer answer;
  Stopwatch watch;
  options.gravity = problem.motion.gravity;
  options.gravity_ramp = problem.motion.gravity_ramp;
  options.damping_rate = problem.motion.damping_rate;
  options.threads = 1;
  options.track_energies = false;
  options.exact_steps = false;
  const bool at_rest = options.integrator == Integrator::quasi_static;
  if (at_rest) options.step = common_step(problem.stations);
  Simulation simulation(problem.mesh, tissues, options);
  const std::vector<ConstraintId> read = hold_and_move(simulation, problem);
  answer.setup_s = watch.lap();
  bool whole = problem.cut.has_value();
  const auto advance = [&] {
    const double next =
        simulation.time() + (at_rest ? simulation.step_size() : 0.0);  // an equilibrium is that at a step's end
    if (whole && next > problem.cut->time - 1e-9 * problem.duration) {
      whole = false;
      Stopwatch knife;
      simulation.remove_tets(problem.cut->tets);
      answer.cut_s = knife.lap();
    }
    const StepResult result = simulation.step();
    ++answer.steps;
    if (!result.made()) answer.trouble = std::string(result.message);
    return result.made();
  };
  const auto force = [&] {
    return problem.moment_about ? simulation.torque(read.front(), *problem.moment_about)
                                : simulation.force(read.front()).total();
  };
  // Explicit forces are those of a step's start. That at a station is known after one step more; at the end, where tools may stop at once,
  // it is continued from the two before.
  const bool at_start = !capabilities(options.integrator).forces_at_step_end;
  const Boundary boundary(problem);
  for (std::size_t station = 0; station < problem.stations.size(); ++station) {
    const double time = problem.stations[station];
    const bool ends = time == problem.stations.back();
    Vec3d before{};
    double before_time = 0.0;
    while (!stop && simulation.time() < time - 0.5 * simulation.step_size()) {
      if (ends && at_start && answer.steps > 0 && simulation.time() > time - 2.5 * simulation.step_size()) {
        before = force();
        before_time = simulation.force_time();
      }
      if (shapes != nullptr && !shapes->near.empty() && simulation.time() > time - 1.5 * simulation.step_size())
        approach(simulation, boundary, shapes->near[station]);
      if (!advance()) return answer;
    }
    if (stop) break;
    answer.displacement.assign(simulation.displacement().begin(), simulation.displacement().end());
    if (shapes != nullptr) shapes->found.push_back(answer.displacement);
    if (!ends && at_start && !advance()) return answer;
    Vec3d now = force();
    const double since = simulation.force_time() - before_time;
    if (ends && at_start && before_time > 0.0 && since > 0.0)
      now += (now - before) * ((time - simulation.force_time()) / since);
    answer.forces.push_back(now);
  }
  answer.run_s = watch.lap();
  answer.share_done = std::min(1.0, simulation.time() / problem.duration);
  answer.bytes =
      static_cast<std::size_t>(simulation.engine_info().bytes_per_tet * static_cast<double>(problem.mesh.tets.size()));
  return answer;
}

/// Linear elasticity of the moduli at rest that a test of the experiment's time finds.
void linearise(const Problem& problem, Tissue& tissue) { tissue = linear_tissue(tissue, test_moduli(problem, tissue)); }

bool has_law(const Problem& problem) {
  return std::any_of(problem.tissues.begin(), problem.tissues.end(),
                     [](const auto& t) { return !t.second.has_constant_moduli(); });
}

/// What the engine refuses is the answer's trouble.
Answer try_run(const Problem& problem, const std::map<int, Tissue>& tissues, const SimulationOptions& options,
               Shapes* shapes, const Stop& stop) {
  try {
    return run(problem, tissues, options, shapes, stop);
  } catch (const std::exception& error) {
    Answer answer;
    answer.trouble = error.what();
    return answer;
  }
}

}  // namespace

Answer run_engine(const Problem& problem, const std::map<int, Tissue>& tissues, const SimulationOptions& options,
                  const Stop& stop) {
  return try_run(problem, tissues, options, nullptr, stop);
}

Equilibria equilibria(const Problem& problem, std::span<const std::vector<Vec3d>> near, const Stop& stop) {
  Shapes shapes{near, {}};
  Answer answer = try_run(problem, problem.tissues, {.integrator = Integrator::quasi_static}, &shapes, stop);
  return {std::move(answer), std::move(shapes.found)};
}

Tissue linear_tissue(const Tissue& other, const LameParameters& lame) {
  Tissue linear{.name = other.name, .density = other.density, .volume_change = other.volume_change};
  linear.youngs_modulus = youngs_modulus(lame);
  linear.poisson_ratio = lame.lambda / (2.0 * (lame.lambda + lame.mu));
  return linear;
}

double common_step(std::span<const double> stations) {
  constexpr int kMostParts = 64;
  constexpr double kRounding = 1e-6;  // of a step
  for (int parts = 1; parts < kMostParts; ++parts) {
    const double step = stations.front() / parts;
    if (std::all_of(stations.begin(), stations.end(),
                    [&](double time) { return std::abs(time / step - std::round(time / step)) < kRounding; }))
      return step;
  }
  return stations.front() / kMostParts;
}

Answer without_viscosity(std::string_view what_it_is) {
  Answer answer;
  answer.trouble = "the scene's tissue has no viscosity; without it this is " + std::string(what_it_is);
  return answer;
}

Answer linear_tensor_mass(const Problem& problem, const Effort&, const Stop& stop) {
  return run_engine(problem, changed(problem, [&](Tissue& t) { linearise(problem, t); }), {}, stop);
}

Answer schwartz_tensor_mass(const Problem& problem, const Effort&, const Stop& stop) {
  if (!has_law(problem)) {
    Answer answer;
    answer.trouble = "the scene's tissue has no stiffness law; without one it is the linear tensor-mass model";
    return answer;
  }
  return run_engine(problem, changed(problem, [](Tissue& t) { t.kinematics = Kinematics::small; }), {}, stop);
}

Answer green_tensor_mass(const Problem& problem, const Effort&, const Stop& stop) {
  const auto green = [&](Tissue& t) {
    const std::optional<Fibres> fibres = t.fibres;
    linearise(problem, t);
    t.kinematics = Kinematics::green;
    t.fibres = fibres;
  };
  return run_engine(problem, changed(problem, green), {}, stop);
}

Answer corotational(const Problem& problem, const Effort&, const Stop& stop) {
  const auto turning = [&](Tissue& t) {
    linearise(problem, t);
    t.kinematics = Kinematics::corotational;
  };
  return run_engine(problem, changed(problem, turning), {}, stop);
}

Answer neo_hookean(const Problem& problem, const Effort&, const Stop& stop) {
  const auto large = [&](Tissue& t) {
    const LameParameters lame = test_moduli(problem, t);
    linearise(problem, t);
    t.hyperelastic = NeoHookean{lame.mu, lame.lambda + 2.0 / 3.0 * lame.mu};
  };
  return run_engine(problem, changed(problem, large), {}, stop);
}

Answer own_tissue(const Problem& problem, const Effort&, const Stop& stop) {
  return run_engine(problem, problem.tissues, {}, stop);
}

Answer own_tissue_in_double(const Problem& problem, const Effort&, const Stop& stop) {
  return run_engine(problem, problem.tissues, {.precision = Precision::double_precision}, stop);
}

Answer own_tissue_implicit(const Problem& problem, const Effort& effort, const Stop& stop) {
  if (!is_viscous(problem)) return without_viscosity("glisson_quasi_static, and inertia");
  const double common = common_step(problem.stations);
  const double parts = std::ceil(effort.steps * common / problem.duration - 1e-9);
  SimulationOptions options{.integrator = Integrator::implicit, .step = common / std::max(1.0, parts)};
  options.implicit.preconditioner =
      Preconditioner::factorised;  // a block's factor is small, and is kept from step to step
  return run_engine(problem, problem.tissues, options, stop);
}

Answer own_tissue_at_rest(const Problem& problem, const Effort&, const Stop& stop) {
  return run_engine(problem, problem.tissues, {.integrator = Integrator::quasi_static}, stop);
}

}  // namespace glisson::models
