// Inverted tets are told of: all of them and at once where a law looks, within sixteen steps where nothing does.
#include <gtest/gtest.h>

#include "engine/engine_run.h"

namespace glisson {
namespace {

/// Tets of the mesh with J ≤ 0, ascending.
std::vector<std::uint32_t> exact_list(const Body& body, std::span<const Vec3d> u) {
  std::vector<std::uint32_t> list;
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    const Mat3d H = element_gradient(body, e, u);
    const double J = determinant(Mat3d{
        {{{1.0 + H(0, 0), H(0, 1), H(0, 2)}, {H(1, 0), 1.0 + H(1, 1), H(1, 2)}, {H(2, 0), H(2, 1), 1.0 + H(2, 2)}}}});
    if (!(J > 0.0)) list.push_back(body.mesh_tet[e]);
  }
  std::sort(list.begin(), list.end());
  return list;
}

/// Tissues of every second tet.
struct Kind {
  const char* name;
  Tissue first, second;
  bool looks;  ///< whether both are looked at in every step
};
Tissue with_law() {
  Tissue tissue;
  tissue.law = LinearLaw{20000.0};
  return tissue;
}
Tissue hyperelastic(const HyperelasticLaw& law) {
  Tissue tissue;
  tissue.hyperelastic = law;
  return tissue;
}
Tissue of_kinematics(Kinematics kinematics) {
  Tissue tissue;
  tissue.kinematics = kinematics;
  return tissue;
}
Tissue relaxing(Kinematics kinematics) {
  Tissue tissue = of_kinematics(kinematics);
  tissue.maxwell = {{.share = 0.3, .time = 1.0}};
  return tissue;
}

class Inverted : public testing::TestWithParam<Kind> {
 protected:
  std::mt19937 random_{5};
  TetMesh mesh_ = test::jittered_box({5, 5, 5}, 0.01, 0.2, random_);
  Body body_ = make_body();
  std::vector<Vec3d> still_ = std::vector<Vec3d>(mesh_.vertices.size());
  std::vector<double> undamped_ = std::vector<double>(mesh_.vertices.size(), 0.0);
  engine::SubmeshBody moving_{body_, undamped_, {.threads = 1, .submesh_tets = 60}};

  Body make_body() {
    for (std::size_t t = 0; t < mesh_.tets.size(); ++t) mesh_.regions.push_back(static_cast<int>(t % 2));
    return build_body(mesh_, {{0, GetParam().first}, {1, GetParam().second}});
  }
  std::vector<Vec3d> affine(double x, double y, double z) const {
    std::vector<Vec3d> u;
    for (const Vec3d& p : mesh_.vertices) u.push_back({(x - 1.0) * p.x, (y - 1.0) * p.y, (z - 1.0) * p.z});
    return u;
  }
  void expect_exact(MovingBody& moving, double h) const {
    const std::vector<Vec3d> u = test::state_of(moving, still_.size()).u;
    EXPECT_EQ(moving.advance(h, {}, false).inverted, exact_list(body_, u));
  }
};

// States set one after the other, from none to many inverted tets and back: each list is exact at once.
TEST_P(Inverted, AreListedAtOnceWhenTheStateIsSet) {
  for (const double amount : {0.0, 0.001, 0.004, 0.006, 0.02, 0.0, 0.005}) {
    moving_.set_state(test::random_field(still_.size(), amount, random_), still_);
    expect_exact(moving_, 0.0);
  }
}

// Also when the body had large gradients before, none of them inverted.
TEST_P(Inverted, AreListedAtOnceAfterLargeGradients) {
  moving_.set_state(affine(3.0, 1.0, 1.0), still_);
  for (int i = 0; i < 3; ++i) expect_exact(moving_, 1e-9);
  moving_.set_state(test::random_field(still_.size(), 0.02, random_), still_);
  expect_exact(moving_, 1e-9);
}

// While a submesh has some, its list is exact in every step.
TEST_P(Inverted, StayExactWhileThereAreSome) {
  engine::SubmeshBody whole(body_, undamped_, {.threads = 1, .submesh_tets = mesh_.tets.size()});
  whole.set_state(test::random_field(still_.size(), 0.005, random_), test::random_field(still_.size(), 100.0, random_));
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    expect_exact(whole, 1e-6);  // 1 % of a cell a step
  }
}

// A linear tissue turns inside out in motion, its gradients large all along: told within sixteen steps, never before.
TEST_P(Inverted, AreFoundInMotion) {
  std::vector<Vec3d> v;
  for (const Vec3d& p : mesh_.vertices) v.push_back({0.0, -1e5 * p.y, 0.0});
  moving_.set_state(affine(3.0, 1.0, 1.0), v);
  int since = 0;
  for (int i = 0; i < 40; ++i) {
    const auto exact = exact_list(body_, test::state_of(moving_, still_.size()).u);
    const auto& list = moving_.advance(1e-6, {}, false).inverted;  // a tenth of the height a step
    since += exact.empty() ? 0 : 1;
    EXPECT_TRUE(std::includes(exact.begin(), exact.end(), list.begin(), list.end()));
    if (since > 16 || GetParam().looks) {
      EXPECT_EQ(list, exact) << i;
    }
  }
  EXPECT_GT(since, 16);
}

INSTANTIATE_TEST_SUITE_P(Tissues, Inverted,
                         testing::Values(Kind{"law", with_law(), with_law(), true}, Kind{"linear", {}, {}, false},
                                         Kind{"both", with_law(), {}, false},
                                         Kind{"invariants_and_stretches", hyperelastic(NeoHookean{.bulk_modulus = 1e4}),
                                              hyperelastic(Ogden{{1e3}, {2.0}, 1e4}), true},
                                         Kind{"corotational_and_green", of_kinematics(Kinematics::corotational),
                                              of_kinematics(Kinematics::green), true},
                                         Kind{"relaxing", relaxing(Kinematics::small),
                                              relaxing(Kinematics::corotational), true}),
                         [](const testing::TestParamInfo<Kind>& p) { return std::string(p.param.name); });

}  // namespace
}  // namespace glisson
