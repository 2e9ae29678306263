// lane_law.cpp — the laws' parameters in the order in which law_stages-inl.h reads them.
#include "engine/kernels/kernels.h"

namespace glisson::engine {
namespace {

using Numbers = std::vector<float>;

Numbers numbers(const ConstantLaw&, double, double) { return {}; }
Numbers numbers(const StepLaw& law, double base, double unit) {
  return {float((law.above - base) / unit), float(law.threshold), float(law.width)};
}
Numbers numbers(const LinearLaw& law, double, double unit) { return {float(law.slope / unit)}; }
Numbers numbers(const PolynomialLaw& law, double, double unit) {
  Numbers out;
  for (const double c : law.coefficients) out.push_back(float(c / unit));
  return out;
}
Numbers numbers(const ExponentialLaw& law, double, double unit) {
  return {float(law.amplitude / unit), float(law.rate), float(ExponentialLaw::kLargestExponent)};
}
Numbers numbers(const TableLaw& law, double, double unit) {
  Numbers out;
  const std::size_t n = law.arguments.size();
  for (const double x : law.arguments) out.push_back(float(x));
  for (const double m : law.moduli) out.push_back(float(m / unit));
  for (std::size_t i = 0; i < n; ++i) {
    const bool last = i + 1 == n;
    out.push_back(last ? 0.0F
                       : float((law.moduli[i + 1] - law.moduli[i]) / unit / (law.arguments[i + 1] - law.arguments[i])));
  }
  return out;
}

}  // namespace

LaneLaw lane_law(const StiffnessLaw& law, double base, double unit) {
  return {law.index(), float(base / unit), std::visit([&](const auto& l) { return numbers(l, base, unit); }, law)};
}

}  // namespace glisson::engine
