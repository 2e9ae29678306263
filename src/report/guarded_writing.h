// guarded_writing.h — writing while a run goes on: after the first thing that the disk refuses nothing more is written, and the run is to stop.
#pragma once

#include <atomic>
#include <functional>
#include <string>

#include "report/output_file.h"

namespace glisson {

class GuardedWriting {
 public:
  /// @param stop  set when the disk refuses; must outlive this
  explicit GuardedWriting(std::atomic<bool>& stop) : stop_(stop) {}

  void operator()(const std::function<void()>& write) {
    if (!error_.empty()) return;
    try {
      write();
    } catch (const OutputError& error) {
      error_ = error.what();
      stop_ = true;
    }
  }
  /// Why the disk refused; empty: it did not.
  const std::string& error() const { return error_; }

 private:
  std::atomic<bool>& stop_;
  std::string error_;
};

}  // namespace glisson
