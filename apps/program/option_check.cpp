#include "program/option_check.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "base/nearest.h"

namespace glisson::app {
namespace {

/// The whole text as a number; nothing where it is none.
template <class Number>
std::optional<double> number_in(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [after, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || after != end || !std::isfinite(static_cast<double>(value))) return {};
  return static_cast<double>(value);
}

/// The command that was given, or the program.
const CLI::App* command_of(const CLI::App* program) {
  const CLI::App* command = program;
  for (auto given = command->get_subcommands(); !given.empty(); given = command->get_subcommands())
    command = given.front();
  return command;
}

std::string full_name(const CLI::App* command) {
  const CLI::App* parent = command->get_parent();
  return (parent ? full_name(parent) + " " : "") + command->get_name();
}

/// `--set`, where an option of the command was probably meant.
std::string meant_option(const CLI::App* command, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command->get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return scene::nearest(word, names);
}

/// What is said of words that no option takes.
std::string extra_words(const CLI::App* command) {
  std::string text;
  for (const std::string& word : command->remaining()) {
    if (!text.empty()) text += "\n";
    const std::string meant = word.starts_with("-") ? meant_option(command, word) : std::string{};
    text += full_name(command) + (word.starts_with("-") ? " has no option " : " takes no further word ") + word +
            (meant.empty() ? "" : "; did you mean " + meant + "?");
    if (word.starts_with("-")) break;  // the words after it are its values
  }
  return text;
}

}  // namespace

CLI::Validator within(const Range& range, Numbers numbers, const std::string& way_out) {
  const bool whole = numbers == Numbers::whole;
  const auto fault = [=](const std::string& text) -> std::string {
    const std::optional<double> value = whole ? number_in<long long>(text) : number_in<double>(text);
    if (value && range.contains(*value)) return {};
    const std::string kind = whole ? " is no whole number; allowed: " : " is no number; allowed: ";
    return (value ? text + " is outside the allowed range, " : "\"" + text + "\"" + kind) + range.text() +
           (way_out.empty() ? "" : "; " + way_out);
  };
  return CLI::Validator(fault, range.text(), "RANGE");
}

CLI::Validator one_of(std::vector<std::string> words) {
  const std::string list = scene::listed(words);
  const auto fault = [words = std::move(words), list](const std::string& text) -> std::string {
    if (std::find(words.begin(), words.end(), text) != words.end()) return {};
    const std::string meant = scene::nearest(text, words);
    return "\"" + text + "\" is none of " + list + (meant.empty() ? "" : "; did you mean " + meant + "?");
  };
  return CLI::Validator(fault, list, "WORD");
}

std::string option_fault(const CLI::App* program, const CLI::Error& error) {
  const CLI::App* command = command_of(program);
  std::string text = error.what();
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr) {
    if (const std::string extra = extra_words(command); !extra.empty()) text = extra;
  }
  return "glisson: " + text + "\n`" + full_name(command) + " --help` lists what it takes.\n";
}

}  // namespace glisson::app
