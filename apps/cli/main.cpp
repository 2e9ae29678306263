// main.cpp — the glisson program: reads the command line, runs one subcommand, says what went wrong and how.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "cli/commands.h"
#include "cli/last_words.h"
#include "cli/program_path.h"
#include "glisson/io.h"
#include "glisson/scene/scene.h"
#include "glisson/version.h"
#include "program/exit_code.h"
#include "program/option_check.h"
#include "program/standard_streams.h"
#include "report/output_file.h"

namespace {

using namespace glisson;
using namespace glisson::app;

constexpr const char* kFooter =
    "Examples:\n"
    "  glisson reproduce                        the paper's figures, in one report\n"
    "  glisson run scenes/paper/figure2.toml    one scene, all its variants\n"
    "  glisson check my_scene.toml              check a scene and its cost, without running it\n"
    "  glisson converge my_scene.toml           the error of its mesh, from finer ones\n"
    "  glisson fit my_fit.toml                  a tissue for measured curves, with uncertainties\n"
    "  glisson view my_scene.toml               run it live in the browser: push, pull, read the force\n"
    "  glisson plot out/my_scene --pdf          the charts of its report as files for a paper\n"
    "  glisson picture out/my_scene             the body at one instant, without a display\n"
    "  glisson mesh my_scene.toml --out b.vtu   write the mesh of a scene, and its figures\n"
    "  glisson info organ.vtu                   contents and defects of a mesh file, labels of an image\n"
    "  glisson image out/my_scene --like ct.nii.gz --field displacement --out u.nii.gz   a result on a CT's voxels\n"
    "  glisson bench --quick                    what a step costs on this machine\n"
    "\n"
    "See also `glisson COMMAND --help`. Exit status: 0 done, 1 failed, 2 a scene, mesh or option that cannot be\n"
    "used, 3 a run ended by a numerical failure, 4 a check that ran out of time, 130 interrupted.";

int complain(std::string_view what, int code) {
  std::fflush(stdout);
  tell("glisson: {}\n", what);
  return code;
}

int guarded(const Action& action) {
  try {
    return action();
  } catch (const SceneError& error) {
    return complain(error.what(), kUserError);
  } catch (const FileError& error) {
    return complain(error.what(), kUserError);
  } catch (const std::invalid_argument& error) {
    return complain(error.what(), kUserError);
  } catch (const std::bad_alloc&) {
    return complain(kOutOfMemory, kFailed);
  } catch (const std::system_error& error) {
    return complain(system_text(error), kFailed);
  } catch (const std::exception& error) {
    return complain(error.what(), kFailed);
  }
}

/// Says which commands there are when the first word is none of them; CLI11 would only say that one is required.
bool names_unknown_command(const CLI::App& program, int argc, char** argv) {
  if (argc < 2 || argv[1][0] == '-') return false;
  std::vector<std::string> names;
  for (const CLI::App* command : program.get_subcommands({})) names.push_back(command->get_name());
  if (std::find(names.begin(), names.end(), argv[1]) != names.end()) return false;
  tell("glisson: there is no command \"{}\"; the commands are {}\n", argv[1], fmt::join(names, ", "));
  return true;
}

/// Says so where a second value follows one --set, which the parser takes for a word too many.
bool sets_twice(int argc, char** argv) {
  const std::vector<std::string> words(argv, argv + argc);
  for (std::size_t i = 3; i < words.size(); ++i) {
    const bool value = words[i].find('=') != std::string::npos && !words[i].starts_with('-');
    if (!value || words[i - 2] != "--set") continue;
    tell("glisson: \"{}\" follows the value of a --set; each value takes its own: --set {}\n", words[i], words[i]);
    return true;
  }
  return false;
}

int run_program(int argc, char** argv) {
  if (argc > 0) program_path() = argv[0];
  CLI::App program{"Simulation of non-linear, viscoelastic soft tissue touched by instruments.", "glisson"};
  program.set_version_flag("--version", "glisson " GLISSON_VERSION);
  program.footer(kFooter);
  program.require_subcommand(1);
  program.failure_message(option_fault);
  Action action;
  add_run(program, action);
  add_check(program, action);
  add_converge(program, action);
  add_compare(program, action);
  add_scene(program, action);
  add_mesh(program, action);
  add_info(program, action);
  add_image(program, action);
  add_reproduce(program, action);
  add_schema(program, action);
  add_laws(program, action);
  add_tissues(program, action);
  add_material(program, action);
  add_fit(program, action);
  add_view(program, action);
  add_plot(program, action);
  add_picture(program, action);
  add_bench(program, action);
  if (names_unknown_command(program, argc, argv)) return kUserError;
  try {
    program.parse(argc, argv);
  } catch (const CLI::ExtrasError& error) {
    return sets_twice(argc, argv) ? kUserError : (program.exit(error), kUserError);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kDone : kUserError;
  }
  return guarded(action);
}

}  // namespace

int main(int argc, char** argv) {
  open_standard_streams();
  promise_last_words();
  if (const std::string why = stack_too_small(); !why.empty()) return complain(why, kFailed);
  return end_output(run_program(argc, argv));
}
