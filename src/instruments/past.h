// past.h — the numbers of an interaction's checkpoint, one after the other.
#pragma once

#include <span>
#include <vector>

#include "glisson/math.h"

namespace glisson {

class PastWriter {
 public:
  explicit PastWriter(std::vector<double>& out) : out_(out) {}
  void operator()(double a) { out_.push_back(a); }
  void operator()(const Vec3d& a) { out_.insert(out_.end(), {a.x, a.y, a.z}); }

 private:
  std::vector<double>& out_;
};

/// Reads what may be cut or changed: where a number is missing or no count, ok() is false from then on and all else is 0.
class PastReader {
 public:
  explicit PastReader(std::span<const double> in) : in_(in) {}

  double number() {
    ok_ = ok_ && !in_.empty();
    if (!ok_) return 0.0;
    const double value = in_.front();
    in_ = in_.subspan(1);
    return value;
  }
  Vec3d vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  /// How many follow, at most as many as numbers are left.
  std::size_t count() {
    const double n = number();
    ok_ = ok_ && n >= 0.0 && n <= static_cast<double>(in_.size());
    return ok_ ? static_cast<std::size_t>(n) : 0;
  }
  std::span<const double> take(std::size_t n) {
    const std::span<const double> taken = in_.first(n);
    in_ = in_.subspan(n);
    return taken;
  }
  std::span<const double> left() const { return in_; }
  bool ok() const { return ok_; }
  bool done() const { return ok_ && in_.empty(); }

 private:
  std::span<const double> in_;
  bool ok_ = true;
};

}  // namespace glisson
