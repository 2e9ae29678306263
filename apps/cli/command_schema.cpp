// command_schema.cpp — glisson schema: every key of a scene or of a fit, as docs/scene.md and docs/fit_file.md have them.
#include <fmt/format.h>

#include <memory>
#include <string>

#include "cli/commands.h"
#include "fit/spec/fit_spec.h"
#include "glisson/scene/scene.h"
#include "program/exit_code.h"
#include "program/option_check.h"
#include "program/standard_streams.h"

namespace glisson::app {

void add_schema(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("schema", "print every key of a scene, or of a fit, with meaning, unit, range, default");
  const auto what = std::make_shared<std::string>("scene");
  command->add_option("what", *what, "scene or fit")->check(one_of({"scene", "fit"}))->capture_default_str();
  command->footer(
      "Prints Markdown.\n\nExamples:\n  glisson schema | less\n  glisson schema > docs/scene.md\n"
      "  glisson schema fit > docs/fit_file.md");
  command->callback([&action, what] {
    action = [what] {
      say("{}", *what == "fit" ? fit::fit_reference_markdown() : scene_reference_markdown());
      return static_cast<int>(kDone);
    };
  });
}

}  // namespace glisson::app
