// bench_case.cpp — bodies and tissues of the benchmark.
#include "bench/bench_case.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "bench/smooth_state.h"

namespace glisson::app {
namespace {

constexpr double kShear = 3600.0 / 2.8, kBulk = 6000.0;  ///< of E = 3.6 kPa and ν = 0.4 [Pa]

Invariants of_invariants(bool exponentials) {
  Invariants law{.c10 = 0.2 * kShear, .c01 = 0.1 * kShear, .c20 = 0.1 * kShear, .c11 = 0.02 * kShear};
  law.c02 = 0.05 * kShear, law.c30 = 0.02 * kShear, law.bulk_modulus = kBulk;
  if (!exponentials) return law;
  law.a1 = 0.2 * kShear, law.b1 = 2.0, law.a2 = 0.2 * kShear, law.b2 = 1.0;
  law.q1 = 0.1 * kShear, law.r1 = 0.5, law.q2 = 0.1 * kShear, law.r2 = 0.5;
  return law;
}

HyperelasticLaw hyperelastic(Model model) {
  switch (model) {
    case Model::mooney_rivlin:
      return MooneyRivlin{.c10 = 0.35 * kShear, .c01 = 0.15 * kShear, .bulk_modulus = kBulk};
    case Model::yeoh:
      return Yeoh{.c1 = 0.5 * kShear, .c2 = 0.1 * kShear, .c3 = 0.1 * kShear, .bulk_modulus = kBulk};
    case Model::fung:
      return Fung{.mu = kShear, .b = 2.0, .bulk_modulus = kBulk};
    case Model::veronda_westmann:
      return VerondaWestmann{.c = 0.5 * kShear, .b = 2.0, .bulk_modulus = kBulk};
    case Model::ogden:
      return Ogden{.mu = {0.8 * kShear, 0.2 * kShear}, .alpha = {-4.7, 3.0}, .bulk_modulus = kBulk};
    case Model::gent:
      return Gent{.mu = kShear, .limit = 2.0, .bulk_modulus = kBulk};
    case Model::rivlin:
    case Model::invariants:
      return of_invariants(model == Model::invariants);
    default:
      return NeoHookean{.mu = kShear, .bulk_modulus = kBulk};
  }
}

/// Figure 1's box, the same with cubes of 2 mm, and a cube with 55 a side, 998 250 tets.
const std::map<std::size_t, BoxOptions>& boxes() {
  static const std::map<std::size_t, BoxOptions> map{
      {768, {}}, {96'000, {.cells = {20, 20, 40}}}, {1'000'000, {.cells = {55, 55, 55}, .size = {0.04, 0.04, 0.04}}}};
  return map;
}

/// Figure 1's box of as many cubes as come nearest, twice as many along z; six tets each.
BoxOptions box_of(std::size_t tets) {
  const double cubes = static_cast<double>(tets) / 6.0;
  const int side = std::max(1, static_cast<int>(std::lround(std::cbrt(0.5 * cubes))));
  const int length = std::max(1, static_cast<int>(std::lround(cubes / (side * side))));
  BoxOptions box{.cells = {side, side, length}};
  box.size[2] = box.size[0] * length / side;
  return box;
}

}  // namespace

Tissue model_tissue(Model model) {
  Tissue tissue;
  tissue.name = word_of(model);
  const LinearLaw doubling{.slope = tissue.youngs_modulus / 0.5};
  const bool follows = model == Model::law || model == Model::full || model == Model::law_branches;
  if (follows || model == Model::green_energy) tissue.law = doubling;
  if (model == Model::full) tissue.viscosity = 10.0;
  if (model == Model::corotational) tissue.kinematics = Kinematics::corotational;
  const bool green = model == Model::green || model == Model::green_energy || model == Model::fibres;
  if (green) tissue.kinematics = Kinematics::green;
  if (model == Model::green_energy) tissue.law_form = LawForm::energy;
  if (model == Model::fibres) tissue.fibres = Fibres{.direction = {1.0, 1.0, 0.0}, .stiffness = 3600.0};
  if (model >= Model::neo_hookean) tissue.hyperelastic = hyperelastic(model);
  if (model == Model::nodal) tissue.volume_change = VolumeChange::average_nodal;
  const bool relaxes = model == Model::maxwell || model == Model::branches || model == Model::law_branches;
  if (relaxes) tissue.maxwell = {{.share = 0.4, .time = 0.5}, {.share = 0.3, .time = 50.0}};
  if (model == Model::following) {
    tissue.maxwell = {{.share = 0.4, .time = 0.5, .time_law = PowerTime{.exponent = 1.0}},
                      {.share = 0.3, .time = 50.0, .time_law = ExponentialTime{.rate = 5.0}}};
  }
  return tissue;
}

std::vector<std::size_t> usual_sizes() {
  std::vector<std::size_t> sizes;
  for (const auto& [size, box] : boxes()) sizes.push_back(size);
  return sizes;
}

BenchBody box_body(std::size_t size) {
  const auto found = boxes().find(size);
  const BoxOptions box = found != boxes().end() ? found->second : box_of(size);
  return file_body(fmt::format("box {}×{}×{}", box.cells[0], box.cells[1], box.cells[2]), box_mesh(box));
}

BenchBody file_body(std::string name, TetMesh mesh) {
  mesh.regions.clear();  // one tissue throughout
  auto displacement = smooth_displacement(mesh);
  auto velocity = smooth_velocity(mesh);
  return {std::move(name), std::move(mesh), std::move(displacement), std::move(velocity)};
}

}  // namespace glisson::app
