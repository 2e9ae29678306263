// lane_law.cpp — laws made ready for lanes: worked out in double, in units of a modulus, and rounded to float once.
#include "engine/kernels/kernels.h"

namespace glisson::engine {
namespace {

/// Divides the moduli of a law; its fields say which they are.
template <class Law>
void divide_moduli(Law& law, double unit) {
  for (const LawField<Law>& field : Law::kFields) {
    if (field.unit != "Pa") continue;
    if (const auto* number = std::get_if<double Law::*>(&field.member)) law.** number /= unit;
    if (const auto* list = std::get_if<std::vector<double> Law::*>(&field.member)) {
      for (double& x : law.**list) x /= unit;
    }
  }
}

}  // namespace

LaneLaw lane_law(StiffnessLaw law, double base, double unit) {
  LaneLaw lanes{law.index(), {}};
  std::visit(
      [&](auto& l) {
        divide_moduli(l, unit);
        const auto numbers = l.numbers(base / unit);
        for (const double x : numbers) lanes.numbers.push_back(static_cast<float>(x));
      },
      law);
  return lanes;
}

}  // namespace glisson::engine
