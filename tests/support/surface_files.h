// surface_files.h — closed surfaces of triangles, and the same as the bytes of files of every format that is read.
#pragma once

#include <bit>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <sstream>
#include <string>

#include "glisson/scene/surface_file.h"

namespace glisson::test {

/// A ball of 20 · 4ⁿ triangles with its corners on the sphere.
inline TriangleSurface icosphere(double radius, int splits) {
  const double g = 0.5 * (1.0 + std::sqrt(5.0));
  TriangleSurface s{{{-1, g, 0},
                     {1, g, 0},
                     {-1, -g, 0},
                     {1, -g, 0},
                     {0, -1, g},
                     {0, 1, g},
                     {0, -1, -g},
                     {0, 1, -g},
                     {g, 0, -1},
                     {g, 0, 1},
                     {-g, 0, -1},
                     {-g, 0, 1}},
                    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (int n = 0; n < splits; ++n) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [at, is_new] = middles.try_emplace({std::min(a, b), std::max(a, b)}, s.points.size());
      if (is_new) s.points.push_back(unit(s.points[a]) + unit(s.points[b]));
      return at->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : s.triangles) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      for (const Triangle& t : {Triangle{a, ab, ca}, Triangle{ab, b, bc}, Triangle{ca, bc, c}, Triangle{ab, bc, ca}})
        finer.push_back(t);
    }
    s.triangles = std::move(finer);
  }
  for (Vec3d& x : s.points) x = unit(x) * radius;
  return s;
}

/// A torus about z.
inline TriangleSurface torus_surface(double radius, double tube_radius, std::uint32_t around, std::uint32_t across) {
  TriangleSurface s;
  for (std::uint32_t i = 0; i < around; ++i) {
    for (std::uint32_t j = 0; j < across; ++j) {
      const double a = 2.0 * std::numbers::pi * i / around, b = 2.0 * std::numbers::pi * j / across;
      const double r = radius + tube_radius * std::cos(b);
      s.points.push_back({r * std::cos(a), r * std::sin(a), tube_radius * std::sin(b)});
      const std::uint32_t i1 = (i + 1) % around, j1 = (j + 1) % across;
      s.triangles.push_back({i * across + j, i1 * across + j, i1 * across + j1});
      s.triangles.push_back({i * across + j, i1 * across + j1, i * across + j1});
    }
  }
  return s;
}

/// A cube from 0 to `size`.
inline TriangleSurface cube_surface(double size) {
  TriangleSurface s;
  for (int i = 0; i < 8; ++i) s.points.push_back(Vec3d{double(i & 1), double(i >> 1 & 1), double(i >> 2)} * size);
  s.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return s;
}

inline double volume_within(const TriangleSurface& s) {
  double sum = 0.0;
  for (const Triangle& t : s.triangles) sum += dot(s.points[t[0]], cross(s.points[t[1]], s.points[t[2]])) / 6.0;
  return sum;
}

inline std::string text_of(const Vec3d& x) {
  std::ostringstream out;
  out.precision(9);
  out << x.x << " " << x.y << " " << x.z;
  return out.str();
}

template <class T>
void append(std::string& bytes, T value, std::endian order) {
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  if (order != std::endian::native) std::reverse(raw, raw + sizeof(T));
  bytes.append(raw, sizeof(T));
}

inline std::string stl_text(const TriangleSurface& s) {
  std::string out = "solid organ of the test\n";
  for (const Triangle& t : s.triangles) {
    out += "  facet normal 0 0 0\n    outer loop\n";
    for (const std::uint32_t v : t) out += "      vertex " + text_of(s.points[v]) + "\n";
    out += "    endloop\n  endfacet\n";
  }
  return out + "endsolid organ of the test\n";
}

inline std::string stl_binary(const TriangleSurface& s) {
  std::string out = "solid by a program that begins binary files so";
  out.resize(80);
  append(out, static_cast<std::uint32_t>(s.triangles.size()), std::endian::little);
  for (const Triangle& t : s.triangles) {
    out.append(12, '\0');
    for (const std::uint32_t v : t) {
      for (std::size_t k = 0; k < 3; ++k) append(out, static_cast<float>(s.points[v][k]), std::endian::little);
    }
    out.append(2, '\0');
  }
  return out;
}

inline std::string obj_text(const TriangleSurface& s) {
  std::string out = "# from the test\nmtllib none.mtl\no organ\n";
  for (const Vec3d& x : s.points) out += "v " + text_of(x) + "\n";
  out += "vt 0 0\ng all\n";
  for (const Triangle& t : s.triangles) {
    out += "f " + std::to_string(t[0] + 1) + "/1 " + std::to_string(t[1] + 1) + "//1 " +
           std::to_string(static_cast<int>(t[2]) - static_cast<int>(s.points.size())) + "\n";
  }
  return out;
}

inline std::string ply_head(const TriangleSurface& s, const std::string& format) {
  return "ply\nformat " + format + " 1.0\ncomment from the test\nelement vertex " + std::to_string(s.points.size()) +
         "\nproperty double x\nproperty uchar red\nproperty double y\nproperty double z\nelement face " +
         std::to_string(s.triangles.size()) +
         "\nproperty list uchar int vertex_indices\nproperty short flags\nend_header\n";
}

inline std::string ply_text(const TriangleSurface& s) {
  std::string out = ply_head(s, "ascii");
  for (const Vec3d& x : s.points) {
    std::string words = text_of(x);
    out += words.insert(words.find(' '), " 255") + "\n";
  }
  for (const Triangle& t : s.triangles) {
    out += "3 " + std::to_string(t[0]) + " " + std::to_string(t[1]) + " " + std::to_string(t[2]) + " -7\n";
  }
  return out;
}

inline std::string ply_binary(const TriangleSurface& s, std::endian order) {
  std::string out = ply_head(s, order == std::endian::little ? "binary_little_endian" : "binary_big_endian");
  for (const Vec3d& x : s.points) {
    append(out, x.x, order), append(out, std::uint8_t{255}, order), append(out, x.y, order), append(out, x.z, order);
  }
  for (const Triangle& t : s.triangles) {
    append(out, std::uint8_t{3}, order);
    for (const std::uint32_t v : t) append(out, v, order);
    append(out, std::int16_t{-7}, order);
  }
  return out;
}

}  // namespace glisson::test
