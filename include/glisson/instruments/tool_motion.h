// tool_motion.h — who moves an instrument: paths in time, a push, a hand outside.
//
//   path    where the tool is follows from the time alone: strokes, a sine, a record, a press (motion.h)
//   push    how hard it is pushed follows from the time; where it goes, from what the tissue answers
//   hand    a program sets a target every millisecond and feels, through a spring, what the tool meets
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

/// A way from the start in time, and when it has ended [s]; none: it goes on.
struct ToolPath {
  Motion way;
  std::optional<double> end;
};

/// A tool that follows a path; it does not turn.
class PathDriver final : public ToolDriver {
 public:
  PathDriver(const Pose& start, ToolPath path);
  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  std::optional<double> end() const override { return path_.end; }

 private:
  Pose start_;
  ToolPath path_;
};

/// The press of motion.h as a path: ramp, press, hold, return.
ToolPath press_path(const PressMotion& motion);

/// Ever on at one speed.
struct SteadyMotion {
  Vec3d direction{0.0, 0.0, -1.0};  ///< of any length, not zero
  double velocity = 0.01;           ///< [m/s], > 0
  double start = 0.0;               ///< [s], ≥ 0
  double ramp = 0.0;                ///< time over which the speed rises from 0 [s], ≥ 0
};
ToolPath steady_path(const SteadyMotion& motion);

/// A straight move to a point and a rest there: insert, rest, aside, withdraw are four of them.
struct Stroke {
  Vec3d to{};              ///< from where the tool started, not from the last stroke [m]
  double velocity = 0.01;  ///< [m/s], > 0
  double ramp = 0.0;       ///< time over which the speed rises, and falls, linearly [s], ≥ 0
  double rest = 0.0;       ///< after the move [s], ≥ 0
};
struct StrokeMotion {
  double start = 0.0;           ///< [s], ≥ 0
  std::vector<Stroke> strokes;  ///< one or more
};
ToolPath stroke_path(const StrokeMotion& motion);

/// Back and forth about a mean depth:  d(τ) = w(τ/ramp) (mean + amplitude sin 2π f τ),  w = x² (3 − 2x).
struct SineMotion {
  Vec3d direction{0.0, 0.0, -1.0};  ///< of any length, not zero
  double amplitude = 0.001;         ///< [m], > 0
  double frequency = 1.0;           ///< f [Hz], > 0
  double mean = 0.0;                ///< [m]
  double start = 0.0;               ///< [s], ≥ 0
  double ramp = 0.0;                ///< time over which it comes up [s], ≥ 0
  double duration = 1.0;            ///< from the start on [s], > 0; the tool stays where it is then
};
ToolPath sine_path(const SineMotion& motion);

/// A measured way: cubic between its points, with a continuous velocity, and never beyond the two points it lies between.
struct RecordedMotion {
  std::vector<double> times;     ///< ascending [s], two or more
  std::vector<Vec3d> positions;  ///< at these times [m]; the tool goes the way from the first of them
  double start = 0.0;            ///< time of the run at which the record begins [s], ≥ 0
};
ToolPath recorded_path(const RecordedMotion& motion);

/// A tool of a mass that is pushed along a direction:  m a + c v = F(t) d + what the tissue exerts on it.
///
/// The tissue's answer is that of the last step. Where it is stiff, or drags much mass along, for the step and the mass
/// (h² k > m), what it changed by over the way is taken as a stiffness that holds the coming step back: no contact, however
/// stiff, throws the tool back. A tool lighter than the tissue it drags along only creeps.
struct PushMotion {
  Vec3d direction{0.0, 0.0, -1.0};      ///< d, of any length, not zero
  std::function<double(double)> force;  ///< F at time t [N]; not none
  double mass = 0.05;                   ///< m, of the tool and the hand behind it [kg], > 0
  double damping = 5.0;                 ///< c [N s/m], ≥ 0
  bool guided = true;                   ///< moves along the direction only; else sideways, too
  std::optional<double> stop{};         ///< goes no farther than this along the direction [m], > 0
  std::optional<double> end{};          ///< time at which the push has ended, for the run [s]
};
class PushDriver final : public ToolDriver {
 public:
  /// @throws std::invalid_argument naming the field, its value and the allowed range
  PushDriver(const Pose& start, PushMotion motion);
  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  std::optional<double> end() const override { return motion_.end; }
  std::vector<double> past() const override;
  bool restore(std::span<const double> past) override;

  Vec3d velocity() const { return velocity_; }  ///< [m/s]

 private:
  void learn_stiffness(const Vec3d& force);

  Pose start_;
  PushMotion motion_;
  Vec3d way_{}, velocity_{}, last_way_{}, last_force_{};
  double stiffness_ = 0.0;
};

/// A spring between a device and the tool, and a damper that holds the tool back.
///
///   device x ──/\/\/\── tool y, mass m ── tissue         force on the device, held for a period T:  F = k (y − x)
///      b        k          └─[ c ]─ ground               the tool in between:  m ÿ + c ẏ = k (x − y) + tissue
///
/// A force that is held while the device moves on gives it energy that no one put in: ½ k Δx² − k Δx·Δy a period. The
/// dampers of device and tool take b Δx²/T and c Δy²/T or more. So nothing is left over, whatever the tissue and
/// the hand do, where b ≥ kT/2 and (b − kT/2) c ≥ (kT/2)². With the tool held fast (c → ∞) that is the bound of a
/// sampled wall, b ≥ kT/2.
struct HandCoupling {
  double stiffness = 300.0;      ///< k [N/m], > 0
  double damping = 2.0;          ///< c [N s/m], > 0
  double mass = 0.02;            ///< m [kg], > 0
  double period = 0.001;         ///< T: time from one set_target to the next [s], > 0
  double device_damping = 0.25;  ///< b: what the device itself has in its bearings and motors [N s/m], ≥ 0
};
/// The largest k that is passive with the c, T and b of a coupling:  k = (√(c² + 4 b c) − c) / T [N/m].
double largest_passive_stiffness(const HandCoupling& coupling);

class HandDriver final : public ToolDriver {
 public:
  /// @throws std::invalid_argument naming the field, its value and the allowed range; for a stiffness that is not passive
  HandDriver(const Pose& start, const HandCoupling& coupling = {});

  /// Where the hand holds the device now. The tool is drawn to the place; it turns with the device at once, and turning
  /// is not felt.
  void set_target(const Pose& target) { target_ = target; }
  /// What the device is to exert on the hand until the next target, read as soon as that is set [N].
  Vec3d device_force() const;
  Vec3d velocity() const { return velocity_; }  ///< of the tool [m/s]

  Pose start() const override { return start_; }
  Pose advance(double time, double h, const Wrench& on_tool) override;
  std::vector<double> past() const override;
  bool restore(std::span<const double> past) override;

 private:
  Pose start_, target_;
  HandCoupling coupling_;
  Vec3d position_, velocity_{};
};

}  // namespace glisson
