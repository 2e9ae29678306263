// The semi-implicit step of a real organ is that of its elasticity: viscosity takes nothing off it, however small some tets are.
#include <gtest/gtest.h>

#include <filesystem>

#include "glisson/io.h"
#include "glisson/simulation/simulation.h"
#include "support/places.h"

namespace glisson {
namespace {

double step_of(const TetMesh& mesh, double viscosity, Integrator integrator) {
  Tissue tissue;
  tissue.youngs_modulus = 18388;
  tissue.poisson_ratio = 0.4;
  tissue.viscosity = viscosity;
  SimulationOptions options;
  options.integrator = integrator;
  return Simulation(mesh, {{0, tissue}}, options).stable_step();
}

// Its search did not converge with drag taken off, and fell back to a seventh of it.
TEST(LiverStep, SemiImplicitBearsViscosity) {  // long
  const std::filesystem::path file = test::shipped("../shared/data/meshes/liver.vtu");
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "the liver mesh is not here: " << file;
  TetMesh mesh = read_mesh(file.string()).mesh;
  mesh.regions.clear();
  const double elastic = step_of(mesh, 0.0, Integrator::central_difference);
  EXPECT_GE(step_of(mesh, 10.0, Integrator::semi_implicit), 0.999 * elastic);
  EXPECT_LT(step_of(mesh, 10.0, Integrator::central_difference), 0.2 * elastic);
}

}  // namespace
}  // namespace glisson
