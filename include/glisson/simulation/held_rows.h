// held_rows.h — the constraints of interactions in a step, for the drag stages of the next one (SimulationOptions::drag_stages).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "glisson/math.h"

namespace glisson {

class Archive;

/// A vertex and its weight in a mean [-].
struct VertexWeight {
  std::uint32_t vertex = 0;
  double weight = 0.0;
  bool operator==(const VertexWeight&) const = default;
  void archive(Archive& ar);
};

/// Constraints held by impulses: means of vertices along directions (rows), and whole vertices. A group of rows is rigid or, as an
/// implicit force, compliant: a force that would change its velocities by δ in a step changes them by c (W + c)⁻¹ δ, with c the
/// compliance of the group and W that of the vertices alone.
class HeldRows {
 public:
  /// A mean [-], for add_row.
  std::uint32_t add_mean(std::span<const VertexWeight> mean);
  /// Holds a mean along a direction of length 1.
  void add_row(std::uint32_t mean, const Vec3d& direction) { rows_.push_back({mean, direction}); }
  /// Makes the last rows a group. Rows without one are held rigidly.
  /// @param compliance  c, symmetric, row by row: as many numbers as the square of the group's rows [1/kg]
  /// @throws std::invalid_argument if their number differs
  void end_group(std::span<const double> compliance);
  /// Holds a vertex in all directions.
  void add_vertex(std::uint32_t vertex) { vertices_.push_back(vertex); }
  void clear() { *this = {}; }
  bool empty() const { return rows_.empty() && vertices_.empty(); }

  struct Row {
    std::uint32_t mean = 0;
    Vec3d direction{};
    bool operator==(const Row&) const = default;
    void archive(Archive& ar);
  };
  struct Group {
    std::size_t first = 0, end = 0;      ///< rows
    std::span<const double> compliance;  ///< c [1/kg]
  };
  std::size_t mean_count() const { return mean_ends_.size(); }
  std::span<const VertexWeight> mean(std::size_t k) const;
  std::span<const Row> rows() const { return rows_; }
  std::size_t group_count() const { return groups_.size(); }
  Group group(std::size_t k) const;
  std::span<const std::uint32_t> vertices() const { return vertices_; }
  /// Whether means and vertices are equal to those of the other; the rows may differ.
  bool has_means_of(const HeldRows& other) const;
  bool operator==(const HeldRows&) const = default;
  void archive(Archive& ar);

 private:
  std::vector<VertexWeight> weights_;
  std::vector<std::uint32_t> mean_ends_;  ///< in weights_
  std::vector<Row> rows_;
  std::vector<std::array<std::uint32_t, 3>> groups_;  ///< of each: first row, end of the rows, end of its compliances
  std::vector<double> compliance_;
  std::vector<std::uint32_t> vertices_;
};

}  // namespace glisson
