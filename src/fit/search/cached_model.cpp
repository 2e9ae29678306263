#include "fit/search/cached_model.h"

#include <tbb/task_arena.h>

#include <chrono>

namespace glisson::fit {

CachedModel::CachedModel(std::shared_ptr<const Model> inner, const std::vector<Curve>& curves,
                         std::vector<char> distinct, std::size_t most)
    : inner_(std::move(inner)), most_(most) {
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

std::shared_ptr<CachedModel::Entry> CachedModel::entry(const Key& key) const {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<Entry>& found = known_[key];
  if (found) return found;
  found = std::make_shared<Entry>();
  std::shared_ptr<Entry> made = found;
  order_.push_back(key);
  if (order_.size() > most_) {
    known_.erase(order_.front());
    order_.pop_front();
  }
  return made;
}

Prediction CachedModel::predict(std::size_t curve, std::span<const double> values) const {
  const std::size_t own = same_as_[curve];
  const std::shared_ptr<Entry> e = entry({own, {values.begin(), values.end()}});
  std::call_once(e->once, [&] {
    const auto begin = std::chrono::steady_clock::now();
    // isolated: a thread that waits within a run must not take up another task that waits for this very run
    tbb::this_task_arena::isolate([&] { e->result = inner_->predict(own, values); });
    seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    ++runs_;
  });
  return e->result;
}

}  // namespace glisson::fit
