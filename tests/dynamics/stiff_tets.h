// stiff_tets.h — small bodies with a few stiff tets, and the dense spectra that their step is held against.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "dynamics/step/stable_step.h"
#include "element/stiff_element.h"
#include "support/bodies.h"

namespace glisson::test {

/// A jittered box of 40 tets in two tissues.
inline Body small_body(std::mt19937& random, double viscosity = 0.0) {
  TetMesh mesh = test::jittered_box({2, 2, 2}, 0.01, 0.2, random);
  mesh.regions.assign(mesh.tets.size(), 0);
  for (std::size_t t = mesh.tets.size() / 2; t < mesh.tets.size(); ++t) mesh.regions[t] = 1;
  Tissue soft, firm;
  soft.viscosity = viscosity;
  firm.youngs_modulus *= 5.0, firm.density *= 2.0;
  return build_body(mesh, {{0, soft}, {1, firm}});
}

/// Adds factor times the stiffness of an element: λ tr(H)² + 2 μ ‖sym H‖², or with `norm` the bound m ‖H‖² of it.
inline void add_element(const Body& body, std::uint32_t e, const LameParameters& lame, double factor, bool norm,
                        Eigen::MatrixXd& K) {
  const ElementRest& rest = body.rest[e];
  const std::array<Vec3d, 4> s{-(rest.s[0] + rest.s[1] + rest.s[2]), rest.s[0], rest.s[1], rest.s[2]};
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = 0; b < 4; ++b) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const double same = i == j ? dot(s[a], s[b]) : 0.0;
          const double value = norm ? modulus_bound(lame) * same
                                    : lame.lambda * s[a][i] * s[b][j] + lame.mu * (same + s[a][j] * s[b][i]);
          K(static_cast<Eigen::Index>(3 * body.elements[e][a] + i),
            static_cast<Eigen::Index>(3 * body.elements[e][b] + j)) += factor * rest.volume * value;
        }
      }
    }
  }
}

inline double top_eigenvalue(const Body& body, const Eigen::MatrixXd& K) {
  Eigen::VectorXd scale(K.rows());
  for (Eigen::Index i = 0; i < K.rows(); ++i) scale(i) = 1.0 / std::sqrt(body.masses[static_cast<std::size_t>(i) / 3]);
  const Eigen::MatrixXd A = scale.asDiagonal() * K * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(A, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

/// Elements that have become stiff, all with the same norm and ratio, or with a norm that is a fraction of it.
inline std::vector<StiffElement> some_stiff(const Body& body, std::size_t count, bool by_norm, std::mt19937& random) {
  std::vector<StiffElement> stiff;
  for (std::size_t i = 0; i < count; ++i) {
    const auto e = static_cast<std::uint32_t>(random() % body.elements.size());
    const double ratio = std::pow(10.0, 0.5 + 3.0 * static_cast<double>(random() % 1000) * 1e-3);
    if (std::any_of(stiff.begin(), stiff.end(), [&](const StiffElement& s) { return s.element == e; })) continue;
    stiff.push_back({e, ratio, by_norm ? 0.2 * ratio : ratio});
  }
  return stiff;
}

}  // namespace glisson::test
