// fit_state_fuzz.cpp — any bytes as fit.state.json: a fit goes on from it, starts anew, or says why not, nothing else.
//
// Where an input has the outline of a state, its checksum is made right, so that the reader behind is met.
#include <array>
#include <cinttypes>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "dynamics/state/checkpoint.h"
#include "fit/files/fit_state.h"
#include "fit/run_fit.h"
#include "glisson/scene/scene.h"
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

/// As fit_state.cpp has it: over fingerprint and laws.
std::string sealed(std::string_view input) {
  using Json = nlohmann::ordered_json;
  constexpr int kDeepest = 32;  // a text nests no deeper in a state; what frees a tree does so by recursion
  bool shallow = true;
  const auto watch = [&](int depth, Json::parse_event_t, const Json&) { return shallow = shallow && depth < kDeepest; };
  Json json = Json::parse(input, watch, false);
  if (!shallow || !json.is_object() || !json.contains("fingerprint") || !json.contains("laws"))
    return std::string(input);
  std::uint64_t hash = kHashStart;
  for (const char* part : {"fingerprint", "laws"}) {
    constexpr std::byte kEnd{0xff};
    const std::string text = json[part].dump();
    hash = hash_bytes(std::span(&kEnd, 1), hash_bytes(std::as_bytes(std::span(text)), hash));
  }
  std::array<char, 17> hex{};
  std::snprintf(hex.data(), hex.size(), "%016" PRIx64, hash);
  json["checksum"] = hex.data();
  return json.dump();
}

/// What is written is read back, whatever the format of the day.
bool round_trip() {
  const auto file = fuzz::scratch() / "fit.state.json";
  fit::FitMemory memory;
  memory["law"].starts.push_back({{0.5, 0.25}, {}});
  memory["law"].starts.back().optimum.scaled = {0.125, 0.75};
  write_fit_state(file, kFingerprint, memory);
  const std::string text = fuzz::read_file(file);
  fuzz::write_file(file, sealed(text));
  const auto again = read_fit_state(file, kFingerprint);
  return again && again->at("law").starts.at(0).optimum.scaled == memory["law"].starts[0].optimum.scaled;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const bool sound = round_trip();
  require(sound, "a sealed state is believed");
  const fit::FitSpec& spec = small_fit();
  const auto file = fuzz::scratch() / "fit.state.json";
  fuzz::write_file(file, sealed({reinterpret_cast<const char*>(data), size}));
  try {
    const auto memory = read_fit_state(file, kFingerprint);
    if (!memory) return 0;
    fit::FitRun options;
    options.memory = *memory;
    const fit::FitResult result = fit::run_fit(spec, options);
    require(result.parameters.size() == 2, "a fit tells of its parameters");
  } catch (const std::invalid_argument& error) {  // a damaged state
    require(std::string_view(error.what()).find(fuzz::scratch().string()) == 0, "a refusal begins with the file");
  } catch (const std::runtime_error&) {  // what it remembers has no optimum
  }
  return 0;
}
