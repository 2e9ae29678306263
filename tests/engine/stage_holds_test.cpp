// Takes what rows hold from changes of velocities: δ − M⁻¹Bᵀ(BM⁻¹Bᵀ + c)⁻¹Bδ by dense matrices in double is the oracle.
#include "engine/stage_holds.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "glisson/archive.h"

namespace glisson::engine {
namespace {

/// Rows of means of three vertices out of some, in pairs of directions, a third of them in groups of two; vertices held as a whole.
struct Held {
  HeldRows rows;
  Eigen::MatrixXd B, c;
  std::vector<ActiveVertex> active;
  std::vector<Vec3d> inverse_mass;
};

Held some_rows(std::size_t vertices, std::size_t means, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0.1, 1.0);
  Held h;
  for (std::uint32_t v = 0; v < vertices; ++v) {
    if (v == 5) continue;  // is not active
    h.active.push_back({.vertex = v, .elastic = {}, .viscous = {}, .displacement = {}, .velocity = {}});
    h.inverse_mass.push_back({1e3 * part(random), v == 7 ? 0.0 : 1e3 * part(random), 1e3 * part(random)});
  }
  const auto place = [&](std::uint32_t v) { return v < 5 ? v : v - 1; };
  std::vector<std::vector<double>> rows;
  std::vector<double> own;                          // c of rows without a group, and on the diagonal of groups
  std::vector<std::array<std::size_t, 2>> coupled;  // rows of a group
  for (std::size_t m = 0; m < means; ++m) {
    std::vector<VertexWeight> mean;
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto v = static_cast<std::uint32_t>((3 * m / 2 + 2 * k) % vertices);
      mean.push_back({v, part(random)});
    }
    const std::uint32_t number = h.rows.add_mean(mean);
    const bool known = std::ranges::none_of(mean, [](const VertexWeight& w) { return w.vertex == 5; });
    for (const Vec3d& direction : {Vec3d{0.6, 0.8, 0.0}, Vec3d{0.0, 0.0, 1.0}}) {
      h.rows.add_row(number, direction);
      if (!known) continue;
      std::vector<double>& row = rows.emplace_back(3 * h.active.size());
      for (const VertexWeight& w : mean) {
        for (std::size_t axis = 0; axis < 3; ++axis) row[3 * place(w.vertex) + axis] += w.weight * direction[axis];
      }
      own.push_back(m % 3 == 0 ? 300.0 : 0.0);
    }
    if (m % 3 != 0) continue;
    h.rows.end_group(std::array{300.0, 100.0, 100.0, 300.0});
    if (known) coupled.push_back({rows.size() - 2, rows.size() - 1});
  }
  for (const std::uint32_t v : {std::uint32_t{2}, static_cast<std::uint32_t>(vertices - 1)}) {
    h.rows.add_vertex(v);
    for (std::size_t axis = 0; axis < 3; ++axis)
      rows.emplace_back(3 * h.active.size())[3 * place(v) + axis] = 1.0, own.push_back(0.0);
  }
  h.B.resize(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(3 * h.active.size()));
  h.c = Eigen::MatrixXd::Zero(h.B.rows(), h.B.rows());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto at = static_cast<Eigen::Index>(r);
    h.B.row(at) = Eigen::Map<const Eigen::RowVectorXd>(rows[r].data(), h.B.cols());
    h.c(at, at) = own[r];
  }
  for (const auto& [a, b] : coupled) {
    h.c(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) = 100.0;
    h.c(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) = 100.0;
  }
  return h;
}

class StageHoldsOfSize : public testing::TestWithParam<std::pair<std::size_t, std::size_t>> {};

TEST_P(StageHoldsOfSize, TakesWhatRowsHold) {
  const auto [vertices, means] = GetParam();
  const Held h = some_rows(vertices, means, 3);
  const auto n = static_cast<Eigen::Index>(3 * h.active.size());
  std::mt19937 random(11);
  std::normal_distribution<double> change;
  Eigen::VectorXd delta(n), inverse(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    delta[i] = change(random);
    inverse[i] = h.inverse_mass[static_cast<std::size_t>(i) / 3][static_cast<std::size_t>(i) % 3];
    if (inverse[i] == 0.0) delta[i] = 0.0;  // does not move
  }
  const Eigen::MatrixXd moved = inverse.asDiagonal() * h.B.transpose();
  const Eigen::VectorXd wanted =
      delta - moved * (h.B * moved + h.c).completeOrthogonalDecomposition().solve(h.B * delta);

  StageHolds holds;
  for (int again = 0; again < 2; ++again) holds.set(h.rows, h.active, h.inverse_mass);
  std::vector<Vec3d> changes;
  const auto vector_at = [](const Eigen::VectorXd& x, std::uint32_t place) {
    return Vec3d{x[3 * place], x[3 * place + 1], x[3 * place + 2]};
  };
  for (const std::uint32_t place : holds.places()) changes.push_back(vector_at(delta, place));
  holds.project(changes);
  for (std::size_t k = 0; k < changes.size(); ++k) {
    const Vec3d off = changes[k] - vector_at(wanted, holds.places()[k]);
    EXPECT_LT(norm(off), 1e-6) << "place " << holds.places()[k];
  }
  const double before = delta.norm();
  EXPECT_GT((wanted - delta).norm(), 0.1 * before) << "the rows hold something";
}

INSTANTIATE_TEST_SUITE_P(Sizes, StageHoldsOfSize,
                         testing::Values(std::pair{std::size_t{24}, std::size_t{8}},
                                         std::pair{std::size_t{240}, std::size_t{90}}),
                         [](const auto& sizes) { return sizes.param.second < 48 ? "Dense" : "Sparse"; });

TEST(HeldRows, AreRefusedAndReadBack) {
  Held h = some_rows(24, 8, 5);
  EXPECT_THROW(h.rows.end_group(std::array{1.0, 2.0}), std::invalid_argument);
  HeldRows read;
  restore(read, archived(h.rows));
  EXPECT_TRUE(read == h.rows);
  std::string cut = archived(h.rows);
  cut.resize(cut.size() / 2);
  EXPECT_THROW(restore(read, cut), std::runtime_error);
}

}  // namespace
}  // namespace glisson::engine
