// samples.h — random tissues and bodies: what the element loops are compared on.
#pragma once

#include <map>
#include <random>
#include <vector>

#include "glisson/material/tissue.h"
#include "support/bodies.h"
#include "support/law_examples.h"

namespace glisson::test {

/// Laws on E or on λ and μ, every measure and viscous tensor.
inline Tissue random_tissue() {
  Tissue tissue;
  tissue.youngs_modulus = number(500.0, 50000.0);
  tissue.poisson_ratio = number(-0.3, 0.49);
  tissue.viscosity = number(0.0, 2000.0);
  tissue.viscous_tensor = static_cast<ViscousTensor>(integer(0, 3));
  tissue.measure = static_cast<DeformationMeasure>(integer(0, 3));
  if (integer(0, 4) == 0) {
    tissue.lambda_law = random_law(std::abs(tissue.lame().lambda));
    tissue.mu_law = random_law(tissue.lame().mu);
  } else {
    tissue.law = random_law(tissue.youngs_modulus);
  }
  return tissue;
}

/// A random mesh of two tissues in a random state of up to 20 % strain.
struct Sample {
  std::mt19937 random;
  double cell;  ///< edge of a cube [m]
  TetMesh mesh;
  std::map<int, Tissue> tissues;
  std::vector<Vec3d> u, v;

  Sample() : random(static_cast<unsigned>(integer(1, 1000000))), cell(number(0.001, 0.05)) {
    mesh = jittered_box({integer(1, 4), integer(1, 4), integer(1, 4)}, cell, 0.2, random);
    for (std::size_t t = 0; t < mesh.tets.size(); ++t) mesh.regions.push_back(static_cast<int>(random() % 2));
    tissues = {{0, random_tissue()}, {1, random_tissue()}};
    u = random_field(mesh.vertices.size(), number(0.001, 0.1) * cell, random);
    v = random_field(mesh.vertices.size(), 0.01, random);
  }
};

}  // namespace glisson::test
