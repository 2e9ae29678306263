// tool_motion.h — drivers of instruments: paths in time, a push, an external hand.
//
//   path    the position is a function of time: strokes, a sine, a record, a press (motion.h)
//   push    the force is a function of time; the position follows from the resistance of the tissue
//   hand    a program sets a target every millisecond and gets the tool's force through a spring
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "glisson/instruments/instrument.h"
#include "glisson/instruments/motion.h"
#include "glisson/math.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// Displacement from the start as a function of time, and its end [s]; none: it does not end.
struct ToolPath {
  Motion displacement;
  std::optional<double> end;
};

/// A tool that follows a path; it does not turn.
class PathDriver final : public ToolDriver {
 public:
  PathDriver(const Pose& start, ToolPath path);
  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  std::optional<double> end() const override { return path_.end; }
  CornerTimes corners() const override { return path_.displacement.corners; }

 private:
  Pose start_;
  ToolPath path_;
};

/// The press of motion.h as a path: ramp, press, hold, return.
ToolPath press_path(const PressMotion& motion);

/// Motion at one speed without end.
struct SteadyMotion {
  Vec3d direction{0.0, 0.0, -1.0};  ///< of any length, not zero
  double velocity = 0.01;           ///< [m/s]
  double start = 0.0;               ///< [s]
  double ramp = 0.0;                ///< time over which the speed rises from 0 [s]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("direction", &SteadyMotion::direction).direction(),
                no_key("velocity", &SteadyMotion::velocity, "m/s", above(0)),
                no_key("start", &SteadyMotion::start, "s", at_least(0)),
                no_key("ramp", &SteadyMotion::ramp, "s", at_least(0)));
  }
};
ToolPath steady_path(const SteadyMotion& motion);

/// A straight move to a point and a rest there; for example insert, rest, sideways, withdraw.
struct Stroke {
  Vec3d to{};              ///< relative to the start of the tool, not of the stroke [m]
  double velocity = 0.01;  ///< [m/s]
  double ramp = 0.0;       ///< time over which the speed rises, and falls, linearly [s]
  double rest = 0.0;       ///< after the move [s]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("to", &Stroke::to), no_key("velocity", &Stroke::velocity, "m/s", above(0)),
                no_key("ramp", &Stroke::ramp, "s", at_least(0)), no_key("rest", &Stroke::rest, "s", at_least(0)));
  }
};
struct StrokeMotion {
  double start = 0.0;           ///< [s]
  std::vector<Stroke> strokes;  ///< one or more

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("start", &StrokeMotion::start, "s", at_least(0)), no_key("strokes", &StrokeMotion::strokes));
  }
  Fault check() const;
};
ToolPath stroke_path(const StrokeMotion& motion);

/// Oscillation about a mean depth:  d(τ) = w(τ/ramp) (mean + amplitude sin 2π f τ),  w = x² (3 − 2x).
struct SineMotion {
  static constexpr std::string_view kName = "sine";
  Vec3d direction{0.0, 0.0, -1.0};  ///< of any length, not zero
  double amplitude = 0.001;         ///< [m]
  double frequency = 1.0;           ///< f [Hz]
  double mean = 0.0;                ///< [m]
  double start = 0.0;               ///< [s]
  double ramp = 0.0;                ///< time over which it rises [s]
  double duration = 1.0;            ///< from the start on [s]; then the tool stays in place

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("direction", &SineMotion::direction, "-", "direction of motion, of any length").direction(),
                field("amplitude", &SineMotion::amplitude, "mm", above(0), "amplitude"),
                field("frequency", &SineMotion::frequency, "Hz", above(0), "frequency"),
                field("mean", &SineMotion::mean, "mm", "mean depth"),
                field("start", &SineMotion::start, "s", at_least(0), "start of the motion"),
                field("ramp", &SineMotion::ramp, "s", at_least(0), "time over which it rises"),
                field("duration", &SineMotion::duration, "s", above(0), "duration"));
  }
};
ToolPath sine_path(const SineMotion& motion);

/// A measured path: cubic between its points, with a continuous velocity, without overshoot beyond neighbouring points.
struct RecordedMotion {
  std::vector<double> times;     ///< ascending [s], two or more
  std::vector<Vec3d> positions;  ///< at these times [m]; the tool moves relative to the first of them
  double start = 0.0;            ///< time of the run at which the record begins [s]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("times", &RecordedMotion::times), no_key("positions", &RecordedMotion::positions),
                no_key("start", &RecordedMotion::start, "s", at_least(0)));
  }
  Fault check() const;
};
ToolPath recorded_path(const RecordedMotion& motion);

/// A tool with mass that is pushed along a direction:  m a + c v = F(t) d + force of the tissue.
///
/// The force of the tissue is that of the last step. If the contact is stiff or heavy for the step and the mass (h² k >
/// m), the change of force over the last displacement is used as a stiffness in the coming step: no contact, however
/// stiff, throws the tool back. A tool lighter than the tissue it carries along only creeps. In long steps the force is that at the
/// end of the step, F too, and found together with where the tool ends.
struct PushMotion {
  Vec3d direction{0.0, 0.0, -1.0};  ///< d, of any length, not zero
  TimeFunction<double> force;       ///< F at time t [N]; not none
  double mass = 0.05;               ///< m, of the tool and the hand behind it [kg]
  double damping = 5.0;             ///< c [N s/m]
  bool guided = true;               ///< moves along the direction only; otherwise also sideways
  std::optional<double> stop{};     ///< largest travel along the direction [m]
  std::optional<double> end{};      ///< end of the push, for the end of the run [s]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("direction", &PushMotion::direction).direction(), no_key("force", &PushMotion::force),
                field("mass", &PushMotion::mass, "kg", above(0), "mass of the tool and the hand behind it"),
                field("damping", &PushMotion::damping, "N s/m", at_least(0), "damping of the hand"),
                field("guided", &PushMotion::guided, "moves along the direction only; otherwise also sideways"),
                field("stop", &PushMotion::stop, "mm", above(0), "largest travel").otherwise("no stop"),
                no_key("end", &PushMotion::end));
  }
};
/// What changes in a push while it goes on.
struct PushState {
 protected:
  Vec3d travel_{}, velocity_{}, last_travel_{}, last_force_{};
  Vec3d first_travel_{}, first_velocity_{};  ///< at the start of the step
  double stiffness_ = 0.0;
};

class PushDriver final : public ToolDriver, PushState {
 public:
  /// @throws std::invalid_argument naming the field, its value and the allowed range
  PushDriver(const Pose& start, PushMotion motion);
  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  std::optional<double> end() const override { return motion_.end; }
  CornerTimes corners() const override { return motion_.force.corners; }
  bool yields() const override { return true; }
  bool yields_in_long_steps() const override { return true; }
  Pose advance_under(double time, double h, const Wrench& at_end) override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state) override;

  Vec3d velocity() const { return velocity_; }  ///< [m/s]

 private:
  void learn_stiffness(const Vec3d& force);
  Vec3d along(const Vec3d& force) const;
  Pose go(double push, double h, const Vec3d& answer, double stiff);

  Pose start_;
  PushMotion motion_;
};

/// A spring between a device and the tool, and a damper that holds the tool back.
///
///   device x ──/\/\/\── tool y, mass m ── tissue         force on the device, held for a period T:  F = k (y − x)
///      b        k          └─[ c ]─ ground               the tool in between:  m ÿ + c ẏ = k (x − y) + tissue
///
/// A force that is held while the device moves on creates energy: ½ k Δx² − k Δx·Δy per period. The dampers of device
/// and tool dissipate b Δx²/T and c Δy²/T or more. So no energy is created, for any tissue and hand, where b ≥ kT/2 and
/// (b − kT/2) c ≥ (kT/2)². With the tool fixed (c → ∞) this is the bound of a sampled wall, b ≥ kT/2.
struct HandCoupling {
  double stiffness = 300.0;      ///< k [N/m]
  double damping = 2.0;          ///< c [N s/m]
  double mass = 0.02;            ///< m [kg]
  double period = 0.001;         ///< T: time from one set_target to the next [s]
  double device_damping = 0.25;  ///< b: damping of the device's own bearings and motors [N s/m]
  /// Largest speed from the last good target, |x - x'| over a period for each target since then; none: any [m/s].
  std::optional<double> most_speed{};

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(no_key("stiffness", &HandCoupling::stiffness, "N/m", above(0)),
                no_key("damping", &HandCoupling::damping, "N s/m", above(0)),
                no_key("mass", &HandCoupling::mass, "kg", above(0)),
                no_key("period", &HandCoupling::period, "s", above(0)),
                no_key("device_damping", &HandCoupling::device_damping, "N s/m", at_least(0)),
                no_key("most_speed", &HandCoupling::most_speed, "m/s", above(0)));
  }
  Fault check() const;
};
/// The largest k that is passive with the c, T and b of a coupling:  k = (√(c² + 4 b c) − c) / T [N/m].
double largest_passive_stiffness(const HandCoupling& coupling);

/// What changes in a hand while it acts.
struct HandState {
 protected:
  Pose target_;
  Vec3d position_{}, velocity_{};
  Vec3d first_position_{}, first_velocity_{};  ///< at the start of the step
};

class HandDriver final : public ToolDriver, HandState {
 public:
  /// @throws std::invalid_argument naming the field, its value and the allowed range; for a stiffness that is not
  ///         passive
  HandDriver(const Pose& start, const HandCoupling& coupling = {});

  /// Sets the present pose of the device. The spring pulls the tool there; it turns with the device at once, without a
  /// torque on the hand.
  /// @throws std::invalid_argument for a pose that is not finite or no rotation, farther from the body than ten of its
  ///         diagonals, or faster than HandCoupling::most_speed; the last good one stays then
  void set_target(const Pose& target);
  /// The same for a stream of poses, as from a device: a bad one is counted by rejected(). @return whether it was taken
  bool offer_target(const Pose& target);
  /// Force that the device is to exert on the hand until the next target; read it right after set_target [N].
  Vec3d device_force() const;
  Vec3d velocity() const { return velocity_; }  ///< of the tool [m/s]

  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  bool yields() const override { return true; }
  bool yields_in_long_steps() const override { return true; }
  Pose advance_under(double time, double h, const Wrench& at_end) override;
  /// A target beyond them, set before the tool was attached, is rejected: the start is the target then.
  void set_bounds(const PoseBounds& bounds) override;
  std::uint64_t rejected() const override { return rejected_; }
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state) override;

 private:
  std::string fault_of(const Pose& target) const;
  void take(const Pose& target);

  Pose start_;
  HandCoupling coupling_;
  PoseBounds bounds_;
  std::uint64_t rejected_ = 0, missed_ = 0;  ///< poses in all, and since the last good one
};

}  // namespace glisson
