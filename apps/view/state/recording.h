// recording.h — what hands did since the body was last at rest: ways and forces of every frame of 1 ms, within a bound.
//
// A body remembers (viscosity, inertia, punctures), so a motion can be gone again only from rest: a recording begins with
// each new body and is dropped with it.
//
//   blocks of frames, shared:  ████ ████ ██░░        a snapshot shares them: no copy, and frames that come later are not its own
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "view/state/snapshot.h"
#include "view/state/zip.h"

namespace glisson::view {

class Recording {
 public:
  static constexpr std::size_t kMostBytes = 128'000'000;

  /// @param tools  how many of the samples' tools there are @param most_bytes  after which nothing more is kept
  explicit Recording(std::size_t tools, std::size_t most_bytes = kMostBytes) : tools_(tools), most_bytes_(most_bytes) {}

  Recording(Recording&&) = default;
  Recording& operator=(Recording&&) = default;

  /// Takes a frame; another epoch starts anew.
  void add(const ForceSample& sample);
  /// What is kept now, for another thread to read while this goes on.
  std::shared_ptr<const Recording> snapshot() const { return std::shared_ptr<const Recording>(new Recording(*this)); }

  std::size_t frames() const { return frames_; }
  double duration() const;  ///< simulated [s]
  bool full() const { return full_; }
  /// What a scene cannot say of it, and so does not go again; empty: nothing.
  std::string unsaid() const;

  /// time_s and of each tool NAME_depth_m, NAME_force_N: along its direction, positive when it presses. In pieces.
  void forces_csv(const std::vector<ToolInfo>& tools, const TextSink& out) const;
  /// time_s, x_m, y_m, z_m of one tool, from where it started: as `record` of a scene reads it. In pieces.
  void way_csv(std::size_t tool, const TextSink& out) const;

 private:
  static constexpr std::size_t kBlockFrames = 4096;

  Recording(const Recording&) = default;  // for snapshots: only one of those that share blocks may add to them
  std::size_t stride() const { return 2 + 5 * tools_; }  // frame's time, forces' time; of each tool way, depth, force
  double value(std::size_t frame, std::size_t column) const {
    return blocks_[frame / kBlockFrames][frame % kBlockFrames * stride() + column];
  }
  /// Head and lines, `row` appending one of them, handed on in pieces.
  template <class Row>
  void table(std::string head, const TextSink& out, Row row) const;

  std::size_t tools_, most_bytes_;
  std::vector<std::shared_ptr<double[]>> blocks_;
  std::size_t frames_ = 0;
  std::uint32_t epoch_ = 0;
  bool full_ = false, gap_ = false;
  double grabbed_ = -1.0, cut_ = -1.0, changed_ = -1.0;  ///< first time of each [s]; -1: never
};

/// Names the files of a recording's archive: scene.toml, a way of each tool, forces.csv. Their contents are made when they are
/// asked for, by any thread. @param parameters  as the body has them now
using RecordingWriter =
    std::function<std::vector<ZipFile>(std::shared_ptr<const Recording>, const std::vector<double>& parameters)>;

/// Name of the file that holds the way of a tool, without what a file's name may not hold.
std::string way_file(const std::vector<ToolInfo>& tools, std::size_t tool);

}  // namespace glisson::view
