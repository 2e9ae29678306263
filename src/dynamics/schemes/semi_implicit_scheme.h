// semi_implicit_scheme.h — the paper's scheme with the viscous force taken at the end of the kick.
//
//   (M + hγ + hC)(v₊ − v₋) = h [ f_elastic(u) + f_viscous(u, v₋) + external − γ v₋ ],   u(t+h) = u(t) + h v₊
//
// For small strain f_viscous(v₋) − C (v₊ − v₋) = −C v₊. A tissue of large strain has another viscous matrix as it turns; C
// stays that at rest, and only the change of velocity meets it. So the matrix is constant, and forces come from the same
// fast body as those of the explicit scheme, which watches all vertices here and moves none.
//
// Vertices move one another within such a step, so that interactions act as in a long step, through the factor of the matrix
// (step_contact.h); those that add forces only, as capsules do, act as in a short one. In tissue without viscosity all do.
#pragma once

#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "dynamics/schemes/explicit_scheme.h"
#include "dynamics/solvers/step_contact.h"
#include "dynamics/solvers/viscous_system.h"

namespace glisson {

class SemiImplicitScheme final : public ExplicitScheme {
 public:
  static constexpr IntegratorInfo kInfo{
      Integrator::semi_implicit,
      {.supports_interactions = true, .supports_them_in_viscous_tissue = false, .supports_contact = true}};

  /// @throws std::invalid_argument as Simulation's constructor
  SemiImplicitScheme(Body body, const SimulationOptions& options);

  /// An automatic step in which contact is not found is tried again, shorter.
  StepResult step() override;
  void archive_motion(Archive& ar) override;
  void attach(std::shared_ptr<Interaction> interaction, const BodyView& body) override;
  std::span<const std::shared_ptr<Interaction>> interactions() const override { return all_; }
  void tell_change(const BodyView& body, std::span<const std::uint32_t> origins) override;

 private:
  void prepare_to_give_up() override;
  bool kick(double h) override;
  void give_up(double h);
  std::string why_given_up(double h) const override;
  void constrain_interactions() override;
  void add_interface(KickWork& work) const override;
  double tool_energy() const override;
  void tell_moved() override;
  double choose_step(double h) const override;
  double added_frequency() const override;
  void take_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) override;
  void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new) override;
  void take_over(const BodyChange& change) override;
  void loads_changed(bool may_refuse) override;
  void require_tissues(const BlockTissues& tissues) const override;
  void take_tissues(const TissueChange& change) override;
  void watch_all_if_viscous();
  void load_layout(const std::shared_ptr<const void>& layout) override;
  std::size_t holding() const;
  std::vector<char> held_components() const;
  void build(double h);
  bool begin_contact(double h);
  bool solve(double h);
  std::vector<RestingVertex> resting() const;

  /// Whether C is not 0, or was not when interactions were attached; the kick is the explicit one otherwise.
  bool viscous_;
  ViscousSystem system_;
  StepContact contact_{state_, system_};                    ///< of what acts by impulses in viscous tissue
  std::vector<std::shared_ptr<Interaction>> all_;           ///< in the order in which they were attached
  std::vector<char> still_;                                 ///< per vertex: held by an interaction
  std::vector<Vec3d> start_, end_, before_, contact_push_;  ///< u(t), u(t + h) [m], v₋ [m/s], impulses [N s]
  double built_for_ = 0.0;                                  ///< h; 0: to be built
  std::size_t built_holding_ = 0;                           ///< number of constraints that held then
  std::vector<Vec3d> impulse_, change_, drag_;

  /// What a step goes back to in which contact is not found, beside what contact_ keeps.
  struct Backup {
    std::vector<ActiveVertex> active;
    std::string past;  ///< of the body
    ActiveKick::Kept kick;
    Interactions::Saved interactions;
  };
  Backup before_step_;
  double most_step_ = std::numeric_limits<double>::infinity();  ///< of automatic steps since contact was not found [s]
};

}  // namespace glisson
