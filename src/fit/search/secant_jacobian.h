// secant_jacobian.h — derivatives of dear residuals: by differences now and then, carried along between.
//
// A Jacobian by central differences costs two runs a parameter, a step costs one, and the step itself tells how the residuals
// changed along it. Between differences the Jacobian takes up just that, and nothing across the step [Broyden1965]:
//
//   J ← J + (r(z + s) − r(z) − J s) sᵀ / (sᵀ s)
//
// It is one of differences at first, where a step gained little of what J promised, and after so many updates; one-sided ones
// do for the way. A step shorter than the differences' own says nothing that they do not, and leaves J as it is.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fit/search/problem.h"

namespace glisson::fit {

class SecantJacobian {
 public:
  enum class Kind { carried, one_sided, central };

  /// @param skip  parameters that are held, as of Problem::residuals @param most_updates  between differences
  SecantJacobian(const Problem& problem, std::vector<char> skip, std::size_t most_updates);

  /// Residuals without derivatives; those of the latest point are remembered.
  const Residuals& values_at(std::span<const double> scaled);
  /// With the Jacobian, row-major; an updated one comes from the point that was asked for before.
  const Residuals& at(std::span<const double> scaled);
  /// The next one is of differences.
  void renew(Differences differences) { updates_ = most_, differences_ = differences; }
  /// What the latest is.
  Kind kind() const { return kind_; }

 private:
  bool worth_an_update(std::span<const double> scaled, const Residuals& now) const;
  void update(std::span<const double> scaled, const Residuals& now);

  const Problem& problem_;
  std::vector<char> skip_;
  std::size_t most_, updates_;
  Kind kind_ = Kind::carried;
  Differences differences_ = Differences::one_sided;  ///< the next
  std::vector<double> seen_z_, z_;                    ///< of the two below
  Residuals seen_, latest_;
};

}  // namespace glisson::fit
