#include "lab/meridian_solid.h"

namespace glisson::lab {
namespace {

/// The unknowns of each element.
std::vector<std::vector<std::size_t>> unknowns_of(const std::vector<MeridianElement>& elements) {
  std::vector<std::vector<std::size_t>> groups;
  for (const MeridianElement& e : elements) {
    std::vector<std::size_t>& group = groups.emplace_back();
    for (const std::size_t vertex : e.vertices) group.insert(group.end(), {2 * vertex, 2 * vertex + 1});
  }
  return groups;
}

}  // namespace

void MeridianState::extrapolate(const MeridianState& last, const MeridianState& before, double ahead) {
  for (std::size_t k = 0; k < u.size(); ++k) u[k] += ahead * (last.u[k] - before.u[k]);
  for (std::size_t e = 0; e < pressures.size(); ++e)
    for (std::size_t a = 0; a < 3; ++a) pressures[e][a] += ahead * (last.pressures[e][a] - before.pressures[e][a]);
}

MeridianSolid::MeridianSolid(std::shared_ptr<const MeridianMesh> mesh, const HyperelasticLaw& law)
    : force(2 * mesh->columns() * mesh->rows()), tangent(force.size(), unknowns_of(mesh->elements)),
      mesh_(std::move(mesh)), law_(law), pressures_(mesh_->elements.size()) {}

MeridianState MeridianSolid::at_rest() const {
  return {std::vector<double>(unknowns(), 0.0), std::vector<MeridianElement::Linear>(pressures_.size())};
}

bool MeridianSolid::assemble(const MeridianState& state) {
  std::fill(force.begin(), force.end(), 0.0);
  tangent.clear();
  for (std::size_t index = 0; index < mesh_->elements.size(); ++index) {
    const MeridianElement& e = mesh_->elements[index];
    const auto dof = [&](std::size_t i) { return 2 * e.vertices[i / 2] + i % 2; };
    MeridianElement::Vector u;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = state.u[dof(i)];
    const MeridianElement::Answer a = e.answer(law_, u, state.pressures[index]);
    if (a.folded) return false;
    pressures_[index] = a.pressure;
    for (std::size_t i = 0; i < u.size(); ++i) force[dof(i)] += a.force[i];
    tangent.add(index, a.tangent);
  }
  return true;
}

void MeridianSolid::take(const std::vector<double>& step, MeridianState& state) const {
  for (std::size_t k = 0; k < step.size(); ++k) state.u[k] -= step[k];
  for (std::size_t index = 0; index < pressures_.size(); ++index) {
    const MeridianElement& e = mesh_->elements[index];
    for (std::size_t a = 0; a < 3; ++a) {
      double& p = state.pressures[index][a];
      p = pressures_[index].value[a];
      for (std::size_t i = 0; i < MeridianElement::kUnknowns; ++i)
        p -= pressures_[index].by_u[a][i] * step[2 * e.vertices[i / 2] + i % 2];
    }
  }
}

}  // namespace glisson::lab
