// A tissue fitted to a measured curve by somebody else's program.
#include "glisson/fit.h"

#include <cstdio>

int main() {
  const glisson::fit::FitResult fit = glisson::fit::run_fit(GLISSON_FIT);
  for (const auto& p : fit.parameters)
    std::printf("%s = %g %s\n", p.parameter.name.c_str(), p.value, p.parameter.unit.c_str());
  std::printf("%g N rms\n", fit.rms_fit);
  return fit.complete && fit.parameters.size() == 2 && fit.rms_fit < 0.3 ? 0 : 1;
}
