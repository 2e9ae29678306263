// instrument.h — base of all instruments: a driven pose, forces to read, columns of forces.csv, events.
//
//   ToolDriver ── pose at t + h ──▶ Instrument ── impulses ──▶ tissue
//        ▲                               │
//        └────── force of the tissue ────┘          (used by pushes and hands, not by recorded paths)
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/field.h"
#include "glisson/instruments/form.h"
#include "glisson/math.h"
#include "glisson/pose.h"
#include "glisson/simulation/interaction.h"
#include "glisson/time_function.h"

namespace glisson {

void archive(Archive& ar, Pose& pose);

/// A force and a torque about the tool's origin.
struct Wrench {
  Vec3d force{};   ///< [N]
  Vec3d torque{};  ///< [N m]
};

/// Force of a tool on the tissue, by component [N]: total = normal + friction + cutting.
struct ToolForces {
  Vec3d normal{};    ///< pressing: across surfaces in contact, across the shaft of a needle, at a tip that does not cut
  Vec3d friction{};  ///< along surfaces in contact and along the shaft
  Vec3d cutting{};   ///< at a tip or edge that cuts tissue
  Vec3d torque{};    ///< of all components, about the tool's origin [N m]
  Vec3d total() const { return normal + friction + cutting; }
};

/// An event to mark on the force curve.
struct InstrumentEvent {
  double time = 0.0;   ///< [s]
  double depth = 0.0;  ///< displacement of the tool along its direction, from its start [m]
  std::string event;   ///< contact, puncture, drop, inner puncture, withdrawal, release …
};

void archive(Archive& ar, InstrumentEvent& event);

/// Where poses of a tool make sense: about the body that it acts on.
struct PoseBounds {
  Vec3d middle{};  ///< of the body's box at rest [m]
  double reach =
      std::numeric_limits<double>::infinity();  ///< largest distance from there: ten diagonals of that box [m]

  bool holds(const Pose& pose) const;
  /// What is wrong with a pose that is not within, with its value, the allowed range and a way out; for messages.
  std::string fault_of(const Pose& pose) const;
};

/// Moves a tool: along a path, by a push, or from another program.
class ToolDriver {
 public:
  virtual ~ToolDriver() = default;
  /// Initial pose of the tool.
  virtual Pose start() const = 0;
  /// Pose at the end of the step from `time` to `time` + h.
  /// @param on_tool  force of the tissue on the tool in the last step
  virtual Pose advance(double time, double h, const Wrench& on_tool) = 0;
  /// Time at which the motion has ended [s]; none: it does not end by itself.
  virtual std::optional<double> end() const { return {}; }
  /// Corners of its motion or push, where long steps end.
  virtual CornerTimes corners() const { return {}; }
  /// Whether its path depends on the force.
  virtual bool yields() const { return false; }
  /// Whether it does so in long steps, too, by advance_under().
  virtual bool yields_in_long_steps() const { return false; }
  /// As advance(), from where the last one began, with the force on the tool at the end of the step: asked as often as it takes to
  /// find that.
  virtual Pose advance_under(double time, double h, const Wrench& at_end) { return advance(time, h, at_end); }
  /// Told when its tool is attached: where poses make sense.
  virtual void set_bounds(const PoseBounds&) {}
  /// How many poses from outside it has rejected, in whose place the last good one stayed.
  virtual std::uint64_t rejected() const { return 0; }
  /// Writes or reads its state, as Interaction's.
  virtual void archive(Archive&) {}
  /// As Interaction's; a driver without these two members is copied by archive().
  virtual std::shared_ptr<const void> save_state() const;
  virtual void load_state(const std::shared_ptr<const void>& state);
};

struct ToolYield;
class Instrument;

/// A column of forces.csv: a number that is read from an instrument with every sample.
struct InstrumentColumn {
  std::string_view name;  ///< with its unit: "depth_m"; of static storage
  double (*read)(const Instrument&);
};

/// What changes in every instrument while it acts.
struct InstrumentState {
 protected:
  Pose pose_, before_;  ///< at t + h and at t
  ToolForces forces_;
  Pose earlier_;                         ///< a step before t
  double step_ = 0.0, last_step_ = 0.0;  ///< h and that of the step before t; 0: there was none [s]
  double force_depth_ = 0.0;
  double time_ = 0.0;  ///< at which the last began [s]
  std::vector<InstrumentEvent> events_;
};

/// A moved object that acts on the body: in contact with it, inside it, or fixed to vertices of it. Its force is the force on
/// the tissue at Simulation::force_time(), 0 before the first step.
class Instrument : public Interaction, protected InstrumentState {
 public:
  /// @param driver  not none @param direction  along which depth is measured, a unit vector
  Instrument(std::string name, std::shared_ptr<ToolDriver> driver, const Vec3d& direction);

  const std::string& name() const { return name_; }
  std::string label() const override { return "instrument \"" + name_ + "\""; }
  virtual Pose pose() const { return pose_; }  ///< at the end of the last step
  const Vec3d& direction() const { return direction_; }
  double depth() const;  ///< displacement along the direction since the start [m]
  /// The same at the time of the force [m].
  virtual double force_depth() const { return at_end_ ? depth() : force_depth_; }
  /// Pose at the time of the force.
  virtual Pose force_pose() const { return at_end_ ? pose_ : before_; }
  /// Where the hand holds it, at the time of the force [m]; its tip where it has no length.
  virtual Vec3d handle() const { return force_pose().position; }
  /// Torque of the hand's force about the handle on the tissue's side: that of forces() about the handle [N m].
  Vec3d handle_torque() const { return forces_.torque + cross(force_pose().position - handle(), forces_.total()); }
  virtual Vec3d force() const { return forces_.total(); }  ///< on the tissue [N]
  /// What a sensor between the hand and the instrument carries, without inertia and weight of what it moves [N].
  virtual Vec3d sensor_force() const { return -force(); }
  /// The force by component where the instrument touches the tissue.
  const ToolForces& forces() const { return forces_; }
  /// depth_m, force_x_N, force_y_N, force_z_N, and force_N along the direction.
  static std::span<const InstrumentColumn> common_columns();
  /// common_columns(), own_columns() and record_columns().
  std::vector<InstrumentColumn> columns() const;
  /// Pose and forces by component: position_x_m …, rotation_w …, torque_x_N_m …, handle_torque_x_N_m …, normal_x_N …,
  /// friction_x_N …, cutting_x_N …, friction_size_N (docs/output.md).
  static std::span<const InstrumentColumn> pose_columns();
  /// Its last columns in forces.csv: pose_columns(); a contact tool adds its area and largest pressure.
  virtual std::span<const InstrumentColumn> record_columns() const { return pose_columns(); }
  /// The value of a column. @throws std::out_of_range naming it
  double read(std::string_view column) const;
  const ToolDriver& driver() const { return *driver_; }
  /// How many poses from outside were rejected so far: not finite, no rotation, farther than ten diagonals of the body, or
  /// faster than the driver allows. The last good pose stays in their place.
  std::uint64_t rejected() const { return rejected_ + driver_->rejected(); }
  void set_long_steps(bool are_long) override;
  double next_corner(double after) const override { return driver_->corners().after(after); }
  /// All events so far, in order.
  const std::vector<InstrumentEvent>& events() const { return events_; }
  /// Its shape in pictures.
  virtual InstrumentForm form() const { return {}; }
  /// Points from the hand to the tip of the bent instrument [m]; of a rigid one its tip alone.
  virtual std::vector<Vec3d> centre_line() const { return {pose().position}; }
  /// Sets the callback for a puncture (position [m], radius [m]), for example to open a capsule.
  void on_puncture(std::function<void(const Vec3d& place, double radius)> callback) {
    on_puncture_ = std::move(callback);
  }

 protected:
  /// Columns of this kind besides depth and force: here normal_N, friction_N and cutting_N, along the direction. The list
  /// is of static storage.
  virtual std::span<const InstrumentColumn> own_columns() const;
  /// Moves the pose to the end of the step; the previous one is in `before_`. To be called once a step, in reach() or
  /// first in declare().
  void drive(const InteractionStep& step);
  /// Why its driver does not support long steps, for refuses_long_steps().
  std::string driver_refuses_long_steps() const;
  /// Begins a step; to be called first in reach().
  void begin_step();
  /// In declare() of a long step, after drive(): moves the pose to where the force that was found last takes the tool, and finds how
  /// far another force takes it. @return null where no force moves it
  ToolYield* find_end(const InteractionStep& step);
  /// In solved(), first: moves the pose to where the force takes it that the solver has found.
  void move_to_end();
  /// Where a tool that a force moves would end without the tissue, in a long step; after drive().
  std::optional<Vec3d> free_end() const;
  /// Whether its forces are those at the end of a step.
  bool forces_at_end() const { return at_end_; }
  /// Velocity of the tool's own material at a point of space at the time of the forces; after drive(). In long steps that of the
  /// step both before and after.
  ToolVelocity velocity_at(const Vec3d& x) const;
  /// Reports a puncture of the surface.
  void tell_puncture(const Vec3d& place, double radius) const {
    const std::function<void(const Vec3d&, double)> callback = on_puncture_;  // which may set another one
    if (callback) callback(place, radius);
  }
  void add_event(double time, double depth, std::string event) { events_.push_back({time, depth, std::move(event)}); }
  /// The state that all instruments have and that of the driver; those of each kind call it first.
  void archive_motion(Archive& ar);
  /// The same for save_state() and load_state().
  struct SavedMotion;
  std::shared_ptr<const SavedMotion> save_motion() const;
  void load_motion(const SavedMotion& saved);
  /// Finds where poses make sense; to be called first in attached().
  void set_bounds(const BodyView& body);

 private:
  bool accepts(const Pose& pose);
  Vec3d end_under(const Vec3d& force);

  std::string name_;
  std::shared_ptr<ToolDriver> driver_;
  Vec3d direction_, start_;
  PoseBounds bounds_;
  std::uint64_t rejected_ = 0;         ///< poses of the driver in steps
  bool at_end_ = false;                ///< its steps are long
  std::shared_ptr<ToolYield> yields_;  ///< in long steps, where a force moves it
  std::function<void(const Vec3d&, double)> on_puncture_;
};

}  // namespace glisson
