// command_schema.cpp — glisson schema: every key of a scene, as docs/scene.md has it.
#include <fmt/format.h>

#include "commands.h"
#include "exit_code.h"
#include "glisson/scene.h"

namespace glisson::app {

void add_schema(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("schema", "print every key of a scene with meaning, unit, range, default");
  command->footer("Prints Markdown.\n\nExamples:\n  glisson schema | less\n  glisson schema > docs/scene.md");
  command->callback([&action] {
    action = [] {
      fmt::print("{}", scene_reference_markdown());
      return static_cast<int>(kDone);
    };
  });
}

}  // namespace glisson::app
