// step_bounds.cpp — what a bound of the step without memory would cost, along a liver pressed by 60 % (docs/integrators.md).
//
//   step_bounds liver.vtu [law …]
//
// A run takes today's automatic steps; at 110 moments each bound says which step it would allow there, and the time from one
// moment to the next over 0.9 of that is the number of steps it would have made. With A_e the tangent of a tet, κ its rank-one
// norm and q_a = Σ_e V κ |s_a|² over the tets around a vertex, shares m_a V κ |s_a|²/q_a of the masses give
//   ω² ≤ max_e Σ_a q_a/m_a,                    of the whole tangent ("shares"), or
//   ω² ≤ ω*² + max_e Σ_a q_a/m_a,              of what exceeds the tangent at rest ("rest + excess"), κ exact or from the
//                                              ratio r and norm n that the elements have anyway ("rest + ratio and norm"):
// with m the norm of the tangent at rest min(r − 1, n) m, or, since only rank-one changes count, min((r − 1)(λ + 2 μ), n m)
// ("rank-one"). The rows of M⁻¹K bound it by vertices, without a look back at the tets: ω² ≤ max_a Σ_e V κ |s_a| Σ_b |s_b|/m_a.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <random>
#include <string>
#include <vector>

#include "dynamics/step/stable_step.h"
#include "element/tissue_operator.h"
#include "glisson/instruments/motion.h"
#include "glisson/io.h"
#include "glisson/simulation/simulation.h"

namespace {

using namespace glisson;
using Tensor = Eigen::Matrix<double, 9, 9>;

constexpr int kMoments = 110, kSweeps = 6, kPowers = 60;
constexpr double kSafety = 0.9, kEnd = 1.1;  ///< of an automatic step; press and rest [s]

/// max over unit a, b of (a ⊗ b):A:(a ⊗ b), by turns from four starts.
double rank_one_norm(const Tensor& A) {
  const auto top = [](const Eigen::Matrix3d& m) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> s(m);
    return std::pair<double, Eigen::Vector3d>(s.eigenvalues()[2], s.eigenvectors().col(2));
  };
  double most = 0.0;
  for (int start = 0; start < 4; ++start) {
    Eigen::Vector3d b = start < 3 ? Eigen::Vector3d::Unit(start) : Eigen::Vector3d::Ones().normalized();
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      Eigen::Matrix3d of_a = Eigen::Matrix3d::Zero(), of_b = of_a;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) of_a(i, k) = b.dot(A.block<3, 3>(3 * i, 3 * k) * b);
      }
      const Eigen::Vector3d a = top(of_a).second;
      for (int i = 0; i < 3; ++i) {
        for (int k = 0; k < 3; ++k) of_b += a[i] * a[k] * A.block<3, 3>(3 * i, 3 * k);
      }
      const auto [value, direction] = top(of_b);
      b = direction, most = std::max(most, value);
    }
  }
  return most;
}

Tensor positive_part(const Tensor& A) {
  const Eigen::SelfAdjointEigenSolver<Tensor> s(0.5 * (A + A.transpose()));
  return s.eigenvectors() * s.eigenvalues().cwiseMax(0.0).asDiagonal() * s.eigenvectors().transpose();
}

/// max_e Σ_a q_a/m_a. @param k  V κ of each element
double by_shares(const Body& body, const std::vector<double>& k) {
  std::vector<double> q(body.vertex_count, 0.0);
  for (std::size_t e = 0; e < k.size(); ++e) {
    const std::array<Vec3d, 4> s = shape_gradients(body.rest[e]);
    for (std::size_t a = 0; a < 4; ++a) q[body.elements[e][a]] += k[e] * dot(s[a], s[a]);
  }
  double most = 0.0;
  for (std::size_t e = 0; e < k.size(); ++e) {
    double sum = 0.0;
    for (const std::uint32_t v : body.elements[e]) sum += q[v] / body.masses[v];
    if (k[e] > 0.0) most = std::max(most, sum);
  }
  return most;
}

/// max_a Σ_e k_e |s_a| Σ_b |s_b|/m_a.
double by_rows(const Body& body, const std::vector<double>& k) {
  std::vector<double> row(body.vertex_count, 0.0);
  double most = 0.0;
  for (std::size_t e = 0; e < k.size(); ++e) {
    double sum = 0.0;
    for (const Vec3d& s : shape_gradients(body.rest[e])) sum += norm(s);
    for (std::size_t a = 0; a < 4; ++a) {
      const std::uint32_t v = body.elements[e][a];
      row[v] += k[e] * norm(shape_gradients(body.rest[e])[a]) * sum / body.masses[v];
      most = std::max(most, row[v]);
    }
  }
  return most;
}

/// λ_max(M⁻¹K) by the power method; `x` is where it begins and ended.
double squared_frequency(const TissueOperator& tissue, const TissueTangent& tangent, std::vector<Vec3d>& x) {
  const std::vector<double>& m = tissue.body().masses;
  std::vector<Vec3d> y(x.size()), z(x.size());
  double value = 0.0;
  for (int power = 0; power < kPowers; ++power) {
    for (std::size_t i = 0; i < x.size(); ++i) z[i] = x[i] * (1.0 / std::sqrt(m[i]));
    tissue.apply(tangent, z, y);
    double square = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) y[i] *= 1.0 / std::sqrt(m[i]), square += dot(y[i], y[i]);
    value = std::sqrt(square);
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = y[i] * (1.0 / value);
  }
  return value;
}

/// Laws of the small-strain moduli of deep_press.cpp.
Tissue tissue_of(const std::string& law) {
  Tissue t;
  t.name = law, t.youngs_modulus = 18388.0, t.poisson_ratio = 0.4, t.density = 1060.0;
  const double mu = t.lame().mu, kappa = t.lame().lambda + 2.0 / 3.0 * mu;
  if (law == "corotational")
    t.kinematics = Kinematics::corotational;
  else if (law == "green")
    t.kinematics = Kinematics::green;
  else if (law == "neo_hookean")
    t.hyperelastic = NeoHookean{.mu = mu, .bulk_modulus = kappa};
  else if (law == "yeoh")
    t.hyperelastic = Yeoh{.c1 = 0.5 * mu, .c2 = 0.25 * mu, .c3 = 0.25 * mu, .bulk_modulus = kappa};
  else if (law == "veronda_westmann")
    t.hyperelastic = VerondaWestmann{.c = 0.5 * mu, .b = 2.0, .bulk_modulus = kappa};
  else
    throw std::invalid_argument(law + " is none of corotational, green, neo_hookean, yeoh, veronda_westmann");
  return t;
}

class Trial {
 public:
  Trial(const TetMesh& mesh, const Tissue& tissue)
      : mesh_(mesh), body_(build_body(mesh, {{0, tissue}})), operator_(body_) {
    const std::vector<Vec3d> rest(body_.vertex_count);
    TissueTangent tangent;
    operator_.linearise({rest, rest}, 0.0, false, tangent);
    for (const ElementTangent& A : tangent.local) at_rest_.push_back(positive_part(A));
    const double h = stable_step(body_, std::vector<double>(1, 1.0), std::vector<double>(body_.vertex_count, 0.0)).step;
    rest_ = 4.0 / (h * h);
    std::mt19937 random(1);
    std::normal_distribution<double> number;
    for (std::size_t i = 0; i < body_.vertex_count; ++i)
      mode_.push_back({number(random), number(random), number(random)});
  }

  void run() {
    const auto [low, high] = std::minmax_element(mesh_.vertices.begin(), mesh_.vertices.end(),
                                                 [](const Vec3d& a, const Vec3d& b) { return a.z < b.z; });
    const double depth = 0.6 * (high->z - low->z);
    Simulation s(mesh_, {{0, body_.blocks[0].tissue}}, {.damping_rate = 20.0});
    s.fix(within(low->z, low->z + 0.02));
    s.drive(within(high->z - 0.02, high->z), press({.velocity = depth, .depth = depth, .hold = 0.1}));
    for (int moment = 1; moment <= kMoments; ++moment) {
      const double from = s.time();
      while (s.time() < kEnd * moment / kMoments) {
        if (!s.step().made()) throw std::runtime_error("a step was not made");
      }
      look(s.displacement(), s.time() - from);
    }
    std::printf("| %s | %llu | %.2f | %.2f | %.2f | %.2f | %.2f | %.2f |\n", body_.blocks[0].tissue.name.c_str(),
                static_cast<unsigned long long>(s.steps()), exact_ / s.steps(), shares_ / s.steps(),
                excess_ / s.steps(), cheap_ / s.steps(), rank_one_ / s.steps(), rows_ / s.steps());
    std::fflush(stdout);
  }

 private:
  std::vector<std::uint32_t> within(double low, double high) const {
    std::vector<std::uint32_t> set;
    for (std::uint32_t i = 0; i < mesh_.vertices.size(); ++i) {
      if (mesh_.vertices[i].z >= low && mesh_.vertices[i].z <= high) set.push_back(i);
    }
    return set;
  }

  /// Adds the steps that each bound would make in a time.
  void look(std::span<const Vec3d> u, double time) {
    const std::vector<Vec3d> still(u.size());
    TissueTangent tangent;
    operator_.linearise({u, still}, 0.0, true, tangent);
    std::vector<double> whole, excess, cheap(body_.elements.size(), 0.0), rank_one = cheap;
    for (std::size_t e = 0; e < body_.elements.size(); ++e) {
      const Tensor A = 0.5 * (tangent.local[e] + tangent.local[e].transpose());
      whole.push_back(body_.rest[e].volume * rank_one_norm(A));
      excess.push_back(body_.rest[e].volume * rank_one_norm(positive_part(A - at_rest_[e])));
    }
    ElementWatch watch;
    watch.list_above.assign(body_.blocks.size(), 1.0);
    std::vector<Vec3d> elastic(u.size()), viscous(u.size());
    operator_.forces({u, still}, elastic, viscous, watch);
    for (const StiffElement& e : watch.stiff) {
      const LameParameters at_rest = body_.blocks[0].elastic;
      const double volume = body_.rest[e.element].volume, m = volume * modulus_bound(at_rest), more = e.ratio - 1.0;
      cheap[e.element] = m * std::min(more, e.norm);
      rank_one[e.element] = std::min(volume * more * (at_rest.lambda + 2.0 * at_rest.mu), m * e.norm);
    }
    const auto steps = [&](double square) { return time * std::sqrt(square) / (2.0 * kSafety); };
    exact_ += steps(squared_frequency(operator_, tangent, mode_));
    shares_ += steps(by_shares(body_, whole));
    excess_ += steps(rest_ + by_shares(body_, excess));
    cheap_ += steps(rest_ + by_shares(body_, cheap));
    rank_one_ += steps(rest_ + by_shares(body_, rank_one));
    rows_ += steps(rest_ + by_rows(body_, rank_one));
  }

  const TetMesh& mesh_;
  Body body_;
  TissueOperator operator_;
  std::vector<Tensor, Eigen::aligned_allocator<Tensor>> at_rest_;
  std::vector<Vec3d> mode_;
  double rest_ = 0.0, exact_ = 0.0, shares_ = 0.0, excess_ = 0.0, cheap_ = 0.0, rank_one_ = 0.0, rows_ = 0.0;
};

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw std::invalid_argument("name the liver's mesh, and laws if not all are meant");
    TetMesh mesh = read_mesh(argv[1]).mesh;
    mesh.regions.clear();
    std::vector<std::string> laws(argv + 2, argv + argc);
    if (laws.empty()) laws = {"corotational", "green", "neo_hookean", "yeoh", "veronda_westmann"};
    std::printf(
        "| law | steps | exact h\\* | shares | rest + excess | rest + ratio and norm | rest + rank-one | by rows |\n"
        "|---|---|---|---|---|---|---|---|\n");
    for (const std::string& law : laws) Trial(mesh, tissue_of(law)).run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "step_bounds: %s\n", error.what());
    return 1;
  }
  return 0;
}
