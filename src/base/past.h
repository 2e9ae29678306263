// past.h — the numbers of a checkpoint's part, one after the other.
#pragma once

#include <cmath>
#include <cstddef>
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
  bool flag() { return index(2) == 1; }
  /// A whole number that an int holds.
  int whole() {
    const double n = number();
    ok_ = ok_ && std::abs(n) <= 2147483647.0 && n == std::floor(n);
    return ok_ ? static_cast<int>(n) : 0;
  }
  /// A whole number below `end`.
  std::size_t index(std::size_t end) {
    const double n = number();
    ok_ = ok_ && n >= 0.0 && n < static_cast<double>(end) && n == std::floor(n);
    return ok_ ? static_cast<std::size_t>(n) : 0;
  }
  /// How many follow, of `each` numbers: not more than are left.
  std::size_t count(std::size_t each = 1) {
    const std::size_t left = in_.empty() ? 0 : in_.size() - 1;
    return index(left / each + 1);
  }
  /// @param n  of count()
  std::span<const double> take(std::size_t n) {
    const std::span<const double> taken = in_.first(n);
    in_ = in_.subspan(n);
    return taken;
  }
  std::span<const double> left() const { return in_; }
  /// What is read does not fit.
  void refuse() { ok_ = false; }
  bool ok() const { return ok_; }
  bool done() const { return ok_ && in_.empty(); }

 private:
  std::span<const double> in_;
  bool ok_ = true;
};

}  // namespace glisson
