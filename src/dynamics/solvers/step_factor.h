// step_factor.h — how far forces within a step move the vertices at its end, as interactions ask for it (step_contact.h).
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>

namespace glisson {

/// A factorised matrix P of a step: P Δu = f.
class StepFactor {
 public:
  virtual ~StepFactor() = default;
  /// x ← P⁻¹ x column by column, 3 numbers a vertex; held components neither act nor move.
  virtual void factor_solve(Eigen::MatrixXd& x) const = 0;
  /// How often the factor has been made; 0 while there is none.
  virtual std::uint64_t factor_number() const = 0;
  /// What was solved with it, for whoever solves with it; goes with the factor, into saved states too. None: nothing as yet.
  virtual std::shared_ptr<void>& solved() = 0;
  /// Has the factor made anew before it is next used: the step is another one.
  virtual void renew() = 0;
  virtual bool is_free(std::size_t component) const = 0;
};

}  // namespace glisson
