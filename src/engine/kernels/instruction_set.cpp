// instruction_set.cpp — a word for each family of Highway's targets.
#include "glisson/simulation/instruction_set.h"

#include <hwy/highway.h>

#include <atomic>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace glisson::cpu {
namespace {

constexpr const char* kVariable = "GLISSON_INSTRUCTION_SET";

std::atomic<bool> chosen{false};  // by the program

/// The word for a target, by Highway's name of it; empty for those that nobody asks for.
std::string_view word_of(std::string_view target) {
  if (target.starts_with("AVX3")) return "avx512";
  if (target == "AVX2") return "avx2";
  if (target == "SSE4") return "sse4";
  if (target == "NEON") return "neon";
  return {};
}

/// Targets of this machine and this build that a word stands for; of all words where it is empty.
std::int64_t targets_of(std::string_view word) {
  std::int64_t mask = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::string_view own = word_of(hwy::TargetName(target));
    if (!own.empty() && (word.empty() || own == word)) mask |= target;
  }
  return mask;
}

/// @param source  what asked for it, as a message names it
void choose(const std::string& name, const std::string& source) {
  const std::int64_t wanted = name.empty() ? 0 : targets_of(name);
  if (wanted == 0) {
    std::string known;
    for (const std::string& word : instruction_sets()) known += (known.empty() ? "" : ", ") + word;
    throw std::invalid_argument(source + " \"" + name + "\": this machine or this build does not have it; there are: " +
                                (known.empty() ? "none to choose from" : known));
  }
  hwy::DisableTargets(~wanted);
}

}  // namespace

std::vector<std::string> instruction_sets() {
  std::vector<std::string> words;
  for (const char* word : {"avx512", "avx2", "sse4", "neon"}) {
    if (targets_of(word) != 0) words.emplace_back(word);
  }
  return words;
}

void use_instruction_set(const std::string& name) {
  choose(name, "instruction set");
  chosen = true;
}

void use_instruction_set_of_environment() {
  static const bool read = [] {
    const char* name = std::getenv(kVariable);
    if (!chosen && name != nullptr && *name != '\0') choose(name, std::string("environment variable ") + kVariable);
    return true;
  }();
  static_cast<void>(read);
}

}  // namespace glisson::cpu
