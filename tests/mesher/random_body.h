// random_body.h — random trees of shapes, by a seed: up to six regions, thin walls, tubes that end in others, touching balls.
#pragma once

#include <random>
#include <string>
#include <vector>

#include "glisson/implicit.h"

namespace glisson::test {

/// The same numbers on every machine: the standard library's distributions are not.
class RandomShapes {
 public:
  explicit RandomShapes(unsigned seed) : engine_(seed) {}

  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  int below(int n) { return static_cast<int>(between(0, n)); }
  Vec3d point(double size) {
    const double x = between(-size, size), y = between(-size, size), z = between(-size, size);
    return {x, y, z};
  }

  /// In a space two units across.
  Solid shape() {
    switch (below(10)) {
      case 0:
        return BallShape{point(1), between(0.25, 0.8)};
      case 1:
        return tube(2);
      case 2:
        return tube(4);
      case 3: {
        const Solid box = BoxShape{{}, {between(0.4, 1.6), between(0.4, 1.6), between(0.2, 1.6)}, 0.0};
        return box.placed({"", 1.0, point(1) + Vec3d{1.5, 0, 0}, between(0, 180), point(0.6)});
      }
      case 4:
        return TorusShape{point(0.4), point(1) + Vec3d{0, 0, 1.5}, between(0.4, 0.8), between(0.15, 0.35)};
      case 5:
        return EllipsoidShape{
            point(0.5), {between(0.3, 0.9), between(0.3, 0.9), between(0.3, 0.9)}, between(2, 6), between(2, 6)};
      case 6:
        return CylinderShape{point(0.3) - Vec3d{0, 0, 0.5}, point(0.3) + Vec3d{0, 0, 0.5}, between(0.3, 0.7), 0.0};
      case 7:  // a shell, open or closed
        return subtract(BallShape{{}, 0.9}, {Solid(BallShape{point(0.3), between(0.4, 0.7)})});
      case 8:  // touching balls
        return unite({BallShape{{-0.5, 0, 0}, 0.5}, BallShape{{0.5, 0, 0}, 0.5}}, between(0, 0.1));
      default:
        return unite({BallShape{point(0.6), between(0.3, 0.6)}, tube(3)}, between(0, 0.3));
    }
  }

  /// One to six regions in the order of precedence; now and then one is a hole.
  std::vector<BodyRegion> body() {
    const int count = 1 + below(6);
    std::vector<BodyRegion> regions;
    for (int i = 0; i < count; ++i) {
      const Solid solid = i + 1 < count ? shape() : unite({shape(), shape()}, between(0, 0.3));
      regions.push_back(region_of("region " + std::to_string(i), solid, count > 2 && i == 1 && below(5) == 0));
    }
    return regions;
  }

 private:
  Solid tube(int points) {
    TubeShape t;
    for (int i = 0; i < points; ++i) t.points.push_back({point(1), between(0.12, 0.35)});
    return t;
  }

  std::mt19937 engine_;
};

}  // namespace glisson::test
