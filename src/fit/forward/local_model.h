// local_model.h — a cubic in place of a dear forward model, within a region in which it was run some dozen times.
//
// Profiles and replicates of a bootstrap ask for hundreds of runs about one optimum, where forces are smooth in the
// parameters. There
//
//   F(values) ≈ F(centre) + Σ c_m ξ^m,   1 ≤ |m| ≤ 3,   values = centre + Σ_k axes_k ξ_k,   |ξ_k| ≤ 1
//
// with c by least squares over twice as many runs as there are terms, denser towards the region's faces. It is exact at the
// centre. Outside the region, and for curves that it was not made of, the model itself is run.
#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "fit/model/model.h"

namespace glisson::fit {

struct Region {
  std::vector<double> centre;             ///< a value for each parameter, in its own unit
  std::vector<std::vector<double>> axes;  ///< as many as parameters, independent of each other
};

class LocalModel final : public Model {
 public:
  /// Runs `inner` at the centre and about it, side by side on all of oneTBB's threads; the same bytes on any number of them.
  /// @param inner  must outlive this @param curves  of it that are replaced @param region  where every run is allowed
  LocalModel(const Model& inner, const std::vector<std::size_t>& curves, Region region);

  std::size_t curves() const override { return inner_.curves(); }
  Prediction predict(std::size_t curve, std::span<const double> values) const override;

  const std::string& failure() const { return failure_; }  ///< why there is no cubic: a run failed; empty: there is
  /// Runs of each curve that the cubic is made from, the centre among them.
  static std::size_t runs_for(std::size_t parameters);
  std::size_t points() const { return points_; }
  /// What the cubic misses of a run that it was not made from: the root mean square over runs and samples, each left out in
  /// turn [N].
  double error(std::size_t curve) const { return pieces_.at(curve).error; }

 private:
  /// A curve's force at the centre and its terms, a column each sample.
  struct Piece {
    std::vector<double> middle;
    Eigen::MatrixXd terms;
    double error = 0.0;
  };
  Eigen::VectorXd coordinates(std::span<const double> values) const;

  const Model& inner_;
  Region region_;
  Eigen::MatrixXd to_unit_;  ///< values − centre → ξ
  std::map<std::size_t, Piece> pieces_;
  std::size_t points_ = 0;  ///< runs, the centre among them
  std::string failure_;
};

}  // namespace glisson::fit
