// implant.cpp — see implant.h.
#include "image/implant.h"

#include <charconv>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/text.h"

namespace glisson::image {
namespace {

/// A number with or without `mm` behind it [m].
double length_of(std::string_view text, const std::string& word) {
  text = detail::trimmed(text);
  if (text.ends_with("mm")) text = detail::trimmed(text.substr(0, text.size() - 2));
  double x = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (error != std::errc() || end != text.data() + text.size() || !(std::abs(x) <= 1e7))
    throw std::invalid_argument("implant \"" + word + "\": \"" + std::string(text) + "\" is no length in mm");
  return 1e-3 * x;
}

}  // namespace

double Implant::volume() const { return 4.0 / 3.0 * std::numbers::pi * semi_axes.x * semi_axes.y * semi_axes.z; }

bool Implant::contains(const Vec3d& p) const {
  const Vec3d d = p - center;
  const Vec3d q{d.x / semi_axes.x, d.y / semi_axes.y, d.z / semi_axes.z};
  return dot(q, q) < 1.0;
}

BodyRegion Implant::region() const {
  if (semi_axes.x == semi_axes.y && semi_axes.y == semi_axes.z)
    return region_of(name, Solid(BallShape{center, semi_axes.x}));
  return region_of(name, Solid(EllipsoidShape{center, semi_axes, 2.0, 2.0}));
}

Implant implant_of(const std::string& word) {
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("implant \"" + word + "\": " + what +
                                "; write NAME=ball:X,Y,Z,DIAMETERmm or NAME=ellipsoid:X,Y,Z,A,B,Cmm");
  };
  const std::size_t equals = word.find('='), colon = word.find(':');
  if (equals == word.npos || colon == word.npos || colon < equals) refuse("has no name or no kind");
  Implant implant;
  implant.name = detail::trimmed(word.substr(0, equals));
  if (implant.name.empty()) refuse("has no name");
  const std::string kind(detail::trimmed(std::string_view(word).substr(equals + 1, colon - equals - 1)));
  if (kind != "ball" && kind != "ellipsoid") refuse("is of the kind \"" + kind + "\"");
  std::vector<double> numbers;
  for (std::string_view rest = std::string_view(word).substr(colon + 1);;) {
    const std::size_t comma = rest.find(',');
    numbers.push_back(length_of(rest.substr(0, comma), word));
    if (comma == rest.npos) break;
    rest.remove_prefix(comma + 1);
  }
  const std::size_t wanted = kind == "ball" ? 4 : 6;
  if (numbers.size() != wanted)
    refuse("has " + std::to_string(numbers.size()) + " numbers in place of " + std::to_string(wanted));
  implant.center = {numbers[0], numbers[1], numbers[2]};
  implant.semi_axes = kind == "ball" ? Vec3d{0.5 * numbers[3], 0.5 * numbers[3], 0.5 * numbers[3]}
                                     : Vec3d{numbers[3], numbers[4], numbers[5]};
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(implant.semi_axes[a] > 0.0)) refuse("has a size that is not above 0");
  }
  return implant;
}

}  // namespace glisson::image
