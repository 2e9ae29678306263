// math.h — the small vectors and matrices of the engine.
//
// Plain aggregates of three and nine numbers, templated on the scalar so that the same formula serves
// the float kernels and the double-precision reference. Nothing here allocates or throws.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

namespace glisson {

/// A vector of three components; its unit is that of the quantity it holds.
template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  constexpr T& operator[](std::size_t i) { return i == 0 ? x : (i == 1 ? y : z); }
  constexpr const T& operator[](std::size_t i) const { return i == 0 ? x : (i == 1 ? y : z); }

  constexpr Vec3& operator+=(const Vec3& b) { return *this = *this + b; }
  constexpr Vec3& operator-=(const Vec3& b) { return *this = *this - b; }
  constexpr Vec3& operator*=(T a) { return *this = *this * a; }

  friend constexpr Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
  friend constexpr Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
  friend constexpr Vec3 operator*(const Vec3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
  friend constexpr Vec3 operator*(T s, const Vec3& a) { return a * s; }
  friend constexpr bool operator==(const Vec3& a, const Vec3& b) = default;
};

/// A 3 × 3 matrix, `m[row][column]`.
template <class T>
struct Mat3 {
  std::array<std::array<T, 3>, 3> m{};

  constexpr T& operator()(std::size_t i, std::size_t j) { return m[i][j]; }
  constexpr const T& operator()(std::size_t i, std::size_t j) const { return m[i][j]; }
  friend constexpr bool operator==(const Mat3& a, const Mat3& b) = default;
};

using Vec3d = Vec3<double>;
using Vec3f = Vec3<float>;
using Mat3d = Mat3<double>;

template <class T>
constexpr T dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class T>
constexpr Vec3<T> cross(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

template <class T>
T norm(const Vec3<T>& a) {
  return std::sqrt(dot(a, a));
}

/// v / |v|; v is not zero.
template <class T>
Vec3<T> unit(const Vec3<T>& v) {
  return v * (T(1) / norm(v));
}

/// Product by components.
template <class T>
constexpr Vec3<T> component_product(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}

template <class T>
constexpr Mat3<T> identity() {
  return {{{{T(1), T(0), T(0)}, {T(0), T(1), T(0)}, {T(0), T(0), T(1)}}}};
}

// clang-format off: one row a line
template <class T>
constexpr Vec3<T> operator*(const Mat3<T>& a, const Vec3<T>& v) {
  return {a(0, 0) * v.x + a(0, 1) * v.y + a(0, 2) * v.z, a(1, 0) * v.x + a(1, 1) * v.y + a(1, 2) * v.z,
          a(2, 0) * v.x + a(2, 1) * v.y + a(2, 2) * v.z};
}

template <class T>
constexpr T trace(const Mat3<T>& a) {
  return a(0, 0) + a(1, 1) + a(2, 2);
}

template <class T>
constexpr T determinant(const Mat3<T>& a) {
  return a(0, 0) * (a(1, 1) * a(2, 2) - a(1, 2) * a(2, 1)) - a(0, 1) * (a(1, 0) * a(2, 2) - a(1, 2) * a(2, 0)) +
         a(0, 2) * (a(1, 0) * a(2, 1) - a(1, 1) * a(2, 0));
}
// clang-format on

template <class T>
constexpr Mat3<T> operator*(const Mat3<T>& a, const Mat3<T>& b) {
  Mat3<T> m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m(i, j) = a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j);
  }
  return m;
}

template <class T>
constexpr Mat3<T> transposed(const Mat3<T>& a) {
  Mat3<T> m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m(i, j) = a(j, i);
  }
  return m;
}

/// a bᵀ.
template <class T>
constexpr Mat3<T> outer(const Vec3<T>& a, const Vec3<T>& b) {
  Mat3<T> m;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m(i, j) = a[i] * b[j];
  }
  return m;
}

/// Inverse by cofactors. The determinant must not be zero.
template <class T>
constexpr Mat3<T> inverse(const Mat3<T>& a) {
  const T d = T(1) / determinant(a);
  Mat3<T> r;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      r(j, i) = d * (a(i1, j1) * a(i2, j2) - a(i1, j2) * a(i2, j1));
    }
  }
  return r;
}

}  // namespace glisson
