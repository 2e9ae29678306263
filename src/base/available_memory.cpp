// available_memory.cpp — Linux says it in /proc; other systems only by their limits.
#include "base/available_memory.h"

#include <algorithm>
#include <fstream>
#include <string>

#if defined(__unix__) || defined(__APPLE__)
#include <sys/resource.h>
#include <unistd.h>
#endif

namespace glisson::detail {
namespace {

/// MemAvailable of /proc/meminfo [bytes].
std::optional<double> machine_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string word; file >> word;) {
    double kilobytes = 0.0;
    if (word == "MemAvailable:" && file >> kilobytes) return kilobytes * 1024.0;
  }
  return {};
}

/// What the limit of address space leaves [bytes].
std::optional<double> limit_left() {
#if defined(__unix__) || defined(__APPLE__)
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return {};
  double pages = 0.0;
  std::ifstream("/proc/self/statm") >> pages;
  return std::max(0.0, static_cast<double>(limit.rlim_cur) - pages * static_cast<double>(sysconf(_SC_PAGESIZE)));
#else
  return {};
#endif
}

}  // namespace

std::optional<double> available_memory() {
  const std::optional<double> machine = machine_memory(), limit = limit_left();
  if (machine && limit) return std::min(*machine, *limit);
  return machine ? machine : limit;
}

}  // namespace glisson::detail
