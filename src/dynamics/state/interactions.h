// interactions.h — the interactions of a body, and the vertices they have at hand.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "contact/step_solver.h"
#include "dynamics/state/constraints.h"
#include "glisson/archive.h"
#include "glisson/simulation/interaction.h"

namespace glisson {

class Interactions {
 public:
  void add(std::shared_ptr<Interaction> interaction) {
    all_.push_back(std::move(interaction)), named_.emplace_back(), rests_.emplace_back();
  }
  /// None of what they have named is let go from now on: a step may be taken back.
  void keep_all() { lets_go_ = false; }
  bool empty() const { return all_.empty(); }
  std::span<const std::shared_ptr<Interaction>> all() const { return all_; }

  /// Vertices that some interaction wants at hand in the coming step and that are not yet; ascending.
  std::span<const std::uint32_t> newcomers(double time, double h, std::size_t vertex_count);
  /// Whether some interaction has let vertices go since newcomers() was asked.
  bool has_left() const { return left_; }
  /// Whether what interactions hold still may have become other vertices since then.
  bool rest_changed() const { return rest_changed_; }
  /// All vertices that some interaction may act on; ascending.
  std::vector<std::uint32_t> named() const;
  /// All vertices that some interaction holds still and none may act on; ascending.
  std::vector<std::uint32_t> resting() const;
  /// All vertices that some interaction holds still, and those that each does, to go back to.
  std::vector<std::uint32_t> held_still() const;
  using Rests = std::vector<std::vector<std::uint32_t>>;
  const Rests& rests() const { return rests_; }
  void set_rests(const Rests& rests) { rests_ = rests; }
  /// None has named any; archive() comes next.
  void forget_named();
  /// Asks what they hold still before the first step.
  void ask_rests();
  /// New vertices, numbered on from `first_new`, are named by those that named the vertices they are copies of.
  void follow(std::span<const std::uint32_t> origins, std::uint32_t first_new);
  /// The vertices at hand have become others.
  void find_places(std::span<const ActiveVertex> active, std::size_t vertex_count);

  /// Begins a step. @param accounted  whether they are to book their work
  void begin(double time, double h, std::span<ActiveVertex> active, std::span<const RestingVertex> resting,
             std::span<const Vec3d> rest, bool accounted);
  void add_forces();
  /// @param mobility  per place, 1/(m + γh), 0 of components that a support or motion holds [1/kg]
  void constrain(std::span<const Vec3d> mobility);
  /// In a long step. @param free  per place: 1 of components that may move, else 0 @param most  sweeps @return sweeps that it took
  int constrain(std::span<const Vec3d> free, StepMobility& mobility, int most);
  /// Whether the impulses of a long step no longer changed at the end.
  bool has_settled() const { return solver_.has_settled(); }
  /// Whether these meet all rows, or nearly, or no impulses do.
  bool is_found() const { return solver_.is_found(); }
  /// Whether a tool that a force moves ends elsewhere than its rows were declared for. @param share  of what the tissue holds it back
  bool moves_on(double share) const { return solver_.moves_on(share); }
  /// What impulses held in this step.
  void list_held(HeldRows& held) const;
  /// Whether all that they declared in this step could be met.
  bool is_met() const { return !solver_.is_unmet(); }
  /// What each has of its own (Interaction::save_state), and takes them back there.
  using Saved = std::vector<std::shared_ptr<const void>>;
  Saved save() const;
  /// @param other_body  as Interaction::load_state
  void load(const Saved& saved, const BodyView* other_body = nullptr);
  /// What those held still stand against, for moved().
  void set_resting(std::span<const RestingVertex> resting) { step_.resting = resting; }
  /// Whether some say so of the step, with its end among the active vertices.
  bool overshoot();
  void moved();
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins);
  void state_set(std::span<const Vec3d> displacement);

  /// Per place, of the last step [N s].
  std::span<const Vec3d> impulses() const { return impulses_; }
  /// What they booked in the last step that was accounted.
  const InterfaceBook& book() const { return book_; }
  double tool_energy() const;
  /// ω² of their stiffness [1/s²].
  struct Frequency {
    double of_bounded = 0.0, of_others = 0.0;
  };
  /// Appends the stiffness of those that bound it per vertex.
  Frequency find_frequency(std::vector<VertexStiffness>& bounds) const;
  double squared_frequency() const;

  void archive(Archive& ar);

 private:
  void take_rests(std::size_t interaction);
  void name(std::size_t interaction, std::span<const std::uint32_t> vertices, std::size_t vertex_count);
  void keep(std::size_t interaction, std::span<const std::uint32_t> vertices);

  std::vector<std::shared_ptr<Interaction>> all_;
  std::vector<std::vector<std::uint32_t>> named_;  ///< by each interaction, ascending
  Rests rests_;                                    ///< what each holds still, ascending
  bool lets_go_ = true;
  bool left_ = false, rest_changed_ = false;
  std::vector<std::uint32_t> place_of_, newcomers_;
  std::vector<Vec3d> impulses_;
  InteractionStep step_;
  StepSolver solver_;
  InterfaceBook book_;
};

}  // namespace glisson
