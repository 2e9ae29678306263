// viscous_reference.cpp — see viscous_reference.h.
#include "compare/viscous_reference.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "glisson/scene/convergence_variant.h"

namespace glisson::app {
namespace {

using models::Answer;
using models::Problem;

constexpr int kFirstSteps = 20, kMostSteps = 640;
constexpr double kStepShare = 3e-3;      // of the largest force
constexpr double kExplicitSteps = 50.0;  // that cost as much as an implicit one

/// How the tissue is moved.
struct Steps {
  bool explicit_ones = false;
  int count = 0;      ///< of implicit ones
  std::string words;  ///< what they are, and what others would change
};

Answer moved(const Problem& problem, const Steps& steps, const std::atomic<bool>& stop) {
  Answer answer = steps.explicit_ones ? models::own_tissue_in_double(problem, {}, stop)
                                      : models::own_tissue_implicit(problem, {steps.count, 0}, stop);
  if (!answer.trouble.empty()) throw SceneError("the reference finds no balance of forces: " + answer.trouble);
  return answer;
}

/// Root mean square of what differs, over the largest force.
double difference(const std::vector<Vec3d>& a, const std::vector<Vec3d>& b) {
  double sum = 0.0, most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += dot(a[i] - b[i], a[i] - b[i]);
    most = std::max(most, norm(b[i]));
  }
  return most > 0.0 ? std::sqrt(sum / static_cast<double>(a.size())) / most : 0.0;
}

/// Steps that are short enough on a coarse mesh: implicit ones, or explicit ones, which always are, where they are cheaper.
/// @param finer  how often the reference's mesh is twice as fine
Steps steps_enough(const Problem& problem, std::size_t finer, const std::atomic<bool>& stop) {
  const Answer short_ones = models::own_tissue(problem, {}, stop);
  if (!short_ones.trouble.empty()) throw SceneError("the reference cannot be moved: " + short_ones.trouble);
  Answer last = moved(problem, {false, kFirstSteps, {}}, stop);
  for (int steps = 2 * kFirstSteps; !stop; steps *= 2) {
    Answer next = moved(problem, {false, steps, {}}, stop);
    if (stop) break;
    const double change = difference(last.forces, next.forces), others = difference(next.forces, short_ones.forces);
    const double length = problem.duration / static_cast<double>(next.steps);
    const double price = std::ldexp(static_cast<double>(short_ones.steps), static_cast<int>(finer)) / kExplicitSteps;
    if (steps >= kMostSteps || price < static_cast<double>(next.steps)) {
      return {true, 0,
              fmt::format("Explicit steps; implicit ones of {:.3g} s change the forces by {:.2g} %", length,
                          100.0 * others)};
    }
    if (next.steps > last.steps && change <= kStepShare) {  // stations may ask for more steps than either
      return {false, steps,
              fmt::format("Implicit steps of {:.3g} s; twice as long ones change the forces by {:.2g} %, explicit ones "
                          "by {:.2g} %",
                          length, 100.0 * change, 100.0 * others)};
    }
    last = std::move(next);
  }
  return {};
}

/// Each station's force in the limit of fine meshes. @param forces  of meshes with cells of these sizes
void extrapolate(Reference& reference, double order, const std::vector<double>& sizes,
                 const std::vector<std::vector<Vec3d>>& forces) {
  for (std::size_t i = 0; i < reference.forces.size(); ++i) {
    std::vector<MeshResult> results;
    for (std::size_t k = 0; k < sizes.size(); ++k) results.push_back({sizes[k], norm(forces[k][i])});
    reference.forces[i] *= 1.0 + reference.take_limit(grid_convergence(results, order), results.back().value);
  }
}

}  // namespace

Reference make_viscous_reference(const std::vector<Problem>& problems, double order, const std::atomic<bool>& stop,
                                 const std::function<void(const std::string&)>& say) {
  Reference reference;
  reference.kind = "in motion";
  say("reference, length of its steps");
  const Steps steps = steps_enough(problems.front(), problems.size() - 1, stop);
  std::vector<double> sizes;
  std::vector<std::vector<Vec3d>> forces;
  for (const Problem& problem : problems) {
    if (stop) return {};
    say(fmt::format("reference, {} tets", problem.mesh.tets.size()));
    Answer answer = moved(problem, steps, stop);
    if (stop) return {};
    sizes.push_back(cell_size(problem.mesh));
    forces.push_back(answer.forces);
    reference.tets = problem.mesh.tets.size();
    reference.forces = std::move(answer.forces);
    reference.displacement = std::move(answer.displacement);
  }
  extrapolate(reference, order, sizes, forces);
  if (!reference.words.empty()) reference.words += ". ";
  reference.words += steps.words;
  return reference;
}

}  // namespace glisson::app
