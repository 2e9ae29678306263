// command_laws.cpp — glisson laws: how a modulus can follow deformation, from the laws' own descriptions.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <utility>

#include "commands.h"
#include "exit_code.h"
#include "glisson/stiffness_law.h"

namespace glisson::app {
namespace {

std::string range_text(double min, double max) {
  if (std::isinf(min) && std::isinf(max)) return "any";
  if (std::isinf(max)) return fmt::format("{:g} or more", min);
  return std::isinf(min) ? fmt::format("up to {:g}", max) : fmt::format("{:g} to {:g}", min, max);
}

template <class Law>
void print_law() {
  fmt::print("{}\n  {}\n", Law::kName, Law::kHelp);
  for (const auto& field : Law::kFields) {
    fmt::print("    {:<18} [{}], {}{}: {}\n", field.key, field.unit, range_text(field.min, field.max),
               field.required ? "" : ", optional", field.help);
  }
}

template <std::size_t... I>
void print_laws(std::index_sequence<I...>) {
  (print_law<std::variant_alternative_t<I, StiffnessLaw>>(), ...);
}

}  // namespace

void add_laws(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("laws", "print the laws a modulus can follow, with their parameters");
  command->footer("Examples:\n  glisson laws");
  command->callback([&action] {
    action = [] {
      print_laws(std::make_index_sequence<std::variant_size_v<StiffnessLaw>>{});
      return static_cast<int>(kDone);
    };
  });
}

}  // namespace glisson::app
