// live_path.h — the path of a tool that someone leads: towards a target at a bounded speed, or along the scene's motion.
//
// A mouse does not feel the tool, so there is no spring between hand and tool as HandDriver has for a haptic device: the
// tool goes where it is told, and the depth shown is the depth it has. Each frame is a straight piece of the way,
//   d(t) = d₀ + v (t − t₀),   |Δv| ≤ speed/ramp · frame,   v ≤ √(2 a |target − d|):
// it starts, turns and stops without a jerk that would shake the tissue.
#pragma once

#include <optional>

#include "glisson/instruments/tool_motion.h"

namespace glisson::view {

class LivePath {
 public:
  /// @param speed  [m/s], > 0 @param ramp  time to reach it [s], > 0
  /// @param scene  the scene's own motion; none where it is no path
  LivePath(double speed, double ramp, std::optional<ToolPath> scene);

  /// From where the tool started, in this frame or the one before [m].
  Vec3d at(double time) const;
  /// Plans the frame from `time` on [s].
  void plan(double time, double frame_s);

  void set_target(const Vec3d& target);  ///< [m]; leaves the scene's motion
  void set_speed(double speed) { speed_ = speed; }
  double speed() const { return speed_; }
  void set_scene(ToolPath scene) { scene_ = std::move(scene); }  ///< the scene's own motion, known later than the tool
  bool can_play() const { return scene_.has_value(); }
  bool playing() const { return playing_; }
  /// Is where the tool started, at time 0, and has no target but that.
  void restart();
  /// Follows the scene's motion from time 0 on; before the first frame.
  void play() { playing_ = scene_.has_value(); }

 private:
  struct Piece {
    double time = 0.0;
    Vec3d from{}, velocity{};
    Vec3d at(double t) const { return from + velocity * (t - time); }
  };
  Vec3d next_velocity(const Vec3d& from, double frame_s) const;

  double speed_, ramp_;
  std::optional<ToolPath> scene_;
  bool playing_ = false;
  Piece before_, now_;
  Vec3d target_{};
};

}  // namespace glisson::view
