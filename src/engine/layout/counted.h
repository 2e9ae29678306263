// counted.h — a number that counts the operations done on it, to take the place of a vector of lanes.
//
// The functions have the names of Highway's, so that the element's arithmetic runs on it unchanged
// (element_math-inl.h). A multiply-add is two operations; comparing, choosing and reading bits are none.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glisson::engine {

struct CountTag {};

struct Counted {
  float value = 0.0F;
  static inline thread_local std::size_t operations = 0;

  static Counted after(std::size_t n, float value) {
    operations += n;
    return {value};
  }
  friend Counted operator+(Counted a, Counted b) { return after(1, a.value + b.value); }
  friend Counted operator-(Counted a, Counted b) { return after(1, a.value - b.value); }
  friend Counted operator*(Counted a, Counted b) { return after(1, a.value * b.value); }
  friend Counted operator/(Counted a, Counted b) { return after(1, a.value / b.value); }
};

inline Counted Set(CountTag, float value) { return {value}; }
inline Counted MulAdd(Counted a, Counted b, Counted c) { return Counted::after(2, a.value * b.value + c.value); }
inline Counted NegMulAdd(Counted a, Counted b, Counted c) { return Counted::after(2, c.value - a.value * b.value); }
inline Counted Sqrt(Counted a) { return Counted::after(1, std::sqrt(a.value)); }
inline Counted Abs(Counted a) { return {std::abs(a.value)}; }
inline Counted Min(Counted a, Counted b) { return {std::min(a.value, b.value)}; }
inline Counted Max(Counted a, Counted b) { return {std::max(a.value, b.value)}; }
inline bool Lt(Counted a, Counted b) { return a.value < b.value; }
inline bool Gt(Counted a, Counted b) { return a.value > b.value; }
inline bool AllTrue(CountTag, bool all) { return all; }
inline Counted IfThenElse(bool choice, Counted yes, Counted no) { return choice ? yes : no; }
inline Counted guess_inverse_cube_root(CountTag, Counted a) { return {1.0F / std::cbrt(a.value)}; }

}  // namespace glisson::engine
