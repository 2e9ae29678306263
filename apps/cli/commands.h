// commands.h — the subcommands of the program, one file each.
#pragma once

#include <CLI/CLI.hpp>
#include <functional>

namespace glisson::app {

/// What a subcommand does once the whole command line has been read; returns the exit code.
using Action = std::function<int()>;

// Each adds its subcommand to the program; when it is the one chosen it sets `action`.
void add_run(CLI::App& program, Action& action);
void add_check(CLI::App& program, Action& action);
void add_converge(CLI::App& program, Action& action);
void add_compare(CLI::App& program, Action& action);
void add_mesh(CLI::App& program, Action& action);
void add_scene(CLI::App& program, Action& action);
void add_info(CLI::App& program, Action& action);
void add_image(CLI::App& program, Action& action);
void add_reproduce(CLI::App& program, Action& action);
void add_schema(CLI::App& program, Action& action);
void add_laws(CLI::App& program, Action& action);
void add_tissues(CLI::App& program, Action& action);
void add_material(CLI::App& program, Action& action);
void add_bench(CLI::App& program, Action& action);
void add_view(CLI::App& program, Action& action);
void add_fit(CLI::App& program, Action& action);
void add_plot(CLI::App& program, Action& action);
void add_picture(CLI::App& program, Action& action);

}  // namespace glisson::app
