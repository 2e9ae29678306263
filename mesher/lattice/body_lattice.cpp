// body_lattice.cpp — the corners and centres of cubes, and four tets about each face between two centres.
//
//        o-----------o          Two centres C, D on the sides of a common face and an edge P–Q of the face make a tet:
//       /|    D     /|          its dihedral angles are 60° and 90°, its edges 1 (C–D, P–Q) and √3/2 of the cube's side.
//      o-+---------o |
//      | o - Q - - + o          Blocks of cubes are skipped where no region's distance, taken at the block's centre, reaches
//      |/    C     |/           them: no vertex is evaluated far outside.
//      o-----P-----o
#include "mesher/lattice/body_lattice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/available_memory.h"
#include "base/text.h"

namespace glisson::lattice {
namespace {

constexpr int kBlock = 4;  ///< cubes a side of a block
constexpr double kMaxCells = 4e8;
constexpr double kCounted = 2.0;    ///< times as many tets as are allowed: from there on they are estimated
constexpr double kBytesATet = 250;  ///< of the mesher and the mesh it returns; measured: 150

class Lattice {
 public:
  Lattice(const RegionFields& fields, std::size_t max_tets, TetComplex& complex)
      : fields_(fields), max_tets_(max_tets), complex_(complex), side_(cube_side(fields.edge())) {
    place();
    corner_.resize(count(1), kUnknown);
    centre_.resize(count(0), kUnknown);
  }

  void fill() {
    mark_inside();
    const double edge = fields_.edge();
    refuse_too_many(edge, edge, 6.0 * static_cast<double>(inside_), max_tets_);  // two vertices, 12 tets a cube
    for (int k = 0; k < n_[2]; ++k) {
      for (int j = 0; j < n_[1]; ++j) {
        for (int i = 0; i < n_[0]; ++i) add_cube(i, j, k);
      }
    }
  }

 private:
  static constexpr std::uint32_t kUnknown = ~0u, kOutside = ~0u - 1, kInside = ~0u - 2;  ///< above all vertex numbers

  void place() {
    const auto [low, high] = fields_.bounds();
    double cells = 1.0;
    for (std::size_t d = 0; d < 3; ++d) {
      const double n = std::ceil((high[d] - low[d]) / side_ - 1e-9) + 4.0;
      cells *= n;
      if (!(cells <= kMaxCells)) {
        refuse_short_edge(fields_.edge(), high[d] - low[d]);
      }
      n_[d] = static_cast<int>(n);
      origin_[d] = 0.5 * (low[d] + high[d]) - 0.5 * n * side_;
    }
  }

  std::size_t count(int more) const {
    return static_cast<std::size_t>(n_[0] + more) * static_cast<std::size_t>(n_[1] + more) *
           static_cast<std::size_t>(n_[2] + more);
  }
  std::uint32_t& at(bool is_centre, int i, int j, int k) {
    const int more = is_centre ? 0 : 1;
    const auto row = static_cast<std::size_t>(k) * static_cast<std::size_t>(n_[1] + more) + static_cast<std::size_t>(j);
    return (is_centre ? centre_ : corner_)[row * static_cast<std::size_t>(n_[0] + more) + static_cast<std::size_t>(i)];
  }
  Vec3d place_of(bool is_centre, int i, int j, int k) const {
    const double more = is_centre ? 0.5 : 0.0;
    return origin_ + Vec3d{i + more, j + more, k + more} * side_;
  }

  /// Whether a region may reach a block whose lowest cube is (i, j, k).
  bool reached(int i, int j, int k) const {
    const double half = 0.5 * kBlock * side_;
    return fields_.reached(place_of(false, i, j, k) + Vec3d{half, half, half}, half);
  }

  void mark_inside() {
    for (int k = 0; k < n_[2]; k += kBlock) {
      for (int j = 0; j < n_[1]; j += kBlock) {
        for (int i = 0; i < n_[0]; i += kBlock) {
          if (reached(i, j, k)) mark_block(i, j, k);
        }
      }
    }
  }

  void mark_block(int i0, int j0, int k0) {
    for (const bool is_centre : {false, true}) {
      const int more = is_centre ? 0 : 1;
      for (int k = k0; k < std::min(k0 + kBlock + more, n_[2] + more); ++k) {
        for (int j = j0; j < std::min(j0 + kBlock + more, n_[1] + more); ++j) {
          for (int i = i0; i < std::min(i0 + kBlock + more, n_[0] + more); ++i) {
            std::uint32_t& mark = at(is_centre, i, j, k);
            if (mark != kUnknown) continue;
            const bool inside = fields_.filled(fields_.label(place_of(is_centre, i, j, k)));
            inside_ += inside;
            mark = inside ? kInside : kOutside;
          }
        }
      }
    }
    if (6.0 * static_cast<double>(inside_) > kCounted * static_cast<double>(max_tets_))
      refuse_too_many(fields_.edge(), fields_.edge(), estimated_tets(), max_tets_);
  }

  /// By the volume, of some thousand points, not below what was counted so far.
  double estimated_tets() const {
    constexpr int kAside = 20;
    const auto [low, high] = fields_.bounds();
    const Vec3d step = (high - low) * (1.0 / kAside);
    int hits = 0;
    for (int n = 0; n < kAside * kAside * kAside; ++n) {
      const int i = n % kAside, j = n / kAside % kAside, k = n / kAside / kAside;
      const Vec3d at{i + 0.5, j + 0.5, k + 0.5};
      hits += fields_.filled(fields_.label(low + component_product(at, step))) ? 1 : 0;
    }
    return std::max(expected_tets(hits * step.x * step.y * step.z, fields_.edge()), 6.0 * static_cast<double>(inside_));
  }

  std::uint32_t vertex(bool is_centre, int i, int j, int k) {
    std::uint32_t& mark = at(is_centre, i, j, k);
    if (mark < kInside) return mark;
    used_inside_.push_back(mark == kInside);
    return mark = complex_.add_vertex(place_of(is_centre, i, j, k), fields_.edge());
  }

  struct Place {
    bool is_centre;
    int i, j, k;
  };
  void add(const std::array<Place, 4>& places) {
    Tet tet;
    for (std::size_t c = 0; c < 4; ++c) tet[c] = vertex(places[c].is_centre, places[c].i, places[c].j, places[c].k);
    complex_.add_tet(tet, kUndecided);
  }

  /// The tets about the faces between cube (i, j, k) and the next along x, y and z.
  void add_cube(int i, int j, int k) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::array<int, 3> next{i, j, k};
      if (++next[axis] >= n_[axis]) continue;
      const std::size_t b = (axis + 1) % 3, c = (axis + 2) % 3;
      const Place from{true, i, j, k}, to{true, next[0], next[1], next[2]};
      std::array<Place, 4> corners;
      for (std::size_t n = 0; n < 4; ++n) {  // around the face, anticlockwise about the axis
        std::array<int, 3> at = next;
        at[b] += n == 1 || n == 2;
        at[c] += n >= 2;
        corners[n] = {false, at[0], at[1], at[2]};
      }
      for (std::size_t n = 0; n < 4; ++n) {
        const std::array<Place, 4> tet{from, to, corners[n], corners[(n + 1) % 4]};
        const bool any = std::any_of(tet.begin(), tet.end(), [&](const Place& p) { return inside_at(p); });
        if (any) add(tet);
      }
    }
  }

  bool inside_at(const Place& p) {
    const std::uint32_t mark = at(p.is_centre, p.i, p.j, p.k);
    if (mark == kInside) return true;
    return mark < kInside && used_inside_[mark];
  }

  const RegionFields& fields_;
  std::size_t max_tets_;
  TetComplex& complex_;
  double side_;
  std::array<int, 3> n_{};
  Vec3d origin_{};
  std::vector<std::uint32_t> corner_, centre_;
  std::size_t inside_ = 0;
  std::vector<char> used_inside_;  ///< of vertices that have a number
};

std::string millimetres(double length) { return detail::number_text(1e3 * length, 3) + " mm"; }

std::string edges_asked_text(double coarsest, double finest) {
  if (finest >= coarsest) return "an edge of " + millimetres(coarsest) + " makes ";
  return "edges of " + millimetres(coarsest) + ", at the finest " + millimetres(finest) + ", make ";
}

/// To two digits, without powers of ten.
std::string rounded_text(double count) {
  const double unit = std::pow(10.0, std::floor(std::log10(std::max(count, 10.0))) - 1.0);
  const double rounded = std::round(count / unit) * unit;
  return rounded < 1e6 ? detail::number_text(rounded, 9) : detail::number_text(1e-6 * rounded, 9) + " million";
}

}  // namespace

void refuse_short_edge(double edge, double extent) {
  throw std::invalid_argument("an edge of " + millimetres(edge) + " is too short for a body of " +
                              detail::number_text(extent, 3) +
                              " m: its lattice would have hundreds of millions of cubes; give a longer edge, or see "
                              "whether the body is in metres");
}

void refuse_more_than(double coarsest, double finest, std::size_t max_tets) {
  throw std::invalid_argument(
      edges_asked_text(coarsest, finest) + "more than " + std::to_string(max_tets) +
      " tets, and no more are allowed: give longer edges, or fine ones less far, or raise max_tets");
}

void refuse_too_many(double coarsest, double finest, double tets, std::size_t max_tets) {
  const bool uniform = finest >= coarsest;
  const std::string asks = edges_asked_text(coarsest, finest) + "some " + rounded_text(tets) + " tets; ";
  const auto larger_edge = [&](double most) {
    const double factor = 1.02 * std::cbrt(tets / most);
    if (!uniform) return "give edges " + detail::number_text(factor, 2) + " times as long, or fine ones less far";
    return "give an edge of " + detail::number_text(1e3 * factor * coarsest, 2) + " mm or more";
  };
  const auto allowed = static_cast<double>(max_tets);
  if (tets > allowed) {
    throw std::invalid_argument(asks + "at most " + std::to_string(max_tets) + " are allowed: " + larger_edge(allowed) +
                                ", or raise max_tets");
  }
  const std::optional<double> memory = detail::available_memory();
  if (memory && tets * kBytesATet > *memory) {
    throw std::invalid_argument(asks + "that takes " + rounded_text(1e-6 * tets * kBytesATet) + " MB and " +
                                rounded_text(1e-6 * *memory) +
                                " MB are available: " + larger_edge(std::max(1.0, *memory / kBytesATet)));
  }
}

void fill_lattice(const RegionFields& fields, std::size_t max_tets, TetComplex& complex) {
  Lattice(fields, max_tets, complex).fill();
}

}  // namespace glisson::lattice
