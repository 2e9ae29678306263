// replay.h — a recorded run as a source: plays at the pace of a clock, goes to any time, reads frames as it needs them.
//
// Between two frames of one mesh places are on straight lines, as in the report; across a cut the earlier frame stands.
#pragma once

#include <atomic>
#include <thread>

#include "view/replay/frame_cache.h"
#include "view/replay/run_folder.h"
#include "view/state/inbox.h"
#include "view/state/source.h"
#include "view/thread/compute_times.h"
#include "view/thread/frame_pace.h"
#include "view/thread/latest.h"
#include "view/thread/ring.h"

namespace glisson::view {

/// Samples handed out of a run's forces: what one message of them holds.
inline constexpr std::size_t kReplaySamples = 4000;

class Replay final : public Source {
 public:
  /// Reads the first frame. @throws FileError where it cannot be read
  explicit Replay(RunFolder run);
  ~Replay() override;

  void start() override;
  void stop() override;
  /// Makes the state at a time [s] the latest, for who watches without the thread: not between start() and stop().
  void show(double time);
  bool post(const Command& command) override { return inbox_.post(command); }
  void set_watched(bool watched) override { inbox_.set_watched(watched); }
  const Snapshot* latest() override { return latest_.take(); }
  bool next_sample(ForceSample& sample) override { return samples_.pop(sample); }

  const std::vector<ToolInfo>& tools() const override { return run_.tools; }
  const std::vector<ParameterInfo>& parameters() const override { return parameters_; }
  const std::string& forms() const override { return run_.forms; }
  bool can_grab() const override { return false; }
  const std::string& why_no_cut() const override { return why_no_cut_; }
  bool has_stress() const override { return has_stress_; }
  void want_fields(bool stress, bool contact) override { want_fields_.store(stress || contact); }
  std::string vessel() const override { return run_.vessel; }
  std::size_t vertices() const override { return vertices_; }
  std::size_t tets() const override { return tets_; }
  const Recorded* recorded() const override { return &recorded_; }

 private:
  void run();
  bool apply_commands();
  void apply(const Command& command);
  void seek(double time);
  bool advance(double passed);
  void publish();
  void show_body(Snapshot& state);
  std::shared_ptr<const LoadedFrame> readable_before(std::size_t frame);
  void show_tools(Snapshot& state) const;
  std::size_t frame_before(double time) const;

  RunFolder run_;
  FrameCache frames_;
  Recorded recorded_;
  std::vector<ParameterInfo> parameters_;
  std::size_t vertices_ = 0, tets_ = 0;
  std::string why_no_cut_ = "a recorded run is shown as it was";

  Inbox inbox_;
  Ring<ForceSample, 8192> samples_;
  Latest<Snapshot> latest_;
  std::atomic<bool> stop_{false}, want_fields_{false};
  bool has_stress_ = false;  ///< the first frame has
  std::thread thread_;

  // Of the replay's thread.
  double time_ = 0.0, rate_ = 1.0;
  bool paused_ = true;
  std::uint32_t echo_ = 0, shape_number_ = 0;
  std::shared_ptr<const BodyShape> shape_;
  std::shared_ptr<const LoadedFrame> shown_;  ///< the last that could be read
  std::uint64_t published_ = 0;
  ComputeTimes reading_;
  std::string notice_;
};

}  // namespace glisson::view
