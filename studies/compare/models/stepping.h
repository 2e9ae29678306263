// stepping.h — a model that advances by steps, from rest to the end of the experiment.
#pragma once

#include <cstddef>

#include "compare/models/rival.h"
#include "compare/models/stopwatch.h"

namespace glisson::models {

/// Advances a model in equal steps and reads its force at the stations.
/// @param model  advance(t, h), force(t), displacement(), bytes() and remove(tets), which says why it cannot, or nothing
/// @param watch  started before the model was made
template <class Model>
Answer run_in_steps(const Problem& problem, const Stop& stop, Model& model, std::size_t steps, Stopwatch& watch) {
  Answer answer;
  answer.setup_s = watch.lap();
  const double h = problem.duration / static_cast<double>(steps);
  std::size_t next = 0, n = 0;
  bool whole = problem.cut.has_value();
  for (; n < steps && !stop; ++n) {
    if (whole && h * static_cast<double>(n) >= problem.cut->time) {
      whole = false;
      Stopwatch knife;
      answer.trouble = model.remove(problem.cut->tets);
      if (!answer.trouble.empty()) return answer;
      answer.cut_s = knife.lap();
    }
    model.advance(h * static_cast<double>(n), h);
    while (next < problem.stations.size() && problem.stations[next] <= h * (static_cast<double>(n) + 1.5)) {
      answer.forces.push_back(model.force(problem.stations[next]));
      ++next;
    }
  }
  answer.run_s = watch.lap();
  answer.displacement = model.displacement();
  answer.bytes = model.bytes();
  answer.steps = n;
  answer.share_done = static_cast<double>(n) / static_cast<double>(steps);
  return answer;
}

}  // namespace glisson::models
