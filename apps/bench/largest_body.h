// largest_body.h — how large a body may be that still keeps pace with a clock.
#pragma once

#include <atomic>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>

#include "bench/realtime.h"

namespace glisson::app {

/// A body of so many tets at the pace of a clock.
struct BodyTrial {
  std::size_t tets = 0;
  int threads = 1;
  RealtimeFigures figures;
  std::uint64_t dropped = 0;  ///< frames
  bool keeps = false;         ///< at most a thousandth of the frames were missed or dropped, and p99 is within a frame
};

nlohmann::ordered_json trial_json(const BodyTrial& trial);

/// Multiplies the cells of a generated mesh along an edge by a factor until the next step would not keep the pace; the largest that does is run
/// again and again until `options.seconds` are over.
/// @param tell  is called after each trial
/// @return nothing where no body keeps the pace, or `stop` was set before one was found
/// @throws std::invalid_argument where the mesh is not generated
std::optional<BodyTrial> largest_body(const Variant& variant, int threads, const RealtimeOptions& options,
                                      const std::atomic<bool>& stop, const std::function<void(const BodyTrial&)>& tell);

}  // namespace glisson::app
