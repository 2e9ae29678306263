#include "lab/layer_mesh.h"

#include <algorithm>
#include <cmath>

namespace glisson::lab {
namespace {

constexpr double kHalfSpace = 1000.0;              ///< where a half-space ends, in radii of contact: 1e-3 of the force
constexpr double kWide = 8.0;                      ///< where a wide layer ends beyond the contact, in its thickness
constexpr double kReach = 1.15;                    ///< of even elements, in radii of contact at the deepest
constexpr double kAcross = 8.0;                    ///< elements over the contact
constexpr double kEdge = 20.0;                     ///< of a flat punch: its radius over the smallest element
constexpr double kRounding = 3.0;                  ///< elements over its rounded edge
constexpr double kGrowth = 0.8, kFarGrowth = 1.5;  ///< by which an element is larger than the one before

/// Sizes of elements from `first` on, each larger than the one before it, that fill a length. Beyond `near`, where displacements
/// are as smooth as those of a point force, they grow faster.
std::vector<double> growing(double first, double near, double length, double fineness) {
  std::vector<double> sizes;
  double filled = 0.0;
  for (double size = first; filled < length;) {
    sizes.push_back(size), filled += size;
    size *= 1.0 + (filled < near ? kGrowth : kFarGrowth) / fineness;
  }
  for (double& size : sizes) size *= length / filled;
  return sizes;
}

/// The smallest element of a flat punch, at its edge.
double edge_size(const Indenter& indenter, double contact, double fineness) {
  const double even = contact / kEdge;
  return (indenter.sharp() ? even : std::min(even, indenter.edge_radius / kRounding)) / fineness;
}

std::vector<double> radial_sizes(const Indenter& indenter, double contact, double end, double fineness) {
  std::vector<double> sizes;
  double outward = 0.0;
  if (indenter.shape == IndenterShape::flat) {
    outward = edge_size(indenter, contact, fineness);
    sizes = growing(outward, contact, contact, fineness);
    std::reverse(sizes.begin(), sizes.end());
  } else {
    const auto count = static_cast<std::size_t>(std::ceil(kAcross * fineness));
    sizes.assign(count, contact / static_cast<double>(count));
    outward = 1.5 * sizes.back();
  }
  if (end > contact * (1.0 + 1e-9)) {
    const std::vector<double> rest = growing(outward, contact, end - contact, fineness);
    sizes.insert(sizes.end(), rest.begin(), rest.end());
  }
  return sizes;
}

}  // namespace

std::shared_ptr<const MeridianMesh> layer_mesh(const Layer& layer, const Indenter& indenter, double deepest,
                                               double fineness) {
  const bool flat = indenter.shape == IndenterShape::flat;
  const double contact = std::min((flat ? 1.0 : kReach) * contact_radius(indenter, deepest), layer.radius);
  const double height = layer.thick() ? kHalfSpace * contact : layer.thickness;
  const double wide = layer.thick() ? height : contact + kWide * std::max(height, contact);
  const double end = layer.wide() ? std::min(wide, kHalfSpace * contact) : layer.radius;
  const double first = flat ? 2.0 * edge_size(indenter, contact, fineness) : contact / (0.75 * kAcross * fineness);
  std::vector<double> down = growing(std::min(first, height / (2.0 * fineness)), 2.0 * contact, height, fineness);
  std::reverse(down.begin(), down.end());
  return std::make_shared<MeridianMesh>(ends_and_middles(radial_sizes(indenter, contact, end, fineness), end),
                                        ends_and_middles(down, height));
}

}  // namespace glisson::lab
