#include "cli/advice_lines.h"

#include <string>

#include "program/standard_streams.h"

namespace glisson::app {
namespace {

constexpr const char* kMargin = "           ";  // of lines that go on

/// The word in front of it: the rule's, or what it is about where that stands for several rules.
std::string label(const Advice& advice) {
  const bool of_bounds = advice.about == Advice::About::set || advice.about == Advice::About::region;
  return of_bounds ? std::string(word_of(advice.about)) : advice.rule;
}

std::string with_margins(std::string text) {
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 1))
    text.insert(at + 1, kMargin);
  return text;
}

void print_one(const Advice& advice) {
  const std::string text = with_margins(advice.text);
  if (advice.about == Advice::About::mesh)
    say("{}{}: {}\n", kMargin, word_of(advice.kind), text);
  else if (advice.about == Advice::About::scene)
    say("\n{}\n", advice.text);
  else
    say("  {:<8} {}\n", label(advice), text);
}

}  // namespace

void print_advice(const std::vector<Advice>& advice, Advice::About about, std::optional<std::size_t> index) {
  for (const Advice& one : advice) {
    if (one.about == about && (!index || one.index == *index)) print_one(one);
  }
}

}  // namespace glisson::app
