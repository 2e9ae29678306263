// process_memory.cpp — Linux: VmHWM of /proc/self/status, which "5" in /proc/self/clear_refs sets to what is in use.
#include "bench/process_memory.h"

#include <malloc.h>

#include <fstream>
#include <string>

namespace glisson::app {

bool restart_peak_memory() {
  malloc_trim(0);
  std::ofstream clear("/proc/self/clear_refs");
  clear << "5" << std::flush;
  return clear.good();
}

std::optional<double> peak_memory_mib() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with("VmHWM:")) return std::stod(line.substr(6)) / 1024.0;
  }
  return std::nullopt;
}

}  // namespace glisson::app
