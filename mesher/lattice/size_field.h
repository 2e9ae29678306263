// size_field.h — the length of edges asked for at each point of a body (glisson/mesh_size.h).
#pragma once

#include <optional>
#include <vector>

#include "glisson/region_mesh.h"
#include "mesher/lattice/curvature_sizes.h"

namespace glisson::lattice {

class RegionFields;

class SizeField {
 public:
  /// @throws std::invalid_argument  naming the size, its member and value, and the way out
  SizeField(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options);

  /// Looks in a body for the shortest edge that a function of a point asks for. Where there is one, it goes before finest() and uniform().
  /// @throws std::invalid_argument  a value that is not allowed, or more than max_tets
  void find_finest(const RegionFields& fields, std::size_t max_tets);

  /// Edge asked for at p [m].
  double at(const Vec3d& p) const;
  /// The same edge everywhere.
  bool uniform() const { return finest_ >= edge_; }
  double coarsest() const { return edge_; }  ///< [m]
  double finest() const { return finest_; }  ///< [m]

 private:
  /// A size whose names have been looked up.
  struct Place {
    const BodyRegion* region = nullptr;
    bool surface = false;
    std::vector<Vec3d> path;
    std::optional<SizePoints> curvature;
    double edge = 0.0, within = 0.0;  ///< [m]
  };
  static double distance(const Place& place, const Vec3d& p);
  /// What the function asks for at p [m]. @throws std::invalid_argument  where that is not allowed
  double free_size(const Vec3d& p) const;

  double edge_, finest_, growth_;
  std::vector<Place> places_;
  std::function<double(const Vec3d&)> free_;
};

}  // namespace glisson::lattice
