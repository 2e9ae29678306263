// graded_lattice.cpp — body-centred tets in the cubes of an octree.
//
// Between the centres C, D of two cubes of one size, tets are those of body_lattice.cpp; where a smaller cube has its corner M
// in the middle of an edge P–Q, the tet C D P Q is cut in two there. A cube with four smaller ones on its face has eight tets to
// that face, a smaller one two tets to its quarter of it:
//
//      Q-----M-----o        The face of the large cube, seen along its normal: F its middle, M those of its edges.
//      | \   |   / |          large cube, centre C: C F P M, C F M Q, … about F
//      |   \ | /   |          small cube, centre c: c P M F, c P F M', its quarter cut along F–P
//      M-----F-----o
//      |   / | \   |        Dihedral angles are 45° to 120° there, 60° and 90° elsewhere [LabelleShewchuk2007, §4].
//      | /   |   \ |
//      P-----M'----o
#include "mesher/lattice/graded_lattice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "base/text.h"
#include "mesher/lattice/body_lattice.h"
#include "mesher/lattice/cell_octree.h"

namespace glisson::lattice {
namespace {

constexpr double kMostRoots = 2e7;
constexpr double kTooCoarse = 0.55;  ///< of a cube's edge: no smaller edge is asked for at its centre and corners
const double kMeanTetEdge =
    (1.0 + std::sqrt(3.0)) / 3.0;  ///< mean length of a lattice tet's edges over the cube's side

/// Twice the coordinates in finest cubes, so that centres are whole numbers.
using Point = std::array<int, 3>;

class GradedLattice {
 public:
  GradedLattice(const RegionFields& fields, const SizeField& sizes, std::size_t max_tets, TetComplex& complex)
      : fields_(fields), sizes_(sizes), max_tets_(max_tets), complex_(complex), side_(cube_side(sizes.finest())),
        tree_(place()) {}

  void fill() {
    for (std::uint32_t root = 0; root < tree_.root_count(); ++root) refine(root);
    tree_.balance();
    const std::vector<std::uint32_t> leaves = tree_.leaves();
    std::size_t inside = 0;
    for (const std::uint32_t leaf : leaves) inside += mark_vertices(tree_.cell(leaf));
    refuse_too_many(sizes_.coarsest(), sizes_.finest(), 6.0 * static_cast<double>(inside), max_tets_);
    for (const std::uint32_t leaf : leaves) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (const int sign : {-1, 1}) add_face(tree_.cell(leaf), axis, sign);
      }
    }
    set_edges();
  }

 private:
  static constexpr std::uint32_t kUnused = ~0u;
  struct Vertex {
    std::uint32_t number = kUnused;
    bool inside = false;
  };

  /// Where the lattice lies, and its largest cubes.
  CellOctree place() {
    const Bounds box = fields_.bounds();
    const int level = std::max(0, static_cast<int>(std::floor(std::log2(sizes_.coarsest() / sizes_.finest()) + 0.5)));
    const double root = side_ * (1 << level);
    Point n{};
    for (std::size_t d = 0; d < 3; ++d) {
      const double extent = box.max[d] - box.min[d], count = std::ceil(extent / root - 1e-9) + 2.0;
      if (!(count * (1 << level) < 1 << 19)) {
        refuse_short_edge(sizes_.finest(), extent);
      }
      n[d] = static_cast<int>(count);
      origin_[d] = 0.5 * (box.min[d] + box.max[d]) - 0.5 * count * root;
    }
    if (static_cast<double>(n[0]) * n[1] * n[2] > kMostRoots) {
      refuse_short_edge(sizes_.coarsest(),
                        std::max({box.max.x - box.min.x, box.max.y - box.min.y, box.max.z - box.min.z}));
    }
    return CellOctree(n, level);
  }

  Vec3d position(const Point& p) const {
    return origin_ +
           Vec3d{static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])} * (0.5 * side_);
  }
  static Point corner(const OctreeCell& cell, int c) {
    Point p{};
    for (std::size_t d = 0; d < 3; ++d) p[d] = 2 * (cell.low[d] + ((c >> d) & 1) * cell.side());
    return p;
  }
  static Point centre(const OctreeCell& cell) {
    Point p{};
    for (std::size_t d = 0; d < 3; ++d) p[d] = 2 * cell.low[d] + cell.side();
    return p;
  }

  /// Whether edges in a cube are longer than asked for by more than √2 in its middle, or by nearly 2 anywhere.
  bool too_coarse(const OctreeCell& cell) const {
    const double edge = kMeanEdge * side_ * cell.side();
    if (sizes_.at(position(centre(cell))) < std::sqrt(0.5) * edge) return true;
    for (int c = 0; c < 8; ++c) {
      if (sizes_.at(position(corner(cell, c))) < kTooCoarse * edge) return true;
    }
    return false;
  }

  void refine(std::uint32_t index) {
    const OctreeCell cell = tree_.cell(index);
    const Vec3d middle = position(centre(cell));
    if (!fields_.reached(middle, 0.5 * side_ * cell.side())) return;
    if (cell.level > 0 && too_coarse(cell)) {
      tree_.split(index);
      for (std::uint32_t c = 0; c < 8; ++c) refine(tree_.cell(index).children + c);
      return;
    }
    if (!fields_.filled(fields_.label(middle))) return;
    tets_ += 12.0;
    if (tets_ > static_cast<double>(max_tets_)) refuse_more_than(sizes_.coarsest(), sizes_.finest(), max_tets_);
  }

  static std::uint64_t key(const Point& p) {
    return (static_cast<std::uint64_t>(p[0]) << 42) | (static_cast<std::uint64_t>(p[1]) << 21) |
           static_cast<std::uint64_t>(p[2]);
  }

  /// @return how many vertices in a region are new
  std::size_t mark_vertices(const OctreeCell& cell) {
    std::size_t inside = 0;
    for (int c = 0; c < 9; ++c) {
      const Point p = c < 8 ? corner(cell, c) : centre(cell);
      const auto [at, is_new] = vertices_.try_emplace(key(p));
      if (is_new) at->second.inside = fields_.filled(fields_.label(position(p)));
      inside += is_new && at->second.inside;
    }
    return inside;
  }

  bool split_at(const Point& at, int level) const {
    const std::uint32_t index = tree_.find(at, level);
    return index != CellOctree::kNowhere && !tree_.cell(index).leaf();
  }

  /// The tets of a cube to one of its faces.
  void add_face(const OctreeCell& cell, std::size_t axis, int sign) {
    Point step{};
    step[axis] = sign;
    const Point beside = CellOctree::beside(cell, step);
    const std::uint32_t other = tree_.find(beside, cell.level);
    if (other == CellOctree::kNowhere) return;
    const OctreeCell next = tree_.cell(other);
    Face face{cell, axis, sign};
    if (next.level > cell.level) return add_quarter(face, next);
    if (!next.leaf()) return add_fan(face);
    if (sign > 0) add_joined(face, next);
  }

  /// A face of a cube: its middle, and its corners and edges' middles around that.
  struct Face {
    Point middle{};
    std::array<Point, 8> around{};   ///< corners at even places
    std::array<Point, 4> outward{};  ///< steps across the edges at odd places
    Point centre{};
    Point normal{};

    Face(const OctreeCell& cell, std::size_t axis, int sign) : centre(GradedLattice::centre(cell)) {
      const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
      static constexpr std::array<std::array<int, 2>, 8> kRound{
          {{-1, -1}, {0, -1}, {1, -1}, {1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}}};
      middle = centre;
      middle[axis] += sign * cell.side();
      normal[axis] = sign;
      for (std::size_t n = 0; n < 8; ++n) {
        around[n] = middle;
        around[n][b] += kRound[n][0] * cell.side();
        around[n][c] += kRound[n][1] * cell.side();
        if (n % 2 == 1) outward[n / 2][b] = kRound[n][0], outward[n / 2][c] = kRound[n][1];
      }
    }
  };

  /// Between the centres of cubes of one size.
  void add_joined(const Face& face, const OctreeCell& next) {
    const Point other = centre(next);
    for (std::size_t n = 0; n < 4; ++n) {
      const Point &p = face.around[2 * n], &m = face.around[2 * n + 1], &q = face.around[(2 * n + 2) % 8];
      const Point& across = face.outward[n];  // to the two other cubes at this edge
      Point back = across;
      for (std::size_t d = 0; d < 3; ++d) back[d] -= face.normal[d];
      if (split_at(CellOctree::beside(next, across), next.level) ||
          split_at(CellOctree::beside(next, back), next.level)) {
        add({face.centre, other, p, m});
        add({face.centre, other, m, q});
      } else {
        add({face.centre, other, p, q});
      }
    }
  }

  /// From a cube to the face that it has in common with four smaller ones.
  void add_fan(const Face& face) {
    for (std::size_t n = 0; n < 8; ++n) add({face.centre, face.middle, face.around[n], face.around[(n + 1) % 8]});
  }

  /// From a cube to its quarter of the face of a larger one.
  void add_quarter(const Face& face, const OctreeCell& large) {
    const Point far = centre(large);
    std::size_t f = 0;  // the corner in the middle of the large face: the nearest to the large centre
    const auto distance = [&](const Point& p) {
      int sum = 0;
      for (std::size_t d = 0; d < 3; ++d) sum += std::abs(p[d] - far[d]);
      return sum;
    };
    for (std::size_t n = 2; n < 8; n += 2) {
      if (distance(face.around[n]) < distance(face.around[f])) f = n;
    }
    const auto at = [&](std::size_t n) { return face.around[(f + n) % 8]; };
    add({face.centre, at(4), at(6), at(0)});
    add({face.centre, at(4), at(0), at(2)});
  }

  void add(std::array<Point, 4> corners) {
    std::array<Vertex*, 4> vertices{};
    bool any = false;
    for (std::size_t c = 0; c < 4; ++c) {
      vertices[c] = &vertices_.at(key(corners[c]));
      any = any || vertices[c]->inside;
    }
    if (!any) return;
    Tet tet{};
    for (std::size_t c = 0; c < 4; ++c) {
      if (vertices[c]->number == kUnused)
        vertices[c]->number = complex_.add_vertex(position(corners[c]), sizes_.finest());
      tet[c] = vertices[c]->number;
    }
    std::array<Vec3d, 3> e;
    for (std::size_t c = 0; c < 3; ++c) e[c] = complex_.points[tet[c + 1]] - complex_.points[tet[0]];
    if (dot(e[0], cross(e[1], e[2])) < 0.0) std::swap(tet[2], tet[3]);
    complex_.add_tet(tet, kUndecided);
  }

  /// The edge of each vertex: the mean over its tets, in units in which that of equal cubes is the one asked for.
  void set_edges() {
    const double unit = kMeanEdge / kMeanTetEdge / 3.0;
    for (std::uint32_t v = 0; v < complex_.points.size(); ++v) {
      double sum = 0.0;
      for (const std::uint32_t t : complex_.stars[v]) {
        for (const std::uint32_t x : complex_.tets[t]) sum += norm(complex_.points[x] - complex_.points[v]);
      }
      complex_.edges[v] = unit * sum / static_cast<double>(complex_.stars[v].size());
    }
  }

  const RegionFields& fields_;
  const SizeField& sizes_;
  std::size_t max_tets_;
  TetComplex& complex_;
  double side_;  ///< of the finest cubes [m]
  Vec3d origin_{};
  CellOctree tree_;
  double tets_ = 0.0;
  std::unordered_map<std::uint64_t, Vertex> vertices_;
};

}  // namespace

void fill_graded_lattice(const RegionFields& fields, const SizeField& sizes, std::size_t max_tets,
                         TetComplex& complex) {
  GradedLattice(fields, sizes, max_tets, complex).fill();
}

}  // namespace glisson::lattice
