// Shapes as signed distances: exact where they can be, never more than the distance outside, inside their boxes.
#include "glisson/implicit.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "random_body.h"

namespace glisson {
namespace {

using test::RandomShapes;
using testing::AllOf;
using testing::HasSubstr;

// Distances of simple shapes, at points where they can be told at once.
TEST(Solid, HasExactDistances) {
  EXPECT_DOUBLE_EQ(Solid(BallShape{{1, 0, 0}, 2}).distance({4, 4, 0}), 3.0);
  const Solid box = BoxShape{{}, {2, 4, 6}};
  EXPECT_DOUBLE_EQ(box.distance({1 + 3, 2 + 4, 0}), 5.0);
  EXPECT_DOUBLE_EQ(box.distance({0.5, 0, 0}), -0.5);
  const Solid cylinder = CylinderShape{{0, 0, -1}, {0, 0, 1}, 2};
  EXPECT_DOUBLE_EQ(cylinder.distance({2 + 3, 0, 1 + 4}), 5.0);
  EXPECT_DOUBLE_EQ(cylinder.distance({0, 0, 0.5}), -0.5);
  EXPECT_NEAR(Solid(TorusShape{{}, {0, 0, 2}, 5, 1}).distance({5, 0, 3}), 2.0, 1e-15);
  EXPECT_DOUBLE_EQ(Solid(HalfSpaceShape{{0, 0, 1}, {0, 0, 3}}).distance({9, 9, 4}), 3.0);
  EXPECT_NEAR(Solid(EllipsoidShape{{}, {3, 2, 1}}).distance({0, 0, 4}), 3.0, 1e-15);
  EXPECT_NEAR(Solid(EllipsoidShape{{}, {3, 2, 1}}).distance({0, 0, 0}), -1.0, 1e-15);
  // Between two balls of radius 1 and 2 at a distance of 2: the cone's slope is a half, so the ball that sees a point at
  // height 1 and distance 3 has its centre √3/2 · … further: checked against the envelope of balls.
  const Solid tube = TubeShape{{{{0, 0, 0}, 1}, {{0, 0, 2}, 2}}};
  for (const Vec3d& p : {Vec3d{3, 0, 1}, Vec3d{0, 5, -1}, Vec3d{0, 2.5, 2}, Vec3d{0.5, 0, 1}}) {
    double least = 1e9;
    for (int i = 0; i <= 20000; ++i) {
      const double t = i / 20000.0;
      least = std::min(least, norm(p - Vec3d{0, 0, 2 * t}) - (1 + t));
    }
    EXPECT_NEAR(tube.distance(p), least, 1e-7);
  }
}

/// A shape, and its distance from a tree that leaves nothing out.
struct WholeTree {
  Solid solid;
  std::function<double(const Vec3d&)> distance;
};

double blended_whole(double a, double b, double blend) {
  const double h = blend - std::abs(a - b);
  return std::min(a, b) - (h > 0.0 ? h * h / (4.0 * blend) : 0.0);
}

/// A distance, outside a box at least that from the box.
double outside_box(const Bounds& box, const Vec3d& p, double value) {
  Vec3d out{};
  for (std::size_t d = 0; d < 3; ++d) out[d] = std::max({box.min[d] - p[d], p[d] - box.max[d], 0.0});
  return value > 0.0 ? std::max(value, norm(out)) : value;
}

/// Two to five random trees combined, at the depth 0 a simple shape.
WholeTree random_tree(RandomShapes& random, int depth) {
  if (depth == 0) {
    const Solid leaf = random.shape();
    return {leaf, [leaf](const Vec3d& p) { return leaf.distance(p); }};
  }
  std::vector<WholeTree> parts;
  for (int i = 2 + random.below(4); i > 0; --i) parts.push_back(random_tree(random, random.below(depth)));
  const double blend = random.below(3) == 0 ? 0.0 : random.between(0, 0.4);
  std::vector<Solid> solids;
  for (const WholeTree& part : parts) solids.push_back(part.solid);
  const int kind = random.below(3);
  const Solid solid = kind == 0   ? unite(solids, blend)
                      : kind == 1 ? intersect(solids, blend)
                                  : subtract(solids[0], {solids.begin() + 1, solids.end()}, blend);
  const Vec3d move = random.point(0.3);
  const Solid placed = solid.placed({"", 1.0, {0, 0, 1}, 0.0, move});
  return {placed, [=](const Vec3d& q) {
            const Vec3d p = q - move;
            double value = parts[0].distance(p);
            for (std::size_t i = 1; i < parts.size(); ++i) {
              const double other = parts[i].distance(p);
              value = kind == 0 ? blended_whole(value, other, blend)
                                : -blended_whole(-value, kind == 1 ? -other : other, blend);
            }
            return outside_box(placed.bounds(), q, outside_box(solid.bounds(), p, value));
          }};
}

// What a tree leaves out, as too far off or too deep inside to matter, changes no bit of a distance.
TEST(Solid, LeavesOutNothingThatMatters) {
  RandomShapes random(11);
  for (int i = 0; i < 300; ++i) {
    const WholeTree tree = random_tree(random, 3);
    for (int j = 0; j < 300; ++j) {
      const Vec3d p = random.point(1.5);
      ASSERT_EQ(tree.solid.distance(p), tree.distance(p)) << "tree " << i << ", point " << j;
    }
  }
}

// The blend of two surfaces at a right angle: on the bisector both are at the same distance, and the blend fills b/4 more.
TEST(Solid, BlendsByAQuarter) {
  const Solid a = HalfSpaceShape{{}, {1, 0, 0}}, b = HalfSpaceShape{{}, {0, 1, 0}};
  EXPECT_DOUBLE_EQ(unite({a, b}, 0.4).distance({0.3, 0.3, 0}), 0.3 - 0.1);
  EXPECT_DOUBLE_EQ(intersect({a, b}, 0.4).distance({0.3, 0.3, 0}), 0.3 + 0.1);
  EXPECT_DOUBLE_EQ(subtract(a, {b}, 0.4).distance({-0.3, 0.3, 0}), -0.3 + 0.1);
  EXPECT_DOUBLE_EQ(unite({a, b}, 0.4).distance({0.3, 0.8, 0}), 0.3);  // further apart than the blend
}

// Placed shapes are scaled, turned and moved, in this order, and distances scale with them.
TEST(Solid, IsPlaced) {
  const Solid box = Solid(BoxShape{{1, 0, 0}, {2, 2, 2}}).placed({"", 2.0, {0, 0, 1}, 90.0, {10, 0, 0}});
  EXPECT_NEAR(box.distance({10, 2, 0}), -2.0, 1e-12);  // its centre
  EXPECT_NEAR(box.distance({10, 7, 0}), 3.0, 1e-12);
  EXPECT_NEAR(box.bounds().max.y, 4.0, 1e-12);
  EXPECT_NEAR(box.bounds().min.x, 8.0, 1e-12);
}

// Random shapes: inside their boxes; outside, the ball of the distance about a point holds no point of the shape, so that a
// mesher may skip it; and where all is smooth the slope near the surface is 1 to some percent (ellipsoids and blends less).
TEST(Solid, CanBeTrustedOutside) {
  RandomShapes random(5);
  for (int i = 0; i < 300; ++i) {
    const Solid solid = random.shape();
    for (int j = 0; j < 200; ++j) {
      const Vec3d p = random.point(2.5), q = random.point(2.5);
      const double at_p = solid.distance(p), at_q = solid.distance(q);
      ASSERT_TRUE(std::isfinite(at_p));
      if (at_q < 0.0) {
        const Bounds& b = solid.bounds();
        for (std::size_t d = 0; d < 3; ++d) {
          EXPECT_GE(q[d], b.min[d]);
          EXPECT_LE(q[d], b.max[d]);
        }
        if (at_p > 0.0) {
          EXPECT_LE(at_p, norm(p - q) * (1.0 + 1e-12));
        }
      }
    }
  }
}

// Boxes that let far parts be skipped change no bit of the distance: a union with its parts in any order of nearness.
TEST(Solid, IsPrunedWithoutChange) {
  RandomShapes random(9);
  for (int i = 0; i < 50; ++i) {
    const Solid a = random.shape(), b = random.shape(), c = random.shape();
    const double blend = random.between(0.01, 0.4);
    const Solid joined = unite({a, b, c}, blend);
    const auto min = [&](double x, double y) {
      const double h = blend - std::abs(x - y);
      return std::min(x, y) - (h > 0.0 ? h * h / (4.0 * blend) : 0.0);
    };
    for (int j = 0; j < 100; ++j) {
      const Vec3d p = random.point(3);
      EXPECT_EQ(joined.distance(p), min(min(a.distance(p), b.distance(p)), c.distance(p)));
    }
  }
}

std::string refusal(const ImplicitBody& body) {
  try {
    regions_of(body);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

// Names that do not fit and values that are not allowed are named, with the way out.
TEST(ImplicitBody, RefusesWhatDoesNotFit) {
  const NamedShape ball{"ball", BallShape{{}, 0.01}};
  EXPECT_THAT(refusal({{ball, ball}, {{"ball", "", false}}}), HasSubstr("name of an earlier shape"));
  EXPECT_THAT(refusal({{ball, {"all", UnionShape{{"bal"}, 0.0}}}, {{"all", "", false}}}),
              HasSubstr("did you mean \"ball\"?"));
  EXPECT_THAT(refusal({{ball, {"all", DifferenceShape{{"ball"}, 0.0}}}, {{"all", "", false}}}),
              HasSubstr("at least one"));
  EXPECT_THAT(refusal({{ball}, {{"body", "box", false}}}), AllOf(HasSubstr("region 0"), HasSubstr("no shape \"box\"")));
  EXPECT_THAT(refusal({{ball}, {{"ball", "", false}, {"ball", "", false}}}), HasSubstr("name of an earlier region"));
  EXPECT_THAT(refusal({{{"ball", BallShape{{}, -1}}}, {{"ball", "", false}}}),
              AllOf(HasSubstr("\"ball\""), HasSubstr("radius")));
  EXPECT_THAT(refusal({{{"half", HalfSpaceShape{}}}, {{"half", "", false}}}), HasSubstr("reaches to infinity"));
  EXPECT_THAT(refusal({{{"box", BoxShape{{}, {1, 1, 1}, 0.6}}}, {{"box", "", false}}}), HasSubstr("rounding"));
  EXPECT_THAT(refusal({{{"tube", TubeShape{{{{}, 1}}}}}, {{"tube", "", false}}}), HasSubstr("two points or more"));
}

}  // namespace
}  // namespace glisson
