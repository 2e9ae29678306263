// snapshot.h — what the engine's thread hands over of a simulation: the state at one instant, and the forces between.
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "glisson/simulation/part_fields.h"
#include "report/body_surface.h"

namespace glisson::view {

/// Tools and instruments that can be led; a scene has few.
inline constexpr std::size_t kMostTools = 4;
/// Between snapshots of a body at rest.
inline constexpr auto kPublishAtRest = std::chrono::milliseconds(200);
/// The same of one that nobody looks at.
inline constexpr auto kPublishUnwatched = std::chrono::milliseconds(1000);
/// Of the latest events of a simulation, how many a snapshot tells.
inline constexpr std::size_t kEventsTold = 32;

/// What can be said of a tool before anything moves.
struct ToolInfo {
  std::string name;
  bool instrument = false;                     ///< else a set of vertices that is driven
  Vec3d direction{};                           ///< of depth, a unit vector
  Vec3d side{}, third{};                       ///< across it
  double least_depth = 0.0, most_depth = 0.0;  ///< [m]
  double speed = 0.01;                         ///< of the scene [m/s]
  bool can_play = false;                       ///< the scene moves it along a path
};

/// A number of a tissue that can be changed while the body moves.
struct ParameterInfo {
  std::string label, unit;
  double least = 0.0, most = 0.0, value = 0.0;
  bool log = false;     ///< better chosen by its logarithm
  std::string tissue;   ///< that it is of
  std::string group;    ///< of numbers that belong together
  std::string formula;  ///< that they stand in; may be empty
  std::string help;
};

/// Forces of one frame. Of a tool along its direction, positive when it presses [N], and its depth then [m].
struct ForceSample {
  std::uint32_t epoch = 0;
  float time = 0.0f;
  std::array<float, kMostTools> depth{}, force{};
  // For recording it.
  double frame_time = 0.0, force_time = 0.0;           ///< when the frame began, of which instant the forces are [s]
  std::array<Vec3d, kMostTools> way{};                 ///< of each tool from where it started, when the frame began [m]
  bool grabbed = false, cut = false, changed = false;  ///< by hand, in this frame
};

struct ToolState {
  double depth = 0.0;             ///< [m]
  std::array<double, 2> aside{};  ///< along its own x and y [m]
  Vec3d force{};                  ///< on the tissue [N]
  std::vector<Vec3d> line;        ///< of a needle from the hand to the tip; else its tip [m]
  Mat3d axes{};
};

struct LiveEvent {
  std::string tool, what;
  double time = 0.0, depth = 0.0;
};

/// The body's mesh; another one from a cut or a removal on.
struct BodyShape {
  TetMesh mesh;                     ///< at rest, without removed tets; vertex numbers are those of the displacement
  std::vector<std::uint8_t> marks;  ///< per vertex: 1 held, 2 driven, 0 free
  std::vector<Triangle> torn{};     ///< of capsules
  std::shared_ptr<const SkinFaces> skin{};  ///< of the body when it was made; none: nothing has been cut
};

struct Snapshot {
  std::uint32_t epoch = 0;  ///< counts the bodies made
  std::uint32_t shape_number = 0;
  std::uint64_t frame = 0;  ///< counts frames of the clock
  std::uint32_t echo = 0;   ///< sequence of the last command that acted with all before it
  double time = 0.0;        ///< simulated [s]
  double realtime_factor = 0.0, p50_us = 0.0, p99_us = 0.0;  ///< of about the last second
  std::uint64_t dropped = 0;                                 ///< frames that were over before their turn
  bool paused = false, building = false, playing = false, grabbing = false, stopped = false;
  std::shared_ptr<const BodyShape> shape;
  std::shared_ptr<const std::map<int, Tissue>> tissues;  ///< by region number; another one from a change on
  std::vector<Vec3d> displacement;
  std::vector<Vec3d> velocity;  ///< where someone wants to see the stress, else empty
  BranchRecord branches;        ///< where someone wants to see the stress, else none
  std::vector<double>
      contact_pressure;  ///< per vertex [Pa], where someone wants to see it and something touches, else empty
  /// Of a recorded run per tet [Pa], where someone wants to see them and the frames have them, else empty; a simulated body has what
  /// they follow from.
  std::vector<double> pressure, von_mises;
  std::vector<ToolState> tools;
  Vec3d grab_force{};
  double cut_area = 0.0, cut_longest = 0.0;  ///< of what the hand's blade has cut, at rest [m²]; that a piece took [s]
  std::vector<double> parameters;
  std::vector<double> speeds;
  std::vector<LiveEvent> events;    ///< the last ones of this body
  std::uint32_t events_before = 0;  ///< how many came before them
  std::string notice;               ///< something to tell; empty: nothing
};

}  // namespace glisson::view
