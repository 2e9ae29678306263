// Elements that are stiffer than a limit are listed, by lanes as by the scalar loops: none is missed, and none is made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "engine/element_body.h"
#include "engine/engine_run.h"
#include "material/every_tissue.h"

namespace glisson {
namespace {

std::map<std::uint32_t, StiffElement> listed(MovingBody& moving, std::span<const Vec3d> u, double limit,
                                             std::span<const StiffLimit> single = {}) {
  moving.set_state(u, std::vector<Vec3d>(u.size()));
  moving.list_above(std::vector<double>{limit}, single);
  std::map<std::uint32_t, StiffElement> all;
  for (const StiffElement& s : moving.advance(0.0, {}, false).stiff) all[s.element] = s;
  return all;
}

/// A jittered box whose vertices have moved by up to a third of a cell: some tets are squashed, some inside out.
struct Shaken {
  TetMesh mesh;
  std::vector<Vec3d> u;
  Shaken() {
    std::mt19937 random(8);
    mesh = test::jittered_box({5, 5, 5}, 0.01, 0.2, random);
    u = test::random_field(mesh.vertices.size(), 0.0035, random);
  }
};

/// Limits of single elements: every third a little above what was told of it, every third a little below, the others 0.
std::vector<StiffLimit> limits_about(const std::map<std::uint32_t, StiffElement>& told, std::size_t elements) {
  std::vector<StiffLimit> limits(elements);
  std::size_t k = 0;
  for (const auto& [e, s] : told) {
    const double share = k++ % 3 == 0 ? 1.01 : 0.99;
    if (k % 3 != 0) limits[e] = {static_cast<float>(share * s.ratio), static_cast<float>(share * s.norm)};
  }
  return limits;
}

std::vector<std::uint32_t> keys(const std::map<std::uint32_t, StiffElement>& told) {
  std::vector<std::uint32_t> all;
  for (const auto& [e, s] : told) all.push_back(e);
  return all;
}

// Every tissue with large strain or a law, in every instruction set: what is above the limit by more than rounding is listed, with
// ratio and norm of the double loop, or up to twice those where lanes take both halves of a law's bound at the larger one; what is
// below half the limit is not. Without a limit nothing is. Of single elements with limits of their own only those above theirs are.
TEST(StiffList, IsThatOfTheScalarLoop) {
  const Shaken shaken;
  std::vector<Tissue> tissues = test::hyperelastic_tissues();
  for (const Tissue& t : test::tensor_mass_tissues()) {
    if (engine::has_lanes(t)) tissues.push_back(t);
  }
  for (const Tissue& tissue : tissues) {
    SCOPED_TRACE(tissue.name);
    const Body body = build_body(shaken.mesh, {{0, tissue}});
    const std::vector<double> none(body.vertex_count, 0.0);
    engine::ElementBody exact(body, none, Precision::double_precision);
    constexpr double kLimit = 2.0, kRounding = 0.02;
    const auto below = listed(exact, shaken.u, 0.5 * kLimit * (1.0 - kRounding)),
               above = listed(exact, shaken.u, kLimit * (1.0 + kRounding));
    for (const engine::Kernels* kernels : test::every_kernels()) {
      engine::SubmeshBody lanes(body, none, {.threads = 1, .kernels = kernels});
      EXPECT_TRUE(listed(lanes, shaken.u, std::numeric_limits<double>::infinity()).empty());
      const auto told = listed(lanes, shaken.u, kLimit);
      for (const auto& [e, s] : above) EXPECT_TRUE(told.contains(e)) << e << " of ratio " << s.ratio;
      for (const auto& [e, s] : told) {
        ASSERT_TRUE(below.contains(e)) << e << " of ratio " << s.ratio;
        EXPECT_GE(s.ratio, below.at(e).ratio * (1.0 - kRounding));
        EXPECT_LE(s.ratio, below.at(e).ratio * 2.0 * (1.0 + kRounding));
        EXPECT_GE(s.norm, below.at(e).norm * (1.0 - kRounding));
      }
      const std::vector<StiffLimit> single = limits_about(told, body.elements.size());
      const auto left = listed(lanes, shaken.u, kLimit, single);
      std::map<std::uint32_t, StiffElement> expected = told;
      std::erase_if(expected, [&](const auto& s) { return single[s.first].covers(s.second); });
      EXPECT_EQ(keys(left), keys(expected));
      EXPECT_LT(left.size(), std::max<std::size_t>(1, told.size()));
    }
  }
}

}  // namespace
}  // namespace glisson
