// kept_memory.h — memory taken from the system before a run at the pace of a clock. The first touch of a page costs up to 60 µs
// where the machine is a virtual one, so lists that grow in a frame (a needle's, as it leaves the tissue) would cost frames.
#pragma once

#include <cstddef>

namespace glisson::app {

/// Enough for what the frames of a body of so many tets take anew.
std::size_t memory_for_frames(std::size_t tets);

/// Touches as many bytes, and has the allocator keep them and what is freed later. To be called in the thread that steps.
/// Does nothing where the C library is not glibc.
void keep_memory(std::size_t bytes);

}  // namespace glisson::app
