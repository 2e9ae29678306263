// engine.cpp — the models that the engine has: the same body, supports and tools, other tissues and integrators.
#include <exception>

#include "glisson/material/hyperelastic_law.h"
#include "models/boundary.h"
#include "models/stopwatch.h"

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

Answer run(const Problem& problem, const std::map<int, Tissue>& tissues, SimulationOptions options, const Stop& stop) {
  Answer answer;
  Stopwatch watch;
  options.gravity = problem.motion.gravity;
  options.gravity_ramp = problem.motion.gravity_ramp;
  options.damping_rate = problem.motion.damping_rate;
  options.threads = 1;
  options.track_energies = false;
  options.exact_steps = false;
  const bool at_rest = options.integrator == Integrator::quasi_static;
  if (at_rest) options.step = problem.stations.front();
  Simulation simulation(problem.mesh, tissues, options);
  const std::vector<ConstraintId> read = hold_and_move(simulation, problem);
  answer.setup_s = watch.lap();
  bool whole = problem.cut.has_value();
  for (const double time : problem.stations) {
    while (!stop && simulation.time() < time - 0.5 * simulation.step_size()) {
      if (whole && (at_rest ? time : simulation.time()) >= problem.cut->time) {
        whole = false;
        Stopwatch knife;
        simulation.remove_tets(problem.cut->tets);
        answer.cut_s = knife.lap();
      }
      const StepResult result = simulation.step();
      ++answer.steps;
      if (result.made()) continue;
      answer.trouble = std::string(result.message);
      return answer;
    }
    if (stop) break;
    answer.forces.push_back(problem.moment_about ? simulation.torque(read.front(), *problem.moment_about)
                                                 : simulation.force(read.front()).total());
  }
  answer.run_s = watch.lap();
  answer.displacement.assign(simulation.displacement().begin(), simulation.displacement().end());
  answer.bytes =
      static_cast<std::size_t>(simulation.engine_info().bytes_per_tet * static_cast<double>(problem.mesh.tets.size()));
  return answer;
}

/// Every tissue of the problem, changed.
template <class Change>
std::map<int, Tissue> changed(const Problem& problem, Change change) {
  std::map<int, Tissue> tissues = problem.tissues;
  for (auto& [region, tissue] : tissues) change(tissue);
  return tissues;
}

/// Linear elasticity of the tissue's moduli at rest.
void linearise(Tissue& tissue) {
  const LameParameters lame = tissue.lame();
  Tissue linear{.name = tissue.name, .density = tissue.density, .volume_change = tissue.volume_change};
  linear.youngs_modulus = youngs_modulus(lame);
  linear.poisson_ratio = lame.lambda / (2.0 * (lame.lambda + lame.mu));
  tissue = linear;
}

Answer run_or_say_why(const Problem& problem, const std::map<int, Tissue>& tissues, const SimulationOptions& options,
                      const Stop& stop) {
  try {
    return run(problem, tissues, options, stop);
  } catch (const std::exception& error) {
    Answer answer;
    answer.trouble = error.what();
    return answer;
  }
}

bool has_law(const Problem& problem) {
  for (const auto& [region, tissue] : problem.tissues) {
    if (tissue.lambda_law || tissue.mu_law || !std::holds_alternative<ConstantLaw>(tissue.law)) return true;
  }
  return false;
}

}  // namespace

Answer linear_tensor_mass(const Problem& problem, const Effort&, const Stop& stop) {
  return run_or_say_why(problem, changed(problem, linearise), {}, stop);
}

Answer schwartz_tensor_mass(const Problem& problem, const Effort&, const Stop& stop) {
  if (!has_law(problem)) {
    Answer answer;
    answer.trouble = "the scene's tissue has no stiffness law; without one it is the linear tensor-mass model";
    return answer;
  }
  return run_or_say_why(problem, changed(problem, [](Tissue& t) { t.kinematics = Kinematics::small; }), {}, stop);
}

Answer green_tensor_mass(const Problem& problem, const Effort&, const Stop& stop) {
  const auto green = [](Tissue& t) {
    const std::optional<Fibres> fibres = t.fibres;
    linearise(t);
    t.kinematics = Kinematics::green;
    t.fibres = fibres;
  };
  return run_or_say_why(problem, changed(problem, green), {}, stop);
}

Answer corotational(const Problem& problem, const Effort&, const Stop& stop) {
  const auto turning = [](Tissue& t) {
    linearise(t);
    t.kinematics = Kinematics::corotational;
  };
  return run_or_say_why(problem, changed(problem, turning), {}, stop);
}

Answer neo_hookean(const Problem& problem, const Effort&, const Stop& stop) {
  const auto large = [](Tissue& t) {
    const LameParameters lame = t.lame();
    linearise(t);
    t.hyperelastic = NeoHookean{lame.mu, lame.lambda + 2.0 / 3.0 * lame.mu};
  };
  return run_or_say_why(problem, changed(problem, large), {}, stop);
}

Answer own_tissue(const Problem& problem, const Effort&, const Stop& stop) {
  return run_or_say_why(problem, problem.tissues, {}, stop);
}

Answer own_tissue_at_rest(const Problem& problem, const Effort&, const Stop& stop) {
  return run_or_say_why(problem, problem.tissues, {.integrator = Integrator::quasi_static}, stop);
}

}  // namespace glisson::models
