// cached_model.h — a forward run is made once: curves with the same history share it, and a point asked again is remembered.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "fit/model/kept_results.h"
#include "fit/model/model.h"
#include "glisson/fit.h"

namespace glisson::fit {

class CachedModel final : public Model {
 public:
  /// @param curves  of `inner`, in its order @param distinct  per curve: whether it has parameters of its own, so that it
  /// shares no run with others; empty: none has @param most  runs remembered, ≥ 1
  CachedModel(std::shared_ptr<const Model> inner, const std::vector<Curve>& curves, std::vector<char> distinct = {},
              std::size_t most = 4096);
  std::size_t curves() const override { return inner_->curves(); }
  Prediction predict(std::size_t curve, std::span<const double> values) const override;

  std::uint64_t runs() const { return runs_; }  ///< really made: what is read from a run that was made before is none
  double seconds() const { return seconds_; }   ///< they took, one thread each

 private:
  std::shared_ptr<const Model> inner_;
  std::vector<std::size_t> same_as_;  ///< the first curve of the same history
  mutable KeptResults<std::pair<std::size_t, std::vector<double>>, Prediction> known_;
  mutable std::atomic<std::uint64_t> runs_{0};
  mutable std::atomic<double> seconds_{0.0};
};

}  // namespace glisson::fit
