#include "fit/search/cached_model.h"

#include <chrono>

namespace glisson::fit {

CachedModel::CachedModel(std::shared_ptr<const Model> inner, const std::vector<Curve>& curves,
                         std::vector<char> distinct, std::size_t most)
    : inner_(std::move(inner)), known_(most) {
  distinct.resize(curves.size(), 0);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    std::size_t same = c;
    for (std::size_t k = 0; k < c && same == c && distinct[c] == 0; ++k) {
      const Curve &a = curves[k], &b = curves[c];
      const bool alike = a.time == b.time && a.displacement == b.displacement && a.measurement == b.measurement;
      if (distinct[k] == 0 && alike) same = k;
    }
    same_as_.push_back(same);
  }
}

Prediction CachedModel::predict(std::size_t curve, std::span<const double> values) const {
  const std::size_t own = same_as_[curve];
  const auto make = [&] {
    const auto begin = std::chrono::steady_clock::now();
    Prediction result = inner_->predict(own, values);
    if (result.reused) return result;
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++runs_;
    return result;
  };
  return *known_.get({own, {values.begin(), values.end()}}, make).result;
}

}  // namespace glisson::fit
