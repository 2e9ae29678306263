// What a vertex's record keeps of its mass and damping: the coefficients of a step, c = h/(m + γh) and d = γh/(m + γh).
#include "engine/vertex_records.h"

#include <gtest/gtest.h>

namespace glisson {
namespace {

constexpr double kMass = 0.25, kDamping = 2.0, kStep = 0.125;  // binary fractions: m + γh = 1/2, all exact

engine::VertexRecords one_record() {
  engine::VertexRecords records;
  records.reset(1);
  records.set_mass(0, kMass, kMass);
  records.set_damping(0, kDamping);
  return records;
}

void expect_coefficients(const engine::VertexRecords& records, std::size_t record, double c, double d) {
  EXPECT_EQ(records.at(record)[3], c);
  EXPECT_EQ(records.at(record)[7], d);
}

// They follow the step, and what changes while the step stays.
TEST(VertexRecords, CoefficientsFollowStepMassAndDamping) {
  engine::VertexRecords records = one_record();
  expect_coefficients(records, 0, 0.0, 0.0);
  records.set_step(kStep);
  expect_coefficients(records, 0, 0.25, 0.5);
  records.set_mass(0, 0.75, kMass);
  expect_coefficients(records, 0, 0.125, 0.25);
  records.set_damping(0, 0.0);
  expect_coefficients(records, 0, kStep / 0.75, 0.0);
}

// Without mass, or at rest, a vertex keeps its place: c = 0, d = 1. Rest takes its velocity.
TEST(VertexRecords, NothingMovesWithoutMassOrAtRest) {
  engine::VertexRecords records = one_record();
  records.set_step(kStep);
  records.set_state(0, {1.0, 2.0, 3.0}, {4.0, 5.0, 6.0});
  records.add_copy(0);
  EXPECT_EQ(records.displacement(1), records.displacement(0));
  EXPECT_EQ(records.velocity(1), records.velocity(0));
  expect_coefficients(records, 1, 0.0, 1.0);
  const std::vector<std::uint32_t> first{0};
  records.rest(first);
  EXPECT_EQ(records.velocity(0), Vec3d{});
  expect_coefficients(records, 0, 0.0, 1.0);
  records.rest({});
  expect_coefficients(records, 0, 0.25, 0.5);
}

// Gravity acts on the share of the mass that has weight; where all has, no shares are kept.
TEST(VertexRecords, KickKnowsWhatWeighs) {
  engine::VertexRecords records = one_record();
  EXPECT_EQ(records.kick_from({}, 0).weighs, nullptr);
  records.set_mass(0, 1.0, kMass);
  EXPECT_EQ(*records.kick_from({}, 0).weighs, 0.25);
}

}  // namespace
}  // namespace glisson
