// kept_memory.cpp — see kept_memory.h.
#include "view/thread/kept_memory.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <memory>
#include <vector>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace glisson::app {

std::size_t memory_for_frames(std::size_t tets) {
  constexpr std::size_t kPerTet = 1024, kLeast = 4U << 20U, kMost = 256U << 20U;
  return std::clamp(kPerTet * tets, kLeast, kMost);
}

#ifdef __GLIBC__
void keep_memory(std::size_t bytes) {
  constexpr int kLargestBlock = 32 << 20;  // of the heap, the most that glibc allows: larger ones are mapped each time
  constexpr std::size_t kBlock = 1U << 20U;
  mallopt(M_MMAP_THRESHOLD, kLargestBlock);
  mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  std::vector<std::unique_ptr<char[]>> blocks;
  for (std::size_t taken = 0; taken < bytes; taken += kBlock) {
    blocks.push_back(std::make_unique_for_overwrite<char[]>(kBlock));
    std::memset(blocks.back().get(), 0, kBlock);
  }
}
#else
void keep_memory(std::size_t) {}
#endif

}  // namespace glisson::app
