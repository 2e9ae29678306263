// command_laws.cpp — glisson laws: laws of stiffness and hyperelastic laws, from their own descriptions.
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include "base/unit_range.h"
#include "cli/commands.h"
#include "glisson/material/hyperelastic_law.h"
#include "glisson/material/stiffness_law.h"
#include "program/exit_code.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

template <class Law>
void print_law() {
  say("{}\n  {}\n", Law::kName, Law::kHelp);
  each_field<Law>([](const auto& field) {
    const Range range = detail::allowed(field);
    say("    {:<18} [{}], {}{}: {}\n", field.key(), field.unit, range.bounded() ? range.text() : "any",
        field.required ? "" : ", optional", field.help);
  });
}

template <class... Laws>
void print_laws(std::type_identity<std::variant<Laws...>>) {
  (print_law<Laws>(), ...);
}

}  // namespace

void add_laws(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("laws", "print the laws of tissues, with their parameters");
  command->footer("Examples:\n  glisson laws");
  command->callback([&action] {
    action = [] {
      say("Laws of stiffness: a modulus M follows the deformation x of its tet (tissue.law)\n\n");
      print_laws(std::type_identity<StiffnessLaw>{});
      say("\nHyperelastic laws: the stress is ∂W/∂F (tissue.hyperelastic)\n\n");
      print_laws(std::type_identity<HyperelasticLaw>{});
      return static_cast<int>(kDone);
    };
  });
}

}  // namespace glisson::app
