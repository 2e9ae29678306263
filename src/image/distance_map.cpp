// distance_map.cpp — see distance_map.h.
#include "image/distance_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace glisson::image {
namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// The lower envelope of the parabolas  f[q] + h² (p − q)²  along one line.
class Envelope {
 public:
  explicit Envelope(std::size_t longest) : value_(longest), place_(longest), from_(longest + 1) {}

  void apply(float* line, std::size_t count, std::size_t stride, double h) {
    std::size_t parabolas = 0;
    const double hh = h * h;
    for (std::size_t q = 0; q < count; ++q) {
      const double f = line[q * stride];
      if (f == kFar) continue;
      const double at = static_cast<double>(q);
      double from = -std::numeric_limits<double>::infinity();
      while (parabolas > 0) {
        const double p = place_[parabolas - 1];
        from = ((f + hh * at * at) - (value_[parabolas - 1] + hh * p * p)) / (2.0 * hh * (at - p));
        if (from > from_[parabolas - 1]) break;
        --parabolas;
      }
      if (parabolas == 0) from = -std::numeric_limits<double>::infinity();
      value_[parabolas] = f;
      place_[parabolas] = at;
      from_[parabolas++] = from;
    }
    if (parabolas == 0) return;
    std::size_t i = 0;
    for (std::size_t p = 0; p < count; ++p) {
      const double at = static_cast<double>(p);
      while (i + 1 < parabolas && from_[i + 1] <= at) ++i;
      line[p * stride] = static_cast<float>(value_[i] + hh * (at - place_[i]) * (at - place_[i]));
    }
  }

 private:
  std::vector<double> value_, place_, from_;
};

}  // namespace

std::vector<float> distance_to(const std::array<std::size_t, 3>& size, const Vec3d& spacing,
                               const std::vector<char>& in_set) {
  std::vector<float> d(in_set.size());
  for (std::size_t v = 0; v < d.size(); ++v) d[v] = in_set[v] ? 0.0F : kFar;
  const std::array<std::size_t, 3> step{1, size[0], size[0] * size[1]};
  Envelope envelope(std::max({size[0], size[1], size[2]}));
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
    for (std::size_t k = 0; k < size[c]; ++k) {
      for (std::size_t j = 0; j < size[b]; ++j)
        envelope.apply(d.data() + j * step[b] + k * step[c], size[a], step[a], spacing[a]);
    }
  }
  for (float& x : d) x = std::sqrt(x);
  return d;
}

}  // namespace glisson::image
