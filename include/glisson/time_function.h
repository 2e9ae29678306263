// time_function.h — a function of time that knows its corners: where long steps end so that they do not pass over them.
//
// A corner is a time at which the function or its rate jumps, or at which an oscillation turns. Automatic steps of `implicit` and
// `quasi_static` end there; explicit steps are short anyway and do not ask. A function of a program's own has none unless it names
// them.
#pragma once

#include <cstddef>
#include <functional>
#include <type_traits>
#include <utility>
#include <vector>

namespace glisson {

/// Corners of a motion or load, in any order [s].
class CornerTimes {
 public:
  CornerTimes() = default;
  explicit CornerTimes(std::vector<double> times);

  void add(double time) { *this = with(CornerTimes({time})); }
  /// Adds first, first + period …, up to `last`. @param period  > 0 [s]
  void add_every(double period, double first, double last) { rows_.push_back({first, period, last}); }
  /// These and others.
  CornerTimes with(const CornerTimes& others) const;
  /// The first after a time [s]; infinite: none follows.
  double after(double time) const;

 private:
  struct Row {
    double first, period, last;
  };
  std::vector<double> times_;  ///< ascending
  std::vector<Row> rows_;
};

/// A function of time [s] with its corners.
template <class V>
class TimeFunction : public std::function<V(double)> {
 public:
  using Function = std::function<V(double)>;
  TimeFunction() = default;
  TimeFunction(std::nullptr_t) {}
  template <class F>
  requires(!std::is_base_of_v<TimeFunction, std::decay_t<F>> && std::is_constructible_v<Function, F>)
      TimeFunction(F f, CornerTimes its_corners = {})
      : Function(std::move(f)), corners(std::move(its_corners)) {}

  CornerTimes corners;
};

}  // namespace glisson
