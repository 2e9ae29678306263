// free_size.cpp — the shortest edge that a function of a point asks for in a body.
//
// The lattice is made of halves, quarters … of one cube, so that its finest cube has to be known before. Cubes of the longest edge are
// halved where the function asks for less than theirs at the centre or a corner, as those of the lattice will be.
#include <algorithm>
#include <cmath>

#include "mesher/lattice/body_lattice.h"
#include "mesher/lattice/region_fields.h"

namespace glisson::lattice {
namespace {

constexpr double kFineEnough = 0.71;  ///< of a cube's edge: the least asked for in it

class FinestSearch {
 public:
  FinestSearch(const RegionFields& fields, std::size_t max_tets)
      : fields_(fields), sizes_(fields.sizes()), max_tets_(max_tets), finest_(sizes_.finest()) {}

  double run() {
    const auto [low, high] = fields_.bounds();
    const double side = cube_side(sizes_.coarsest());
    std::array<int, 3> n{};
    Vec3d first{};
    double roots = 1.0;
    for (std::size_t d = 0; d < 3; ++d) {
      const double count = std::ceil((high[d] - low[d]) / side);
      if ((roots *= count) > kMostRoots) return finest_;  // the lattice refuses them
      n[d] = static_cast<int>(count);
      first[d] = 0.5 * (low[d] + high[d] - (count - 1.0) * side);
    }
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        for (int i = 0; i < n[0]; ++i) look(first + Vec3d{1.0 * i, 1.0 * j, 1.0 * k} * side, 0.5 * side);
      }
    }
    return finest_;
  }

 private:
  static constexpr double kMostRoots = 2e7;

  static Vec3d corner(const Vec3d& centre, int c, double half) {
    return centre + Vec3d{c & 1 ? half : -half, c & 2 ? half : -half, c & 4 ? half : -half};
  }

  void look(const Vec3d& centre, double half) {
    if (!fields_.reached(centre, half)) return;
    double least = sizes_.at(centre);
    for (int c = 0; c < 8; ++c) least = std::min(least, sizes_.at(corner(centre, c, half)));
    finest_ = std::min(finest_, least);
    if (least < kFineEnough * kMeanEdge * 2.0 * half) {
      for (int c = 0; c < 8; ++c) look(corner(centre, c, 0.5 * half), 0.5 * half);
    } else if (fields_.filled(fields_.label(centre))) {
      tets_ += 12.0;
      if (tets_ > static_cast<double>(max_tets_)) refuse_more_than(sizes_.coarsest(), finest_, max_tets_);
    }
  }

  const RegionFields& fields_;
  const SizeField& sizes_;
  std::size_t max_tets_;
  double finest_, tets_ = 0.0;
};

}  // namespace

void SizeField::find_finest(const RegionFields& fields, std::size_t max_tets) {
  if (free_) finest_ = FinestSearch(fields, max_tets).run();
}

}  // namespace glisson::lattice
