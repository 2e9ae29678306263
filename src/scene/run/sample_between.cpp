#include "scene/run/sample_between.h"

#include <array>
#include <bit>
#include <cmath>

namespace glisson::scene {
namespace {

/// Of a struct of numbers.
template <class T>
T between(const T& a, const T& b, double share) {
  using Numbers = std::array<double, sizeof(T) / sizeof(double)>;
  const auto from = std::bit_cast<Numbers>(a), to = std::bit_cast<Numbers>(b);
  Numbers x;
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = std::lerp(from[i], to[i], share);
  return std::bit_cast<T>(x);
}

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double share) {
  std::vector<double> x = b;
  for (std::size_t i = 0; i < std::min(a.size(), x.size()); ++i) x[i] = std::lerp(a[i], b[i], share);
  return x;
}

}  // namespace

Sample sample_between(const Sample& a, const Sample& b, double time) {
  const double share = (time - a.time) / (b.time - a.time);
  Sample s = b;
  s.time = s.probe_time = time;
  for (std::size_t i = 0; i < s.instruments.size(); ++i) {
    InstrumentSample& x = s.instruments[i];
    x.depth = std::lerp(a.instruments[i].depth, x.depth, share);
    x.force = between(a.instruments[i].force, x.force, share);
    x.values = between(a.instruments[i].values, b.instruments[i].values, share);
  }
  for (std::size_t i = 0; i < s.supports.size(); ++i) s.supports[i] = between(a.supports[i], b.supports[i], share);
  if (a.container && b.container) s.container = between(*a.container, *b.container, share);
  s.probes = between(a.probes, b.probes, share);
  s.energies = between(a.energies, b.energies, share);
  if (a.stored_energy && b.stored_energy) s.stored_energy = std::lerp(*a.stored_energy, *b.stored_energy, share);
  return s;
}

}  // namespace glisson::scene
