// Elements that are stiffer than a limit are listed, by lanes as by the scalar loops: none is missed, and none is made up.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "engine/element_body.h"
#include "engine/engine_run.h"
#include "material/every_tissue.h"

namespace glisson {
namespace {

std::map<std::uint32_t, StiffElement> listed(MovingBody& moving, std::span<const Vec3d> u, double limit) {
  moving.set_state(u, std::vector<Vec3d>(u.size()));
  moving.list_above(std::vector<double>{limit});
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

// Every tissue with large strain or a law, in every instruction set: what is above the limit by more than rounding is listed, with
// ratio and norm of the double loop, or up to twice those where lanes take both halves of a law's bound at the larger one; what is
// below half the limit is not. Without a limit nothing is.
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
    }
  }
}

}  // namespace
}  // namespace glisson
