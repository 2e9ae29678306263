// spring_mass.cpp — masses at the vertices, springs along the edges, explicit steps. The stiffness of a spring is taken from E by one of
// two published rules; either gives an isotropic body of Poisson's ratio 1/4 at best, whatever ν is.
//
//   by volume   k = Σ E V / l²          over the tets at the edge                                         [VanGelder1998]
//   by length   k = Σ (2 √2 / 25) E l   the least squares of the tensors of a regular tet, ν = 1/4        [Lloyd2007]
//   with volume the first, and each tet resists its change of volume by ½ K (V − V₀)²/V₀. K = λ − 0.4 E is what the springs lack
//               of the tissue's λ; below ν = 1/4 it is 0                                                  [Teschner2004]
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

#include "compare/models/boundary.h"
#include "compare/models/relaxation.h"
#include "compare/models/stepping.h"

namespace glisson::models {
namespace {

enum class Rule { volume, length };

struct Spring {
  std::uint32_t a, b;
  double length, stiffness;  // [m], [N/m]
};

/// What a tet resists a change of its volume with.
struct VolumeSpring {
  std::uint32_t of;
  Tet tet;
  double volume, modulus;  // [m³], [Pa]
};

/// ∂V/∂x of the first vertex of a tet, the others by turns.
std::array<Vec3d, 4> volume_gradients(const Tet& t, const std::vector<Vec3d>& x) {
  const Vec3d a = x[t[1]] - x[t[0]], b = x[t[2]] - x[t[0]], c = x[t[3]] - x[t[0]];
  std::array<Vec3d, 4> g;
  g[1] = cross(b, c) * (1.0 / 6.0);
  g[2] = cross(c, a) * (1.0 / 6.0);
  g[3] = cross(a, b) * (1.0 / 6.0);
  g[0] = -(g[1] + g[2] + g[3]);
  return g;
}

class SpringMass {
 public:
  SpringMass(const Problem& problem, Rule rule, bool volumes)
      : problem_(problem), rule_(rule), boundary_(problem), masses_(lumped_masses(problem)), x_(problem.mesh.vertices),
        u_(x_.size()), v_(x_.size()), f_(x_.size()) {
    make_springs();
    if (volumes) make_volume_springs();
  }

  /// 0.9 of the longest step of central differences, by row sums of the stiffness at rest.
  double step() const {
    std::vector<double> row(x_.size(), 0.0);
    for (const Spring& s : springs_) {
      row[s.a] += 2.0 * s.stiffness;
      row[s.b] += 2.0 * s.stiffness;
    }
    for (const VolumeSpring& s : volumes_) {
      const std::array<Vec3d, 4> g = volume_gradients(s.tet, problem_.mesh.vertices);
      const double sum = norm(g[0]) + norm(g[1]) + norm(g[2]) + norm(g[3]);
      for (std::size_t a = 0; a < 4; ++a) row[s.tet[a]] += s.modulus / s.volume * norm(g[a]) * sum;
    }
    double most = 0.0;
    for (std::size_t i = 0; i < x_.size(); ++i) most = std::max(most, row[i] / masses_[i]);
    return 0.9 * 2.0 / std::sqrt(most);
  }

  void advance(double time, double h) {
    find_forces();
    const Vec3d gravity = problem_.gravity_at(time);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      const Vec3d a = f_[i] * (1.0 / masses_[i]) + gravity;
      v_[i] = (v_[i] + a * h) * (1.0 / (1.0 + problem_.motion.damping_rate * h));
      u_[i] += v_[i] * h;
    }
    const std::vector<Vec3d> free = u_;
    boundary_.set(time + h, u_);
    for (std::size_t i = 0; i < x_.size(); ++i) {
      v_[i] += (u_[i] - free[i]) * (1.0 / h);
      x_[i] = problem_.mesh.vertices[i] + u_[i];
    }
  }

  Vec3d force(double time) {
    find_forces();
    for (std::size_t i = 0; i < x_.size(); ++i) f_[i] += problem_.gravity_at(time) * masses_[i];
    return boundary_.force(f_, u_);
  }

  /// Springs lose the share that the tets gave them, and those of no tet are gone; so are the tets' volumes. Their mass stays.
  std::string remove(std::span<const std::uint32_t> tets) {
    const std::set<std::uint32_t> gone(tets.begin(), tets.end());
    add_stiffness(-1.0, [&](std::uint32_t t) { return gone.contains(t); });
    double most = 0.0;
    for (const Spring& s : springs_) most = std::max(most, s.stiffness);
    std::erase_if(springs_, [&](const Spring& s) { return s.stiffness <= 1e-9 * most; });
    std::erase_if(volumes_, [&](const VolumeSpring& s) { return gone.contains(s.of); });
    return {};
  }

  const std::vector<Vec3d>& displacement() const { return u_; }
  std::size_t bytes() const {
    return springs_.size() * sizeof(Spring) + volumes_.size() * sizeof(VolumeSpring) +
           x_.size() * (4 * sizeof(Vec3d) + 8);
  }

 private:
  void make_springs() {
    for (const auto& [a, b] : mesh_edges(problem_.mesh)) {
      springs_.push_back({a, b, norm(problem_.mesh.vertices[b] - problem_.mesh.vertices[a]), 0.0});
    }
    add_stiffness(1.0, [](std::uint32_t) { return true; });
  }

  /// What the tets that are taken give their springs, times a sign.
  template <class Takes>
  void add_stiffness(double sign, Takes takes) {
    const auto before = [](const Spring& s, const std::array<std::uint32_t, 2>& ends) {
      return s.a < ends[0] || (s.a == ends[0] && s.b < ends[1]);
    };
    for (std::uint32_t t = 0; t < problem_.mesh.tets.size(); ++t) {
      if (!takes(t)) continue;
      const Tet& tet = problem_.mesh.tets[t];
      const double volume = six_rest_volume(problem_.mesh, t) / 6.0;
      const double young = youngs_modulus(test_moduli(problem_, problem_.tissue_of(t)));
      for (std::size_t a = 0; a < 4; ++a) {
        for (std::size_t b = a + 1; b < 4; ++b) {
          const std::array<std::uint32_t, 2> ends{std::min(tet[a], tet[b]), std::max(tet[a], tet[b])};
          Spring& s = *std::lower_bound(springs_.begin(), springs_.end(), ends, before);
          s.stiffness += sign * (rule_ == Rule::volume ? young * volume / (s.length * s.length)
                                                       : 2.0 * std::numbers::sqrt2 / 25.0 * young * s.length);
        }
      }
    }
  }

  void make_volume_springs() {
    for (std::uint32_t t = 0; t < problem_.mesh.tets.size(); ++t) {
      const LameParameters lame = test_moduli(problem_, problem_.tissue_of(t));
      const double young = youngs_modulus(lame);
      const double lacks = lame.lambda - 0.4 * young;
      if (lacks > 0.0) volumes_.push_back({t, problem_.mesh.tets[t], six_rest_volume(problem_.mesh, t) / 6.0, lacks});
    }
  }

  void find_forces() {
    std::fill(f_.begin(), f_.end(), Vec3d{});
    for (const Spring& s : springs_) {
      const Vec3d d = x_[s.b] - x_[s.a];
      const double length = norm(d);
      const Vec3d pull = d * (s.stiffness * (length - s.length) / length);
      f_[s.a] += pull;
      f_[s.b] -= pull;
    }
    for (const VolumeSpring& s : volumes_) {
      const std::array<Vec3d, 4> g = volume_gradients(s.tet, x_);
      const double volume = dot(g[1], x_[s.tet[1]] - x_[s.tet[0]]);
      const double pressure = s.modulus * (volume - s.volume) / s.volume;
      for (std::size_t a = 0; a < 4; ++a) f_[s.tet[a]] -= g[a] * pressure;
    }
  }

  const Problem& problem_;
  Rule rule_;
  Boundary boundary_;
  std::vector<double> masses_;
  std::vector<Spring> springs_;
  std::vector<VolumeSpring> volumes_;
  std::vector<Vec3d> x_, u_, v_, f_;
};

Answer run(const Problem& problem, const Stop& stop, Rule rule, bool volumes) {
  Stopwatch watch;
  SpringMass model(problem, rule, volumes);
  const auto steps = static_cast<std::size_t>(std::ceil(problem.duration / model.step()));
  return run_in_steps(problem, stop, model, steps, watch);
}

}  // namespace

Answer spring_mass_by_volume(const Problem& problem, const Effort&, const Stop& stop) {
  return run(problem, stop, Rule::volume, false);
}
Answer spring_mass_by_length(const Problem& problem, const Effort&, const Stop& stop) {
  return run(problem, stop, Rule::length, false);
}
Answer spring_mass_with_volume(const Problem& problem, const Effort&, const Stop& stop) {
  return run(problem, stop, Rule::volume, true);
}

}  // namespace glisson::models
