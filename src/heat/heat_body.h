// heat_body.h — what a mesh at rest is to heat: the volumes of its vertices and the conductances between them, by tissue.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "glisson/heat/thermal_tissue.h"
#include "glisson/mesh.h"

namespace glisson::heat {

/// Volume of one tissue at a vertex.
struct Part {
  std::uint32_t tissue = 0;
  double volume = 0.0;  ///< [m³]
};

/// Two vertices between which one tissue conducts: (Θ_j − Θ_i) w flows to i.
struct Conductance {
  std::uint32_t i = 0, j = 0, tissue = 0;
  double w = 0.0;  ///< [m]; below 0 between obtuse tets
};

/// Of all parts of a vertex at one temperature; conduction is their mean by volume.
struct VertexState {
  double heat = 0.0;      ///< [J]
  double capacity = 0.0;  ///< [J/K]
  double conductivity = 0.0;
};

class HeatBody {
 public:
  /// @throws std::invalid_argument where a region has no tissue
  HeatBody(const TetMesh& mesh, const std::map<int, ThermalTissue>& tissues);

  std::size_t size() const { return begin_.size() - 1; }
  std::span<const Part> parts(std::size_t vertex) const {
    return {parts_.data() + begin_[vertex], parts_.data() + begin_[vertex + 1]};
  }
  std::span<const Conductance> conductances() const { return conductances_; }
  const ThermalTissue& tissue(std::uint32_t number) const { return tissues_[number]; }
  std::uint32_t number_of(int region) const { return numbers_.at(region); }
  std::size_t tissues() const { return tissues_.size(); }
  double volume(std::size_t vertex) const;

  VertexState state(std::size_t vertex, double temperature) const;
  /// The temperature at which a vertex contains a heat; not finite where that is not. @param near  where the search begins [°C]
  double temperature_of(std::size_t vertex, double heat, double near) const;

 private:
  std::vector<ThermalTissue> tissues_;
  std::map<int, std::uint32_t> numbers_;
  std::vector<std::size_t> begin_;
  std::vector<Part> parts_;
  std::vector<Conductance> conductances_;
};

}  // namespace glisson::heat
