// bench_case.cpp — bodies and tissues of the benchmark.
#include "bench/bench_case.h"

#include <fmt/format.h>

#include <array>
#include <map>
#include <stdexcept>
#include <utility>

#include "bench/smooth_state.h"

namespace glisson::app {
namespace {

constexpr std::array<std::pair<Model, std::string_view>, 3> kModels{
    {{Model::linear, "linear"}, {Model::law, "law"}, {Model::full, "full"}}};

/// Figure 1's box, the same with cubes of 2 mm, and a cube with 55 a side, 998 250 tets.
const std::map<std::size_t, BoxOptions>& boxes() {
  static const std::map<std::size_t, BoxOptions> map{
      {768, {}}, {96'000, {.cells = {20, 20, 40}}}, {1'000'000, {.cells = {55, 55, 55}, .size = {0.04, 0.04, 0.04}}}};
  return map;
}

}  // namespace

std::string_view model_name(Model model) {
  for (const auto& [known, name] : kModels) {
    if (known == model) return name;
  }
  throw std::logic_error("a model without a name");
}

Model model_named(std::string_view name) {
  for (const auto& [model, known] : kModels) {
    if (known == name) return model;
  }
  throw std::invalid_argument(fmt::format("there is no model \"{}\"; the models are linear, law, full", name));
}

Tissue model_tissue(Model model) {
  Tissue tissue;
  tissue.name = model_name(model);
  if (model != Model::linear) tissue.law = LinearLaw{.slope = tissue.youngs_modulus / 0.5};
  if (model == Model::full) tissue.viscosity = 10.0;
  return tissue;
}

std::vector<std::size_t> known_sizes() {
  std::vector<std::size_t> sizes;
  for (const auto& [size, box] : boxes()) sizes.push_back(size);
  return sizes;
}

BenchBody box_body(std::size_t size) {
  const auto found = boxes().find(size);
  if (found == boxes().end()) throw std::invalid_argument(fmt::format("there is no body of {} tets", size));
  const auto& cells = found->second.cells;
  return file_body(fmt::format("box {}×{}×{}", cells[0], cells[1], cells[2]), box_mesh(found->second));
}

BenchBody file_body(std::string name, TetMesh mesh) {
  mesh.regions.clear();  // one tissue throughout
  auto displacement = smooth_displacement(mesh);
  auto velocity = smooth_velocity(mesh);
  return {std::move(name), std::move(mesh), std::move(displacement), std::move(velocity)};
}

}  // namespace glisson::app
