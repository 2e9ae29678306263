// cached_model.h — a forward run is made once: curves with the same history share it, and a point asked again is remembered.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "fit/model.h"
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

  std::uint64_t runs() const { return runs_; }  ///< really made
  double seconds() const { return seconds_; }   ///< they took, one thread each

 private:
  using Key = std::pair<std::size_t, std::vector<double>>;
  struct Entry {
    std::once_flag once;
    Prediction result;
  };
  std::shared_ptr<Entry> entry(const Key& key) const;

  std::shared_ptr<const Model> inner_;
  std::vector<std::size_t> same_as_;  ///< the first curve of the same history
  std::size_t most_;
  mutable std::mutex mutex_;
  mutable std::map<Key, std::shared_ptr<Entry>> known_;
  mutable std::deque<Key> order_;
  mutable std::atomic<std::uint64_t> runs_{0};
  mutable std::atomic<double> seconds_{0.0};
};

}  // namespace glisson::fit
