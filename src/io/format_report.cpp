// format_report.cpp — the text of `glisson info MESH`.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "base/text.h"
#include "glisson/io.h"

namespace glisson {
namespace {

using detail::number_text;

struct Unit {
  double size;
  const char* name;
};

/// A length in the unit that gives the largest coordinate of its group one to four digits before the point.
Unit length_unit(double largest) {
  if (largest >= 1.0 || largest == 0.0) return {1.0, "m"};
  if (largest >= 1e-3) return {1e-3, "mm"};
  return {1e-6, "µm"};
}

std::string vector_text(const Vec3d& x, Unit unit, const char* separator) {
  const auto part = [&](double value) { return number_text(value / unit.size, 5); };
  return part(x.x) + separator + part(x.y) + separator + part(x.z);
}

std::string volume_text(double volume) {
  const double size = std::abs(volume);
  const Unit unit = size >= 1e-3 ? Unit{1e-3, "l"} : size >= 1e-9 ? Unit{1e-6, "ml"} : Unit{1e-9, "µl"};
  return number_text(volume, 5) + " m³ (" + number_text(volume / unit.size, 5) + " " + unit.name + ")";
}

void add_line(std::string& text, const std::string& label, const std::string& value) {
  constexpr std::size_t kLabelWidth = 18;
  text += "  " + label + std::string(label.size() < kLabelWidth ? kLabelWidth - label.size() : 1, ' ') + value + '\n';
}

void add_extent(std::string& text, const MeshReport& report) {
  const Vec3d extent = report.box_max - report.box_min;
  const auto largest_of = [](const Vec3d& x) { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); };
  const Unit corner = length_unit(std::max(largest_of(report.box_min), largest_of(report.box_max)));
  const Unit side = length_unit(largest_of(extent));
  std::string box = "(";
  box += vector_text(report.box_min, corner, ", ");
  box += ") to (";
  box += vector_text(report.box_max, corner, ", ");
  add_line(text, "bounding box", box + ") " + corner.name);
  add_line(text, "extent", vector_text(extent, side, " × ") + " " + side.name);
  add_line(text, "volume", volume_text(report.volume));
}

void add_regions(std::string& text, const TetMesh& mesh) {
  struct Content {
    std::size_t tets = 0;
    double six_volume = 0.0;
  };
  std::map<int, Content> regions;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Content& content = regions[mesh.region_of(t)];
    ++content.tets;
    content.six_volume += six_rest_volume(mesh, t);
  }
  for (const auto& [region, content] : regions) {
    const auto name = mesh.region_names.find(region);
    add_line(text, "region " + std::to_string(region),
             (name != mesh.region_names.end() ? "\"" + name->second + "\", " : "") +
                 detail::count_text(content.tets, "tet", "tets") + ", " + volume_text(content.six_volume / 6.0));
  }
}

void add_sets(std::string& text, const TetMesh& mesh) {
  if (mesh.vertex_sets.empty()) add_line(text, "vertex sets", "none");
  for (const auto& [name, set] : mesh.vertex_sets) {
    add_line(text, "vertex set", "\"" + name + "\", " + detail::count_text(set.size(), "vertex", "vertices"));
  }
}

/// Dihedral angles in bins of 10°, as bars of up to 40 marks.
void add_angles(std::string& text, const TetMesh& mesh) {
  constexpr std::size_t kWidth = 40;
  const std::vector<std::size_t> counts = dihedral_histogram(mesh);
  const auto is_used = [](std::size_t n) { return n > 0; };
  const auto first = std::find_if(counts.begin(), counts.end(), is_used);
  const auto last = std::find_if(counts.rbegin(), counts.rend(), is_used).base();
  const std::size_t most = *std::max_element(counts.begin(), counts.end());
  text += "\nDihedral angles:\n";
  for (auto bin = first; bin < last; ++bin) {
    const auto from = 10 * (bin - counts.begin());
    const std::size_t marks = (*bin * kWidth + most - 1) / most;  // one for the least that is not 0
    char range[64];
    std::snprintf(range, sizeof range, "  %3td°–%3td° %10zu ", from, from + 10, *bin);
    text += range + std::string(marks, '#') + '\n';
  }
}

void add_warnings(std::string& text, const MeshReport& report) {
  if (report.warnings.empty()) {
    text += "\nNothing suspicious.\n";
    return;
  }
  text += "\nPlease note:\n";
  for (const std::string& warning : report.warnings) text += "  - " + warning + '\n';
}

}  // namespace

std::string format_report(const std::string& name, const MeshReport& report, const TetMesh* mesh) {
  std::string text = name + '\n';
  add_line(text, "vertices", std::to_string(report.vertices));
  add_line(text, "tetrahedra", std::to_string(report.tets));
  add_line(text, "surface", detail::count_text(report.boundary_triangles, "triangle", "triangles"));
  add_line(text, "pieces", std::to_string(report.pieces));
  add_extent(text, report);
  add_line(text, "shape",
           "mean ratio: median " + number_text(report.median_mean_ratio, 3) + ", worst " +
               number_text(report.worst_mean_ratio, 3) + " in tet " + std::to_string(report.worst_tet) +
               " (1 is best)");
  if (mesh != nullptr) {
    add_regions(text, *mesh);
    add_sets(text, *mesh);
    if (!mesh->tets.empty()) add_angles(text, *mesh);
  }
  add_warnings(text, report);
  return text;
}

}  // namespace glisson
