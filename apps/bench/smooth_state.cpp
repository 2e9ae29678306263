// smooth_state.cpp — see smooth_state.h.
#include "bench/smooth_state.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace glisson::app {
namespace {

constexpr int kWaves = 8;
constexpr double kStrain = 0.01;     // [-]
constexpr double kStrainRate = 0.5;  // [1/s]

/// SplitMix64: a few lines, and the same numbers on every machine, which std's distributions do not promise.
class Sequence {
 public:
  explicit Sequence(std::uint64_t seed) : state_(seed) {}
  /// Uniform in [-1, 1).
  double next() {
    state_ += 0x9E3779B97F4A7C15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1.0;
  }

 private:
  std::uint64_t state_;
};

struct Wave {
  Vec3d number;     // 2π n / size [1/m]
  Vec3d amplitude;  // [m] or [m/s]
  double phase = 0.0;
};

/// At most one and a half wavelengths along an axis; the gradient of the wave alone has the given root mean square.
Wave random_wave(Sequence& random, const Vec3d& size, double gradient) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  const Vec3d turns{1.5 * random.next(), 1.5 * random.next(), 1.5 * random.next()};
  const Vec3d number{kTurn * turns.x / size.x, kTurn * turns.y / size.y, kTurn * turns.z / size.z};
  const Vec3d direction{random.next(), random.next(), random.next()};
  const double rms = norm(number) * norm(direction) * std::numbers::sqrt2 / 2.0;
  return {number, (gradient / rms) * direction, kTurn * random.next()};
}

std::vector<Vec3d> waves(const TetMesh& mesh, double gradient, std::uint64_t seed) {
  const auto [low, high] = glisson::box_of(mesh);
  Sequence random(seed);
  std::array<Wave, kWaves> all;
  for (Wave& wave : all) wave = random_wave(random, high - low, gradient / std::sqrt(double{kWaves}));
  std::vector<Vec3d> field(mesh.vertices.size());
  for (std::size_t v = 0; v < field.size(); ++v) {
    const Vec3d x = mesh.vertices[v] - low;
    for (const Wave& wave : all) field[v] += std::sin(dot(wave.number, x) + wave.phase) * wave.amplitude;
  }
  return field;
}

}  // namespace

std::vector<Vec3d> smooth_displacement(const TetMesh& mesh) { return waves(mesh, kStrain, 1); }
std::vector<Vec3d> smooth_velocity(const TetMesh& mesh) { return waves(mesh, kStrainRate, 2); }

}  // namespace glisson::app
