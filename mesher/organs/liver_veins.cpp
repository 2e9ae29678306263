// liver_veins.cpp — portal and hepatic veins to the third generation.
#include <algorithm>

#include "mesher/organs/liver_parts.h"

namespace glisson::detail {
namespace {

using Points = std::vector<LiverParts::Point>;

constexpr double kThinnest = 0.6;  ///< of the edge: the least radius of a vein in which the lattice always has vertices
constexpr double kShortest = 3.0;  ///< edges: a tree with less than that in all is no region

/// A vein up to where it becomes too thin for the mesh; empty where less than two points are left.
Points followed(Points vein, double least) {
  std::size_t n = 0;
  while (n < vein.size() && vein[n].radius >= least) ++n;
  if (n < vein.size() && n > 0 && vein[n - 1].radius > vein[n].radius) {  // ends between two points
    const LiverParts::Point a = vein[n - 1], b = vein[n];
    const double t = (a.radius - least) / (a.radius - b.radius);
    if (t > 0.05) vein[n++] = {a.at + (b.at - a.at) * t, least};
  }
  vein.resize(n);
  return n < 2 ? Points{} : vein;
}

double length_of(const Points& vein) {
  double length = 0.0;
  for (std::size_t i = 1; i < vein.size(); ++i) length += norm(vein[i].at - vein[i - 1].at);
  return length;
}

void add_tree(LiverParts& parts, const std::string& name, const std::vector<Points>& veins, double edge) {
  std::vector<Points> kept;
  double length = 0.0;
  for (const Points& vein : veins) {
    kept.push_back(followed(vein, kThinnest * edge));
    length += length_of(kept.back());
  }
  if (length < kShortest * edge) return;
  std::vector<std::string> of;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (kept[i].empty()) continue;
    of.push_back(name + "_" + std::to_string(i));
    parts.tube(of.back(), kept[i]);
  }
  parts.unite(name + "_tree", of, 2.0);
  parts.region(name, name + "_tree", "whole");
}

}  // namespace

void add_veins(LiverParts& parts, double hepatic_edge, double portal_edge) {
  // Each line: from the stem outward, centre and radius.
  const std::vector<Points> hepatic{
      {{{2, 44, 56}, 5.5}, {{-26, 24, 40}, 5}, {{-58, 14, 12}, 4}, {{-72, 8, -22}, 2.5}},        // right
      {{{3, 42, 56}, 5.5}, {{-4, 16, 42}, 4.5}, {{-14, -10, 14}, 3.5}, {{-22, -22, -10}, 2.5}},  // middle
      {{{5, 42, 56}, 5.5}, {{20, 18, 48}, 4.5}, {{44, -4, 42}, 3.5}, {{66, -16, 36}, 2.5}},      // left
      {{{-26, 24, 40}, 3.5}, {{-48, 4, 36}, 2.5}, {{-66, -8, 26}, 2}},
      {{{-58, 14, 12}, 3}, {{-62, 26, -8}, 2.5}, {{-60, 26, -30}, 2}},
      {{{-14, -10, 14}, 3}, {{-32, -26, 8}, 2.5}, {{-46, -30, -6}, 2}},
      {{{-4, 16, 42}, 3}, {{4, -8, 32}, 2.5}, {{8, -24, 18}, 2}},
      {{{20, 18, 48}, 3}, {{34, -10, 50}, 2.5}, {{40, -26, 46}, 2}},
  };
  const std::vector<Points> portal{
      {{{14, 20, -34}, 6}, {{4, 14, -12}, 6}},                                            // trunk
      {{{4, 14, -12}, 5.5}, {{-16, 10, -4}, 5}, {{-34, 6, 0}, 4.5}},                      // right
      {{{-34, 6, 0}, 4.2}, {{-46, -14, 10}, 3.5}, {{-56, -24, 28}, 2.5}},                 // right anterior
      {{{-34, 6, 0}, 4.2}, {{-52, 18, -4}, 3.5}, {{-66, 22, -24}, 2.5}},                  // right posterior
      {{{4, 14, -12}, 5}, {{18, 6, 6}, 4.5}, {{24, -8, 18}, 4.2}, {{24, -22, 24}, 3.2}},  // left
      {{{24, -8, 18}, 3.5}, {{42, -4, 28}, 3}, {{60, -2, 36}, 2}},                        // segment II
      {{{24, -22, 24}, 3}, {{42, -26, 30}, 2.5}, {{58, -26, 34}, 2}},                     // segment III
      {{{24, -8, 18}, 3}, {{10, -20, 14}, 2.5}, {{2, -30, 8}, 2}},                        // segment IV
      {{{-46, -14, 10}, 3}, {{-50, -26, -6}, 2.5}, {{-50, -30, -26}, 2}},                 // segment V
      {{{-52, 18, -4}, 3}, {{-66, 16, 12}, 2.5}, {{-76, 8, 24}, 2}},                      // segment VII
  };
  add_tree(parts, "hepatic_veins", hepatic, hepatic_edge);
  add_tree(parts, "portal_veins", portal, portal_edge);
}

}  // namespace glisson::detail
