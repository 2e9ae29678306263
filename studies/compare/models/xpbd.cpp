// xpbd.cpp — extended position-based dynamics on tets: positions are projected, tet by tet, onto two constraints of a neo-Hookean energy
// whose compliances are its moduli [MacklinMueller2016; MacklinMueller2021]:
//
//   C_D = √tr(FᵀF), α = 1/(μ V)        C_H = det F − (1 + μ/λ'), α = 1/(λ' V), λ' = λ + μ
//
// λ' makes its stiffness at rest that of the tissue. Δλ = (− C − α̃ λ)/(Σ w |∇C|² + α̃), α̃ = α/h². As many sweeps as it is given: with
// fewer than it takes to converge the body is softer, by how much depends on the step and the mesh.
#include <cmath>
#include <string>

#include "compare/models/boundary.h"
#include "compare/models/relaxation.h"
#include "compare/models/stepping.h"

namespace glisson::models {
namespace {

/// Cofactors of F: ∂ det F/∂F.
Mat3d cofactors(const Mat3d& f) {
  Mat3d c;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c(i, j) = f(i1, j1) * f(i2, j2) - f(i1, j2) * f(i2, j1);
    }
  }
  return c;
}

class Xpbd {
 public:
  Xpbd(const Problem& problem, int iterations)
      : problem_(problem), iterations_(iterations), boundary_(problem), masses_(lumped_masses(problem)),
        u_(masses_.size()), v_(masses_.size()), f_(masses_.size()), w_(masses_.size()) {
    for (std::size_t i = 0; i < masses_.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) w_[i][k] = boundary_.prescribes(i, k) ? 0.0 : 1.0 / masses_[i];
    }
    for (std::size_t t = 0; t < problem.mesh.tets.size(); ++t) {
      const LameParameters lame = test_moduli(problem, problem.tissue_of(t));
      tets_.push_back({rest_tet(problem.mesh, t), lame.mu, lame.lambda + lame.mu, 0.0, 0.0});
    }
  }

  void advance(double time, double h) {
    h_ = h;
    const std::vector<Vec3d> before = u_;
    const Vec3d gravity = problem_.gravity_at(time);
    for (std::size_t i = 0; i < u_.size(); ++i) {
      v_[i] = (v_[i] + gravity * h) * (1.0 / (1.0 + problem_.motion.damping_rate * h));
      u_[i] += v_[i] * h;
    }
    boundary_.set(time + h, u_);
    for (TetState& t : tets_) t.shape = t.volume = 0.0;
    for (int k = 0; k < iterations_; ++k) {
      for (std::size_t t = 0; t < tets_.size(); ++t) project(t, h);
    }
    for (std::size_t i = 0; i < u_.size(); ++i) v_[i] = (u_[i] - before[i]) * (1.0 / h);
  }

  /// The forces of the constraints' multipliers, λ ∇C/h².
  Vec3d force(double time) {
    for (std::size_t i = 0; i < f_.size(); ++i) f_[i] = problem_.gravity_at(time) * masses_[i];
    for (std::size_t t = 0; t < tets_.size(); ++t) {
      const TetState& state = tets_[t];
      if (state.gone) continue;
      const Tet& tet = problem_.mesh.tets[t];
      const Mat3d f = deformation_gradient(state.rest, tet, u_);
      const double size = shape_size(f);
      const Mat3d c = cofactors(f);
      for (std::size_t a = 0; a < 4; ++a) {
        f_[tet[a]] += (f * state.rest.s[a]) * (state.shape / (size * h_ * h_)) +
                      (c * state.rest.s[a]) * (state.volume / (h_ * h_));
      }
    }
    return boundary_.force(f_, u_);
  }

  /// The constraints of the tets are gone; their mass stays.
  std::string remove(std::span<const std::uint32_t> tets) {
    for (const std::uint32_t t : tets) tets_[t].gone = true;
    return {};
  }

  const std::vector<Vec3d>& displacement() const { return u_; }
  std::size_t bytes() const { return tets_.size() * sizeof(TetState) + u_.size() * (4 * sizeof(Vec3d) + 8); }

 private:
  struct TetState {
    RestTet rest;
    double mu, lambda;
    double shape, volume;  // multipliers of this step
    bool gone = false;
  };

  static double shape_size(const Mat3d& f) {
    double sum = 0.0;
    for (const auto& row : f.m) sum += row[0] * row[0] + row[1] * row[1] + row[2] * row[2];
    return std::sqrt(sum);
  }

  void move(const TetState& state, const Tet& tet, const Mat3d& gradient, double c, double compliance,
            double& multiplier) {
    std::array<Vec3d, 4> g;
    double slope = compliance;
    for (std::size_t a = 0; a < 4; ++a) {
      g[a] = gradient * state.rest.s[a];
      slope += dot(component_product(w_[tet[a]], g[a]), g[a]);
    }
    const double change = (-c - compliance * multiplier) / slope;
    multiplier += change;
    for (std::size_t a = 0; a < 4; ++a) u_[tet[a]] += component_product(w_[tet[a]], g[a]) * change;
  }

  void project(std::size_t t, double h) {
    TetState& state = tets_[t];
    if (state.gone) return;
    const Tet& tet = problem_.mesh.tets[t];
    Mat3d f = deformation_gradient(state.rest, tet, u_);
    const double size = shape_size(f);
    Mat3d direction = f;
    for (auto& row : direction.m) {
      for (double& x : row) x /= size;
    }
    move(state, tet, direction, size, 1.0 / (state.mu * state.rest.volume * h * h), state.shape);
    f = deformation_gradient(state.rest, tet, u_);
    move(state, tet, cofactors(f), determinant(f) - 1.0 - state.mu / state.lambda,
         1.0 / (state.lambda * state.rest.volume * h * h), state.volume);
  }

  const Problem& problem_;
  int iterations_;
  double h_ = 0.0;  // of the last step
  Boundary boundary_;
  std::vector<double> masses_;
  std::vector<Vec3d> u_, v_, f_, w_;
  std::vector<TetState> tets_;
};

}  // namespace

Answer xpbd(const Problem& problem, const Effort& effort, const Stop& stop) {
  Stopwatch watch;
  Xpbd model(problem, effort.iterations);
  return run_in_steps(problem, stop, model, static_cast<std::size_t>(effort.steps), watch);
}

}  // namespace glisson::models
