// heat_body.h — what a mesh is to heat: the volumes of its vertices at rest and the conductances between them, by tissue.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "glisson/heat/thermal_tissue.h"
#include "glisson/mesh.h"
#include "heat/tet_links.h"
#include "heat/thermal_curve.h"

namespace glisson::heat {

/// Volume of one tissue at a vertex.
struct Part {
  std::uint32_t tissue = 0;
  double volume = 0.0;  ///< [m³]
};

/// What one tissue conducts between a part of a vertex and those beside it: (Θ_to − Θ_p) w flows to the part. Rows of a symmetric matrix,
/// both halves, so that each row is summed by itself in a fixed order. In a row come those with w ≥ 0 first.
struct Links {
  std::vector<std::uint32_t> begin, negative;  ///< of each part's row, and of w below 0 in it
  std::vector<std::uint32_t> to;               ///< part
  std::vector<double> w;                       ///< [m]; below 0 between obtuse tets
};

/// A pair of parts with w below 0, and its two places in the rows.
struct NegativeLink {
  std::uint32_t a = 0, b = 0;  ///< parts
  std::uint32_t at_ab = 0, at_ba = 0;
};

/// Of all parts of a vertex at one temperature; conduction is their mean by volume.
struct VertexState {
  double heat = 0.0;      ///< [J]
  double capacity = 0.0;  ///< [J/K]
  double conductivity = 0.0;
};

class HeatBody {
 public:
  /// @param hollow  regions that are no part of it @param positions  where vertices are, between which heat is conducted [m]; empty: at rest
  /// @throws std::invalid_argument where another region has no tissue
  HeatBody(const TetMesh& mesh, const std::map<int, ThermalTissue>& tissues, std::span<const int> hollow = {},
           std::span<const Vec3d> positions = {});

  std::size_t size() const { return begin_.size() - 1; }
  std::span<const Part> parts(std::size_t vertex) const {
    return {parts_.data() + begin_[vertex], parts_.data() + begin_[vertex + 1]};
  }
  /// Number of the first part of a vertex; each vertex has one or more, so that with one tissue parts are numbered as vertices.
  std::size_t first_part(std::size_t vertex) const { return begin_[vertex]; }
  std::size_t part_count() const { return parts_.size(); }
  std::uint32_t vertex_of(std::size_t part) const { return vertex_of_[part]; }
  const Links& links() const { return links_; }
  std::span<const NegativeLink> negative_links() const { return negative_; }
  const ThermalCurve& curve(std::uint32_t number) const { return curves_[number]; }
  int region_of(std::uint32_t tissue) const { return regions_[tissue]; }
  std::size_t tissues() const { return curves_.size(); }
  double volume(std::size_t vertex) const { return volume_[vertex]; }
  /// Longest edge at a vertex over the least height of its tets above the faces across from it: no linear field falls from it by more
  /// than this times what it rises by, to vertices beside it, where tets surround it [BarrenecheaJohnKnobloch2017].
  double spread(std::size_t vertex) const { return spread_[vertex]; }

  VertexState state(std::size_t vertex, double temperature) const;
  /// The temperature at which a vertex contains a heat; not finite where that is not. @param near  where the search begins [°C]
  double temperature_of(std::size_t vertex, double heat, double near) const;

 private:
  static TetLinks present_links(const TetMesh& mesh, const Tet& t, std::span<const Vec3d> positions);
  void find_spreads(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of, std::span<const Vec3d> positions);
  void find_parts(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of);
  void find_links(const TetMesh& mesh, const std::vector<std::uint32_t>& tissue_of, std::span<const Vec3d> positions);
  std::uint32_t part_of(std::uint32_t vertex, std::uint32_t tissue) const;

  std::vector<ThermalCurve> curves_;
  std::vector<int> regions_;
  std::vector<std::size_t> begin_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> vertex_of_;
  std::vector<double> volume_, spread_;
  Links links_;
  std::vector<NegativeLink> negative_;
};

}  // namespace glisson::heat
