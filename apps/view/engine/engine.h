// engine.h — a scene in a thread of its own at the pace of a clock, steered and watched from another without locks.
//
//   server's thread                      engine's thread, every 1 ms
//   post(command) ──▶ ring ────────────▶ commands → plan the tools' ways → steps → force
//   latest()      ◀── three slots ◀───── state, every 8 ms: the newest wins
//   next_sample() ◀── ring ◀──────────── force of every frame
//
// While the body is at rest, or nobody looks, the thread sleeps until a command comes.
//
// The engine never waits for who watches: what is not taken is overwritten or refused. Steps that do not keep pace slow the
// simulated clock, and the state says by how much.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "glisson/scene/scene.h"
#include "view/engine/live_body.h"
#include "view/engine/live_parameters.h"
#include "view/state/command.h"
#include "view/state/inbox.h"
#include "view/state/snapshot.h"
#include "view/state/source.h"
#include "view/thread/compute_times.h"
#include "view/thread/frame_pace.h"
#include "view/thread/latest.h"
#include "view/thread/ring.h"

namespace glisson::view {

/// One frame of simulated time [s].
inline constexpr double kFrame = 0.001;

class Engine final : public Source {
 public:
  /// Builds the body. @throws SceneError, std::invalid_argument
  Engine(const Variant& variant, MeshLoader load);
  ~Engine() override;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  void start() override;
  void stop() override;
  /// What the thread does every 1 ms, without it and without a clock: for tests and measurements.
  /// @param late  frames that were over before their turn
  void turn(std::uint64_t late = 0);

  bool post(const Command& command) override { return inbox_.post(command); }
  void set_watched(bool watched) override { inbox_.set_watched(watched); }
  const Snapshot* latest() override { return latest_.take(); }
  bool next_sample(ForceSample& sample) override { return samples_.pop(sample); }

  void want_fields(bool stress, bool contact) override {
    want_stress_.store(stress, std::memory_order_relaxed);
    want_contact_.store(contact, std::memory_order_relaxed);
  }

  const std::vector<ToolInfo>& tools() const override { return tools_; }
  const std::vector<ParameterInfo>& parameters() const override { return parameters_; }
  const std::string& forms() const override { return forms_; }
  std::string vessel() const override { return vessel_; }
  bool can_grab() const override { return can_grab_; }
  std::size_t vertices() const override { return vertices_; }
  std::size_t tets() const override { return tets_; }
  bool has_stress() const override { return true; }
  const std::string& why_no_cut() const override { return why_no_cut_; }

 private:
  void run();
  void guarded_turn(std::uint64_t late);
  bool apply_commands();
  bool waits() const;
  bool moves() const;
  bool is_idle() const { return !moves() && !waits() && !owes_; }
  void apply(const Command& command);
  void apply_tool(const Command& command);
  void apply_grab(const Command& command);
  void apply_cut(const Command& command);
  void work_on_cut();
  void draw_hand();
  void restart(bool play);
  void undo();
  void take_up();
  void change_tissues();
  void frame();
  void take_sample();
  void publish();
  void fill_events(Snapshot& state) const;
  void measure_pace();

  MeshLoader load_;
  Variant variant_;  ///< as the scene has it, with the parameters changed
  std::unique_ptr<LiveBody> body_;
  std::vector<ToolInfo> tools_;
  std::vector<ParameterInfo> parameters_;
  std::vector<TissueParameter> handles_;  ///< on each of them
  std::string forms_, vessel_;
  bool can_grab_ = false;
  std::string why_no_cut_;
  std::size_t vertices_ = 0, tets_ = 0;

  Inbox inbox_;
  Ring<ForceSample, 8192> samples_;
  Latest<Snapshot> latest_;
  std::atomic<bool> stop_{false}, want_stress_{false}, want_contact_{false};
  std::thread thread_;

  // Of the engine's thread.
  std::vector<double> values_, speeds_;   ///< of parameters, of tools
  std::map<std::size_t, double> wished_;  ///< parameters that are to change
  app::WallClock::time_point next_change_{};
  bool changed_ = false;  ///< some tissue, since the body moves
  std::vector<Vec3d> targets_;
  Vec3d hand_at_{}, hand_{}, hand_target_{};  ///< where the hand took hold, its way, and its way's target [m]
  double reach_ = 0.0;                        ///< size of the body [m]
  double due_s_ = 0.0, began_s_ = 0.0;        ///< simulated times that the last frame was to reach, and began at [s]
  bool paused_ = false, stopped_ = false, building_ = false, restarted_ = false;
  bool broken_ = false;                 ///< an error has left the body behind
  std::deque<LiveBody::Kept> strokes_;  ///< the body before each of the last strokes of the blade
  bool owes_ = false;                   ///< commands have been taken that no state has told of yet
  int frames_to_step_ = 0;
  std::uint32_t received_ = 0;  ///< sequence of the last command taken from the ring
  std::uint32_t epoch_ = 0, echo_ = 0, shape_number_ = 0;
  std::uint64_t frames_ = 0, dropped_ = 0;
  std::shared_ptr<const BodyShape> shape_;
  std::size_t shape_key_ = 0;
  ComputeTimes compute_;
  app::WallClock::time_point published_, measured_, shaped_;
  double measured_time_ = 0.0, realtime_factor_ = 0.0;
  std::string notice_;
};

}  // namespace glisson::view
