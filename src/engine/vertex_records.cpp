#include "engine/vertex_records.h"

#include <algorithm>

namespace glisson::engine {

void VertexRecords::reset(std::size_t count) {
  state_.assign(count * kStateDoubles, 0.0);
  masses_.assign(count, 0.0), damping_.assign(count, 0.0);
  rests_.assign(count, 0);
  weighs_.clear();
  for (std::size_t record = 0; record < count; ++record) set_coefficients(record);
}

void VertexRecords::add_copy(std::size_t origin) {
  state_.resize(state_.size() + kStateDoubles);
  std::copy_n(at(origin), kStateDoubles, at(size()));
  masses_.push_back(0.0), damping_.push_back(0.0);
  rests_.push_back(0);
  if (!weighs_.empty()) weighs_.push_back(1.0);
  set_coefficients(size() - 1);
}

void VertexRecords::set_mass(std::size_t record, double mass, double heavy) {
  masses_[record] = mass;
  if (!weighs_.empty() || mass != heavy) {
    weighs_.resize(size(), 1.0);
    weighs_[record] = mass > 0.0 ? heavy / mass : 1.0;
  }
  set_coefficients(record);
}

void VertexRecords::set_damping(std::size_t record, double damping) {
  damping_[record] = damping;
  set_coefficients(record);
}

void VertexRecords::rest(std::span<const std::uint32_t> records) {
  std::vector<char> before(size(), 0);
  before.swap(rests_);
  for (const std::uint32_t record : records) {
    rests_[record] = 1;
    set_velocity(record, {});
  }
  for (std::size_t record = 0; record < size(); ++record) {
    if (before[record] != rests_[record]) set_coefficients(record);
  }
}

void VertexRecords::set_step(double h) {
  if (h == step_) return;
  step_ = h;
  for (std::size_t record = 0; record < size(); ++record) set_coefficients(record);
}

void VertexRecords::set_coefficients(std::size_t record) {
  const double denominator = masses_[record] + damping_[record] * step_;
  const bool moves = masses_[record] > 0.0 && rests_[record] == 0;
  at(record)[3] = moves ? step_ / denominator : 0.0;
  at(record)[7] = moves ? damping_[record] * step_ / denominator : 1.0;
}

std::vector<Vec3d> VertexRecords::displacements(std::span<const std::uint32_t> records) const {
  std::vector<Vec3d> u;
  u.reserve(records.size());
  for (const std::uint32_t r : records) u.push_back(displacement(r));
  return u;
}

}  // namespace glisson::engine
