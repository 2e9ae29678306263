// region_mesh_load.h — a meshed ball or shell under pressure, held without forces, and what it does; a thick shell against Lamé.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "glisson/region_mesh.h"
#include "support/statics.h"

namespace glisson {
namespace region_mesh_mechanics {

constexpr double kRadius = 0.05;  // [m]

/// Where the lattice lies in the body: the body is meshed turned and moved by this.
struct Lay {
  Vec3d axis{0, 0, 1};  ///< of symmetry, in the lattice's axes, a unit vector
  Vec3d middle{};       ///< of the body [m]
};
inline const Lay kLevel{}, kTurned{unit(Vec3d{0.36, 0.48, 0.8}), {1.3e-3, -0.7e-3, 2.1e-3}};

inline BodyRegion ball(const std::string& name, double radius, const Lay& lay, bool hole = false) {
  const Vec3d reach{1.05 * radius, 1.05 * radius, 1.05 * radius};
  return {name,
          [=](const Vec3d& p) { return norm(p - lay.middle) - radius; },
          {lay.middle - reach, lay.middle + reach},
          hole};
}

/// A triangle of the body's surface or of an interface, outward.
struct Facet {
  std::array<std::uint32_t, 3> corners;
  Vec3d area{};  ///< times its normal [m²]
};

class Loaded {
 public:
  Loaded(const std::vector<BodyRegion>& regions, const RegionMeshOptions& options, const std::map<int, Tissue>& tissues,
         const Lay& lay)
      : lay_(lay), made_(mesh_regions(regions, options)), body_(build_body(made_.mesh, tissues)), op_(body_),
        load_(made_.mesh.vertices.size()), u_(made_.mesh.vertices.size()) {
    for (const Triangle& t : boundary_triangles(made_.mesh)) surface_.push_back(facet(t));
  }

  /// Pressure on the faces of the surface on one side of a radius, at each point as the function says [Pa].
  template <class Pressure>
  void press(bool inside, double between, Pressure pressure) {
    for (const Facet& f : surface_) {
      if ((norm(centre(f) - lay_.middle) < between) != inside) continue;
      // Three points of the plane triangle integrate what is quadratic over it exactly.
      for (std::size_t i = 0; i < 3; ++i) {
        std::array<double, 3> weight{1.0 / 6.0, 1.0 / 6.0, 1.0 / 6.0};
        weight[i] = 2.0 / 3.0;
        Vec3d at{};
        for (std::size_t k = 0; k < 3; ++k) at += made_.mesh.vertices[f.corners[k]] * weight[k];
        const Vec3d force = f.area * (-pressure(at - lay_.middle) / 3.0);
        for (std::size_t k = 0; k < 3; ++k) load_[f.corners[k]] += force * weight[k];
      }
    }
  }

  /// The load is in balance; six components hold the body in its place and take no force.
  bool solve() {
    test::Supports supports(u_.size());
    const auto nearest = [&](const Vec3d& p) {
      std::uint32_t best = 0;
      for (std::uint32_t v = 0; v < u_.size(); ++v) {
        if (norm(made_.mesh.vertices[v] - p) < norm(made_.mesh.vertices[best] - p)) best = v;
      }
      return best;
    };
    const std::uint32_t a = nearest(lay_.middle), b = nearest(lay_.middle + Vec3d{kRadius, 0, 0}),
                        c = nearest(lay_.middle + Vec3d{0, kRadius, 0});
    supports.hold_all(a);
    supports.hold(b, 1), supports.hold(b, 2), supports.hold(c, 2);
    TissueTangent K;
    op_.linearise({u_, test::Field(u_.size()), 0.0}, 0.0, false, K);
    // Not test::solve(): a factorisation of 50 000 tets takes ten times as long.
    if (test::solve_linear(op_, K, supports, load_, 1e-8, u_) < 0) return false;
    test::Field left = load_, elastic(u_.size());
    op_.apply(K, u_, elastic);
    test::add(left, elastic, -1.0);
    double all = 0.0, most = 0.0;
    for (const Vec3d& x : load_) all += norm(x);
    for (const Vec3d& x : left) most = std::max(most, norm(x));
    EXPECT_LT(most, 2e-3 * all) << "what holds the body in its place carries load";
    return true;
  }

  /// Displacement along the radius, mean over the faces of the surface on one side of a radius [m].
  double radial(bool inside, double between) const {
    double sum = 0.0, area = 0.0;
    for (const Facet& f : surface_) {
      if ((norm(centre(f) - lay_.middle) < between) != inside) continue;
      for (const std::uint32_t v : f.corners) {
        sum += norm(f.area) / 3.0 * dot(u_[v], unit(made_.mesh.vertices[v] - lay_.middle));
      }
      area += norm(f.area);
    }
    return sum / area;
  }

  /// Relative change of a region's volume [-].
  double dilatation(int region) const {
    const auto& x = made_.mesh.vertices;
    double change = 0.0, volume = 0.0;  // six times
    for (std::size_t t = 0; t < made_.mesh.tets.size(); ++t) {
      if (made_.mesh.regions[t] != region) continue;
      std::array<Vec3d, 3> e, du;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = made_.mesh.tets[t][k + 1], first = made_.mesh.tets[t][0];
        e[k] = x[v] - x[first], du[k] = u_[v] - u_[first];
      }
      for (std::size_t k = 0; k < 3; ++k) change += dot(du[k], cross(e[(k + 1) % 3], e[(k + 2) % 3]));
      volume += dot(e[0], cross(e[1], e[2]));
    }
    return change / volume;
  }

  double work() const { return test::inner(load_, u_); }  ///< of the load on the displacement [J]
  std::size_t tets() const { return made_.mesh.tets.size(); }

 private:
  Facet facet(const Triangle& t) const {
    const auto& x = made_.mesh.vertices;
    return {{t[0], t[1], t[2]}, cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]) * 0.5};
  }
  Vec3d centre(const Facet& f) const {
    const auto& x = made_.mesh.vertices;
    return (x[f.corners[0]] + x[f.corners[1]] + x[f.corners[2]]) * (1.0 / 3.0);
  }

  Lay lay_;
  RegionMesh made_;
  Body body_;
  TissueOperator op_;
  std::vector<Facet> surface_;
  test::Field load_, u_;
};

inline Tissue tissue(double youngs_modulus) {
  Tissue t;
  t.youngs_modulus = youngs_modulus, t.poisson_ratio = 0.3;
  return t;
}

inline void record(const std::string& name, double error) {
  testing::Test::RecordProperty(name + "_percent", std::to_string(100.0 * error));
}

// --- a thick shell under pressure from inside: Lamé's solution -----------------------------------------------------------

struct ShellErrors {
  double inside, outside;
  std::size_t tets;
};

///   u = p a³ / (b³ − a³) ((1 − 2ν) r + (1 + ν) b³ / (2 r²)) / E
inline ShellErrors shell(const RegionMeshOptions& options, const Lay& lay) {
  const double a = 0.5 * kRadius, b = kRadius, p = 1.0, between = 0.5 * (a + b);
  const Tissue t = tissue(5000.0);
  Loaded body({ball("hollow", a, lay, true), ball("shell", b, lay)}, options, {{2, t}}, lay);
  body.press(true, between, [&](const Vec3d&) { return p; });
  EXPECT_TRUE(body.solve());
  const auto exact = [&](double r) {
    const double nu = t.poisson_ratio;
    return p * a * a * a / (b * b * b - a * a * a) * ((1.0 - 2.0 * nu) * r + (1.0 + nu) * b * b * b / (2.0 * r * r)) /
           t.youngs_modulus;
  };
  return {body.radial(true, between) / exact(a) - 1.0, body.radial(false, between) / exact(b) - 1.0, body.tets()};
}

}  // namespace region_mesh_mechanics
}  // namespace glisson
