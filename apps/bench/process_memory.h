// process_memory.h — the most memory this process has had since a point in time, as the system counts it.
#pragma once

#include <optional>

namespace glisson::app {

/// Gives freed memory back and starts counting anew. @return whether the system let us
bool restart_peak_memory();

/// The most resident memory since then [MiB]; none where the system does not tell.
std::optional<double> peak_memory_mib();

}  // namespace glisson::app
