// kept_results.h — what was computed once is kept for those who ask again, from any number of threads.
#pragma once

#include <tbb/task_arena.h>

#include <cstddef>
#include <deque>
#include <map>
#include <memory>
#include <mutex>

namespace glisson::fit {

/// Results by key, the latest `most` of them. A result that several threads ask for at once is made by one of them.
template <class Key, class Result>
class KeptResults {
 public:
  explicit KeptResults(std::size_t most) : most_(most) {}

  struct Found {
    std::shared_ptr<const Result> result;
    bool made = false;  ///< by this very call
  };
  /// @param make  returns the result of the key; must not throw
  template <class Make>
  Found get(const Key& key, Make make) {
    const std::shared_ptr<Entry> e = entry(key);
    bool made = false;
    std::call_once(e->once, [&] {
      // isolated: a thread that waits within a run must not take up another task that waits for this very run
      tbb::this_task_arena::isolate([&] { e->result = make(); });
      made = true;
    });
    return {std::shared_ptr<const Result>(e, &e->result), made};
  }

 private:
  struct Entry {
    std::once_flag once;
    Result result;
  };
  std::shared_ptr<Entry> entry(const Key& key) {
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

  std::size_t most_;
  std::mutex mutex_;
  std::map<Key, std::shared_ptr<Entry>> known_;
  std::deque<Key> order_;
};

}  // namespace glisson::fit
