// machine_peak.h — the two roofs of this machine, measured: arithmetic and memory.
//
//   flop/s ┤        ┌──────────── multiply_add_flops: every unit busy, all operands in registers
//          │      ╱
//          │    ╱  read_bytes or triad_bytes × flops per byte: arrays far larger than the caches
//          └──┴───────────▶ flops per byte
//
// Nothing is looked up: clock, boost, neighbours on the same host and a hypervisor are all in the figures, as they are
// in the figures that are held against them in the same run.
#pragma once

#include <string>

namespace glisson::cpu {

/// Roofs for a number of threads at work at the same time; all of them together.
struct MachinePeak {
  int threads = 1;
  double multiply_add_flops = 0.0;  ///< float multiply-adds in the instruction set chosen, two flops each [flop/s]
  double read_bytes = 0.0;          ///< sum of an array: bytes read [B/s]
  double triad_bytes = 0.0;         ///< a ← b + s c with stores past the caches: bytes read and written [B/s]
  std::string instruction_set{};    ///< of multiply_add_flops

  /// The memory roof: the larger of the two [B/s].
  double memory_bytes() const { return read_bytes > triad_bytes ? read_bytes : triad_bytes; }
  /// "read" or "triad", the one that memory_bytes() is.
  const char* memory_kind() const { return read_bytes > triad_bytes ? "read" : "triad"; }
};

/// Measures for `threads` threads; the best of several tries counts, as anything else is the work of others.
/// Takes about half a second and 384 MiB. @throws std::bad_alloc where that much memory is not to be had
MachinePeak measure_machine_peak(int threads);

/// The larger of each figure, of two measurements with the same threads.
MachinePeak best_of(const MachinePeak& a, const MachinePeak& b);

/// The instruction set of the peak and of the engine, e.g. "AVX2", "AVX3" (which is AVX-512).
std::string instruction_set();

}  // namespace glisson::cpu
