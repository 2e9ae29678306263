// implicit.h — bodies from shapes: a tree of balls, boxes, tubes … that are joined, cut and blended.
//
//   Solid liver = unite({ellipsoid, lobe}, 0.01);          // blended over 10 mm
//   RegionMesh made = mesh_regions({{"tumour", ball}, {"parenchyma", liver}}, {.edge = 0.004});
//
// A shape is its signed distance: negative inside, positive outside. Outside it never exceeds the true distance, and near the
// surface it equals it, so that a mesher can skip the space that is farther away.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "glisson/field.h"
#include "glisson/math.h"
#include "glisson/region_mesh.h"

namespace glisson {

struct BallShape {
  static constexpr std::string_view kName = "ball";
  Vec3d center{};        ///< [m]
  double radius = 0.01;  ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("center", &BallShape::center, "mm", "centre"),
                field("radius", &BallShape::radius, "mm", above(0), "radius").must());
  }
};

/// The body  ((|x/a|^m + |y/b|^m)^(n/m) + |z/c|^n)^(1/n) ≤ 1;  m = n = 2 is an ellipsoid, large exponents come near to a
/// cylinder or a box.                                                                                     [Barr1981]
struct EllipsoidShape {
  static constexpr std::string_view kName = "ellipsoid";
  Vec3d center{};                              ///< [m]
  Vec3d semi_axes{0.02, 0.015, 0.01};          ///< a, b, c [m]
  double exponent_xy = 2.0, exponent_z = 2.0;  ///< m and n [-], 2 or more: convex and without edges

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = EllipsoidShape;
    return take(field("center", &S::center, "mm", "centre"),
                field("semi_axes", &S::semi_axes, "mm", above(0), "half the lengths along x, y and z").must(),
                field("exponent_xy", &S::exponent_xy, "-", between(2, 20), "of its sections across z")
                    .advise("2 is an ellipse, 20 nearly a rectangle"),
                field("exponent_z", &S::exponent_z, "-", between(2, 20), "of its sections along z")
                    .advise("2 is an ellipse, 20 nearly a rectangle"));
  }
};

struct BoxShape {
  static constexpr std::string_view kName = "box";
  Vec3d center{};                ///< [m]
  Vec3d size{0.02, 0.02, 0.02};  ///< edge lengths [m]
  double rounding = 0.0;         ///< radius of its edges [m], at most half the shortest side

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("center", &BoxShape::center, "mm", "centre"),
                field("size", &BoxShape::size, "mm", above(0), "edge lengths").must(),
                field("rounding", &BoxShape::rounding, "mm", at_least(0), "radius of its edges"));
  }
  Fault check() const;
};

struct CylinderShape {
  static constexpr std::string_view kName = "cylinder";
  Vec3d from{}, to{0.0, 0.0, 0.02};  ///< centres of its ends [m]
  double radius = 0.01;              ///< [m]
  double rounding = 0.0;             ///< radius of its edges [m], at most the radius and half the height

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = CylinderShape;
    return take(field("from", &S::from, "mm", "centre of one end").must(),
                field("to", &S::to, "mm", "centre of the other end").must(),
                field("radius", &S::radius, "mm", above(0), "radius").must(),
                field("rounding", &S::rounding, "mm", at_least(0), "radius of its edges"));
  }
  Fault check() const;
};

/// A point of a tube's axis and the radius there.
struct TubePoint {
  Vec3d at{};             ///< [m]
  double radius = 0.002;  ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("at", &TubePoint::at, "mm", "the point").must(),
                field("radius", &TubePoint::radius, "mm", above(0), "radius there").must());
  }
};

/// A tube along a smooth line through points (a centripetal Catmull–Rom spline), its radius linear between them, its ends
/// round.                                                                                  [YukselSchaeferKeyser2011]
struct TubeShape {
  static constexpr std::string_view kName = "tube";
  std::vector<TubePoint> points;  ///< two or more

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("points", &TubeShape::points, "the points, two or more").must());
  }
  Fault check() const;
};

struct TorusShape {
  static constexpr std::string_view kName = "torus";
  Vec3d center{};              ///< [m]
  Vec3d axis{0.0, 0.0, 1.0};   ///< of any length
  double radius = 0.02;        ///< of its middle line [m]
  double tube_radius = 0.005;  ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = TorusShape;
    return take(field("center", &S::center, "mm", "centre"),
                field("axis", &S::axis, "-", "axis of symmetry, of any length").direction(),
                field("radius", &S::radius, "mm", above(0), "radius of the line in its middle").must(),
                field("tube_radius", &S::tube_radius, "mm", above(0), "radius about that line").must());
  }
};

/// All on one side of a plane; for cutting others.
struct HalfSpaceShape {
  static constexpr std::string_view kName = "half_space";
  Vec3d point{};                ///< of the plane [m]
  Vec3d normal{0.0, 0.0, 1.0};  ///< out of the half space, of any length

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("point", &HalfSpaceShape::point, "mm", "a point of the plane"),
                field("normal", &HalfSpaceShape::normal, "-", "points out of the half space").direction().must());
  }
};

/// Shapes joined; a blend rounds the groove between them.
struct UnionShape {
  static constexpr std::string_view kName = "union";
  std::vector<std::string> of;  ///< names of earlier shapes, one or more
  double blend = 0.0;           ///< distance over which the groove is filled [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("of", &UnionShape::of, "names of the shapes, each defined before").must(),
                field("blend", &UnionShape::blend, "mm", at_least(0), "distance over which the groove is filled"));
  }
};

/// What two or more shapes share; a blend rounds the edge.
struct IntersectionShape {
  static constexpr std::string_view kName = "intersection";
  std::vector<std::string> of;  ///< names of earlier shapes, one or more
  double blend = 0.0;           ///< distance over which the edge is rounded [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(
        field("of", &IntersectionShape::of, "names of the shapes, each defined before").must(),
        field("blend", &IntersectionShape::blend, "mm", at_least(0), "distance over which the edge is rounded"));
  }
};

/// The first shape without the others; a blend rounds the edge.
struct DifferenceShape {
  static constexpr std::string_view kName = "difference";
  std::vector<std::string> of;  ///< names of earlier shapes, two or more
  double blend = 0.0;           ///< distance over which the edge is rounded [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("of", &DifferenceShape::of, "the shape, and those taken out of it, each defined before").must(),
                field("blend", &DifferenceShape::blend, "mm", at_least(0), "distance over which the edge is rounded"));
  }
};

/// A shape scaled, turned about the origin and moved, in this order.
struct PlacedShape {
  static constexpr std::string_view kName = "placed";
  std::string of;             ///< name of an earlier shape
  double scale = 1.0;         ///< [-]
  Vec3d axis{0.0, 0.0, 1.0};  ///< of the rotation, of any length
  double angle_deg = 0.0;     ///< of the rotation, right-handed
  Vec3d move{};               ///< [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    using S = PlacedShape;
    return take(field("of", &S::of, "name of the shape, defined before").must(),
                field("scale", &S::scale, "-", above(0), "factor on its size, about the origin"),
                field("axis", &S::axis, "-", "axis of its rotation, through the origin").direction(),
                field("angle_deg", &S::angle_deg, "angle of its rotation in degrees, right-handed"),
                field("move", &S::move, "mm", "displacement after that"));
  }
};

/// A signed distance with its box. Copies share the tree.
class Solid {
 public:
  class Node;
  explicit Solid(std::shared_ptr<const Node> node) : node_(std::move(node)) {}

  // @throws std::invalid_argument naming the member that is not allowed
  Solid(const BallShape& shape);       // NOLINT(google-explicit-constructor): a shape is written where one is needed
  Solid(const EllipsoidShape& shape);  // NOLINT(google-explicit-constructor)
  Solid(const BoxShape& shape);        // NOLINT(google-explicit-constructor)
  Solid(const CylinderShape& shape);   // NOLINT(google-explicit-constructor)
  Solid(const TubeShape& shape);       // NOLINT(google-explicit-constructor)
  Solid(const TorusShape& shape);      // NOLINT(google-explicit-constructor)
  Solid(const HalfSpaceShape& shape);  // NOLINT(google-explicit-constructor)
  /// Any function: negative inside, outside at most the distance [m], of its size near the surface.
  Solid(std::function<double(const Vec3d&)> distance, const Bounds& bounds);

  /// [m]; negative inside
  double distance(const Vec3d& point) const;
  /// Holds the whole shape [m]; infinite where the shape is.
  const Bounds& bounds() const;

  Solid placed(const PlacedShape& place) const;  ///< `place.of` is not looked at
  std::shared_ptr<const Node> node() const { return node_; }

 private:
  std::shared_ptr<const Node> node_;
};

/// @param blend  distance over which the groove or edge is rounded [m]; the result is min(a, b) − h²/(4 blend),
///               h = max(0, blend − |a − b|), and its mirror images
/// @throws std::invalid_argument  no shape, or a blend that is negative or not finite
Solid unite(const std::vector<Solid>& shapes, double blend = 0.0);
Solid intersect(const std::vector<Solid>& shapes, double blend = 0.0);
/// `shape` without the others.
Solid subtract(const Solid& shape, const std::vector<Solid>& others, double blend = 0.0);

/// The body within a closed surface of triangles from a file (glisson/surface_region.h, load_surface in glisson/scene/surface_file.h).
struct SurfaceShape {
  static constexpr std::string_view kName = "surface";
  std::filesystem::path path;  ///< the file that it is from
  double scale = 1.0;          ///< factor on coordinates [-], > 0
  std::optional<Solid> solid;  ///< what the file holds
  std::string repaired{};  ///< what was done to close it, with the file's name (SurfaceRepair::text); empty: nothing
};

/// A region of an implicit body.
BodyRegion region_of(const std::string& name, const Solid& shape, bool hole = false);

/// A shape with a name, as a scene has it.
struct NamedShape {
  std::string name;
  std::variant<BallShape, EllipsoidShape, BoxShape, CylinderShape, TubeShape, TorusShape, HalfSpaceShape, SurfaceShape,
               UnionShape, DifferenceShape, IntersectionShape, PlacedShape>
      what;
};

/// A region of a body and the shape that it fills, as far as no earlier region does.
struct ShapeRegion {
  std::string name;
  std::string shape;  ///< name of a shape; empty: the region's own
  bool hole = false;  ///< stays empty

  template <class Take>
  static constexpr auto fields(Take take) {
    using R = ShapeRegion;
    return take(field("name", &R::name, "name; `[[region]]` gives it a tissue").must(),
                field("shape", &R::shape, "name of the shape that it fills, as far as no earlier region does")
                    .otherwise("the region's name"),
                field("hole", &R::hole, "it stays empty"));
  }
};

/// A body of shapes, and how fine its mesh is.
struct ImplicitBody {
  std::vector<NamedShape> shapes;    ///< each refers to earlier ones only
  std::vector<ShapeRegion> regions;  ///< by precedence, the first over all others
  double edge = 0.005;               ///< mean length of edges [m], > 0
  std::uint64_t max_tets = 5000000;  ///< more are refused
  std::vector<MeshSize> sizes{};     ///< where edges are shorter
  double growth = kGrowth;           ///< edge over distance at which edges grow away from these [-]

  template <class Take>
  static constexpr auto fields(Take take) {
    using B = ImplicitBody;
    return take(field("shapes", &B::shapes, "the shapes").keyed("shape"),
                field("regions", &B::regions, "the regions, by precedence").keyed("region"), edge_field<B>(),
                max_tets_field<B>(), sizes_field<B>(), growth_field<B>());
  }
};

/// What is wrong with the names in a body, and in which shape, region or size; nothing where `what` is empty.
struct BodyFault {
  std::string what;
  std::string_view list = "shape";  ///< or "region", "size"
  std::size_t index = 0;
  std::string key;
};
BodyFault check_names(const ImplicitBody& body);

/// The regions of a body. @throws std::invalid_argument naming shape, member, value and the way out
std::vector<BodyRegion> regions_of(const ImplicitBody& body);

/// Its mesh. @throws as regions_of and mesh_regions
RegionMesh implicit_mesh(const ImplicitBody& body, std::function<bool(double)> progress = {});

/// The edge that a body asks for in each tet of a mesh, at its centre [m]. @throws as regions_of and mesh_regions
std::vector<double> edges_asked(const TetMesh& mesh, const ImplicitBody& body);

}  // namespace glisson
