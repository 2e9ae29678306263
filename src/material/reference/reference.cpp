#include "material/reference/reference.h"

#include <cmath>

namespace glisson::reference {
namespace {

Eigen::Vector3d to_eigen(const Vec3d& v) { return {v.x, v.y, v.z}; }

template <class Entry>
ElementTensors for_each_pair(Entry entry) {
  ElementTensors K;
  for (std::size_t j = 0; j < 4; ++j) {
    for (std::size_t k = 0; k < 4; ++k) K[j][k] = entry(j, k);
  }
  return K;
}

Corners corners(const Tet& t, std::span<const Vec3d> values) {
  return {to_eigen(values[t[0]]), to_eigen(values[t[1]]), to_eigen(values[t[2]]), to_eigen(values[t[3]])};
}

void add(std::vector<Vec3d>& sum, const Tet& t, const Corners& f) {
  for (std::size_t a = 0; a < 4; ++a) sum[t[a]] += Vec3d{f[a].x(), f[a].y(), f[a].z()};
}

/// F = Σ_a x_a ⊗ s_a.
Tensor deformation_gradient(const Corners& rest, const Corners& u) {
  const Corners s = gradients(rest).s;
  Tensor F = Tensor::Zero();
  for (std::size_t a = 0; a < 4; ++a) F += (rest[a] + u[a]) * s[a].transpose();
  return F;
}

/// 12 (3V)^⅔ / Σ l², 0 for an inverted tetrahedron.
double liu_joe_mean_ratio(const Corners& x) {
  const double volume = (x[1] - x[0]).dot((x[2] - x[0]).cross(x[3] - x[0])) / 6.0;
  if (volume <= 0.0) return 0.0;
  double squares = 0.0;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 4; ++b) squares += (x[a] - x[b]).squaredNorm();
  }
  return 12.0 * std::pow(3.0 * volume, 2.0 / 3.0) / squares;
}

}  // namespace

Gradients gradients(const Corners& rest) {
  Tensor D_m;
  D_m << rest[1] - rest[0], rest[2] - rest[0], rest[3] - rest[0];
  const Tensor inverse = D_m.inverse();
  Gradients g{{}, D_m.determinant() / 6.0};
  for (int a = 0; a < 3; ++a) g.s[static_cast<std::size_t>(a) + 1] = inverse.row(a).transpose();
  g.s[0] = -(g.s[1] + g.s[2] + g.s[3]);
  return g;
}

ElementTensors tensors_A(const Gradients& g) {
  return for_each_pair([&](std::size_t j, std::size_t k) -> Tensor { return g.volume * g.s[j] * g.s[k].transpose(); });
}

ElementTensors tensors_B(const Gradients& g) {
  return for_each_pair([&](std::size_t j, std::size_t k) -> Tensor {
    return g.volume * (g.s[k] * g.s[j].transpose() + g.s[j].dot(g.s[k]) * Tensor::Identity());
  });
}

ElementTensors stiffness_tensors(const Gradients& g, LameParameters lame) {
  const ElementTensors A = tensors_A(g), B = tensors_B(g);
  return for_each_pair(
      [&](std::size_t j, std::size_t k) -> Tensor { return lame.lambda * A[j][k] + lame.mu * B[j][k]; });
}

ElementTensors viscous_tensors(const Gradients& g, const Tissue& tissue) {
  const double eta = tissue.viscosity;
  switch (tissue.viscous_tensor) {
    case ViscousTensor::shear:
      return stiffness_tensors(g, {0.0, eta});
    case ViscousTensor::deviatoric:
      return stiffness_tensors(g, {-2.0 * eta / 3.0, eta});
    case ViscousTensor::pioletti:
      return stiffness_tensors(g, {0.0, 0.0});  // none at rest; of large strain, material/reference/reference_stress.h
    case ViscousTensor::proportional:
      break;
  }
  const LameParameters lame = tissue.lame();
  const double ratio = eta / tissue.youngs_modulus;
  return stiffness_tensors(g, {ratio * lame.lambda, ratio * lame.mu});
}

double measure(const Tissue& tissue, const Corners& rest, const Corners& u) {
  if (tissue.measure == DeformationMeasure::regular_mean_ratio) {
    return liu_joe_mean_ratio({rest[0] + u[0], rest[1] + u[1], rest[2] + u[2], rest[3] + u[3]});
  }
  const Tensor F = deformation_gradient(rest, u);
  const double J = F.determinant();
  const double q = J > 0.0 ? 3.0 * std::pow(J, 2.0 / 3.0) / (F.transpose() * F).trace() : 0.0;
  const double p = std::max(0.0, 1.0 - q);
  return tissue.measure == DeformationMeasure::one_minus_q ? p : std::sqrt(1.5 * p);
}

Corners force_of(const ElementTensors& K, const Corners& u) {
  Corners f;
  for (std::size_t j = 0; j < 4; ++j) {
    f[j].setZero();
    for (std::size_t k = 0; k < 4; ++k) f[j] -= K[j][k] * u[k];
  }
  return f;
}

Corners elastic_force(const Tissue& tissue, const Corners& rest, const Corners& u) {
  return force_of(stiffness_tensors(gradients(rest), lame_at(tissue, measure(tissue, rest, u))), u);
}

Corners viscous_force(const Tissue& tissue, const Corners& rest, const Corners& velocity) {
  return force_of(viscous_tensors(gradients(rest), tissue), velocity);
}

MeshForces mesh_forces(const TetMesh& mesh, const std::map<int, Tissue>& tissues, std::span<const Vec3d> u,
                       std::span<const Vec3d> velocity) {
  MeshForces f{std::vector<Vec3d>(mesh.vertices.size()), std::vector<Vec3d>(mesh.vertices.size())};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tissue& tissue = tissues.at(mesh.region_of(t));
    const Corners rest = corners(mesh.tets[t], mesh.vertices);
    add(f.elastic, mesh.tets[t], elastic_force(tissue, rest, corners(mesh.tets[t], u)));
    add(f.viscous, mesh.tets[t], viscous_force(tissue, rest, corners(mesh.tets[t], velocity)));
  }
  return f;
}

EdgeTensors assemble_edges(const TetMesh& mesh, const std::map<int, Tissue>& tissues) {
  EdgeTensors K{std::vector<Tensor>(mesh.vertices.size(), Tensor::Zero()), {}};
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    const Tet& v = mesh.tets[t];
    const ElementTensors k =
        stiffness_tensors(gradients(corners(v, mesh.vertices)), tissues.at(mesh.region_of(t)).lame());
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = 0; b < 4; ++b) {
        if (a == b) {
          K.vertex[v[a]] += k[a][a];
        } else {
          K.edge.try_emplace({v[a], v[b]}, Tensor::Zero()).first->second += k[a][b];
        }
      }
    }
  }
  return K;
}

std::vector<Vec3d> edge_forces(const EdgeTensors& K, std::span<const Vec3d> u) {
  std::vector<Eigen::Vector3d> f(K.vertex.size());
  for (std::size_t i = 0; i < f.size(); ++i) f[i] = -K.vertex[i] * to_eigen(u[i]);
  for (const auto& [ij, tensor] : K.edge) f[ij.first] -= tensor * to_eigen(u[ij.second]);
  std::vector<Vec3d> out;
  for (const auto& v : f) out.push_back({v.x(), v.y(), v.z()});
  return out;
}

Eigen::SparseMatrix<double> stiffness_matrix(const TetMesh& mesh, const std::map<int, Tissue>& tissues) {
  const EdgeTensors K = assemble_edges(mesh, tissues);
  std::vector<Eigen::Triplet<double>> entries;
  const auto put = [&](std::size_t i, std::size_t j, const Tensor& k) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c)
        entries.emplace_back(static_cast<int>(3 * i) + r, static_cast<int>(3 * j) + c, k(r, c));
    }
  };
  for (std::size_t i = 0; i < K.vertex.size(); ++i) put(i, i, K.vertex[i]);
  for (const auto& [ij, tensor] : K.edge) put(ij.first, ij.second, tensor);
  const int n = static_cast<int>(3 * mesh.vertices.size());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

}  // namespace glisson::reference
