// semi_implicit_scheme.h — the paper's scheme with the viscous force taken at the end of the kick.
//
//   (M + hγ + hC)(v₊ − v₋) = h [ f_elastic(u) + f_viscous(u, v₋) + external − γ v₋ ],   u(t+h) = u(t) + h v₊
//
// For small strain f_viscous(v₋) − C (v₊ − v₋) = −C v₊. A tissue of large strain has another viscous matrix as it turns; C
// stays that at rest, and only the change of velocity meets it. So the matrix is constant, and forces come from the same
// fast body as those of the explicit scheme, which watches all vertices here and moves none.
#pragma once

#include <vector>

#include "dynamics/schemes/explicit_scheme.h"
#include "dynamics/solvers/viscous_system.h"

namespace glisson {

class SemiImplicitScheme final : public ExplicitScheme {
 public:
  static constexpr IntegratorInfo kInfo{Integrator::semi_implicit,
                                        {.supports_interactions = true, .supports_them_in_viscous_tissue = false}};

  /// @throws std::invalid_argument as Simulation's constructor
  SemiImplicitScheme(Body body, const SimulationOptions& options);

  void archive_motion(Archive& ar) override;
  void attach(std::shared_ptr<Interaction> interaction, const BodyView& body) override;

 private:
  void kick(double h) override;
  void take_over(const BodyChange& change) override;
  void loads_changed(bool may_refuse) override;
  void require_tissues(const BlockTissues& tissues) const override;
  void take_tissues(const TissueChange& change) override;
  void watch_all_if_viscous();
  std::size_t holding() const;
  void build(double h);

  bool viscous_;  ///< whether C is not 0; the kick is the explicit one where it is
  ViscousSystem system_;
  double built_for_ = 0.0;         ///< h; 0: to be built
  std::size_t built_holding_ = 0;  ///< number of constraints that held then
  std::vector<Vec3d> impulse_, change_, drag_;
};

}  // namespace glisson
