// fit_state_fuzz.cpp — any bytes as fit.state.json: a fit goes on from it, starts anew, or says why not, nothing else.
#include <stdexcept>

#include "fit/run_fit.h"
#include "glisson/scene.h"
#include "report/fit_json.h"
#include "report/fit_state.h"
#include "support.h"

namespace {

using namespace glisson;
using fuzz::require;

constexpr std::string_view kFit = R"([specimen]
kind = "block"
width_mm = 20
depth_mm = 20
height_mm = 20
[tissue]
hyperelastic = { kind = "ogden", mu_Pa = [1000], alpha = [-3], bulk_modulus_Pa = 1e5 }
[[parameter]]
key = "tissue.hyperelastic.mu_Pa[0]"
low = 100
high = 1e5
[[parameter]]
key = "tissue.hyperelastic.alpha[0]"
low = -20
high = -0.5
scale = "linear"
[[data]]
files = ["a.csv"]
resample.over = "none"
[search]
starts = 1
screen = 1
most_iterations = 2
[proof]
profiles = false
bootstrap = 0
next = false
)";
constexpr std::string_view kCurve =
    "displacement (mm);force (N)\n1;0.02\n2;0.05\n3;0.09\n4;0.14\n5;0.2\n6;0.28\n7;0.4\n8;0.5\n";
constexpr const char* kFingerprint = "fuzz";

const fit::FitSpec& small_fit() {
  static const fit::FitSpec spec = [] {
    fuzz::write_file(fuzz::scratch() / "a.csv", kCurve);
    return fit::parse_fit(kFit, (fuzz::scratch() / "fit.toml").string());
  }();
  return spec;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fit::FitSpec& spec = small_fit();
  const auto file = fuzz::scratch() / "fit.state.json";
  fuzz::write_file(file, {reinterpret_cast<const char*>(data), size});
  const auto memory = read_fit_state(file, kFingerprint);
  if (!memory) return 0;
  fit::FitOptions options;
  options.memory = *memory;
  try {
    const fit::FitResult result = fit::run_fit(spec, options);
    require(result.parameters.size() == 2, "a fit tells of its parameters");
  } catch (const std::invalid_argument&) {
  } catch (const std::runtime_error&) {  // what it remembers has no optimum
  }
  return 0;
}
