// command_view.cpp — glisson view: a scene that can be touched, or a run as it was recorded, in a browser.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <thread>

#include "cli/commands.h"
#include "glisson/version.h"
#include "program/embedded.h"
#include "program/exit_code.h"
#include "program/interrupt.h"
#include "program/mesh_cache.h"
#include "program/option_check.h"
#include "program/scene_options.h"
#include "program/standard_streams.h"
#include "view/engine/engine.h"
#include "view/engine/scene_writer.h"
#include "view/replay/replay.h"
#include "view/server/server.h"

namespace glisson::app {
namespace {

constexpr const char* kViewFooter =
    "Runs one variant in real time and serves a page to watch and control it; prints the address to open.\n"
    "Only this machine can connect, and only with the token in the address. Ctrl-C ends it.\n"
    "SCENE may be the folder that `glisson run` wrote: the same page plays the recording.\n"
    "\n"
    "Examples:\n"
    "  glisson view scenes/needle/bovine_liver.toml\n"
    "  glisson view scenes/paper/figure3a.toml --variant v10 --port 8080\n"
    "  glisson view out/figure3a --variant v10\n"
    "  glisson view scenes/organs/liver.toml --host 0.0.0.0 --token \"$(openssl rand -hex 16)\"";

struct Options {
  SceneOptions scene;
  view::ServerOptions server;
  int threads = 0;
};

void wait_for_the_end() {
  while (!stop_flag().load()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

/// Serves a source until Ctrl-C. @param told  printed before the address
int serve(view::Source& source, const view::SceneFacts& facts, const std::string& told,
          const view::ServerOptions& options) {
  view::Server server(source, facts, live_page(), options);
  catch_interrupts();
  source.start();
  server.start();
  say("{}\n{}\nCtrl-C ends it.\n", told, server.url());
  std::fflush(stdout);
  wait_for_the_end();
  server.stop();
  source.stop();
  return kDone;
}

std::string others(const std::string& variant, std::size_t count) {
  if (count < 2) return {};
  return fmt::format("variant {}, the first of {}; --variant NAME takes another\n", variant, count);
}

int view_scene(const Options& options) {
  const Scene scene = open_scene(options.scene);
  if (options.scene.variants.size() > 1) throw std::invalid_argument("--variant: view shows one variant");
  Variant variant = scene.variants.front();
  variant.simulation.threads = options.threads;
  MeshCache meshes(false);
  view::Engine engine(variant, meshes.loader());
  const view::SceneFacts facts{
      .title = scene.title.empty() ? scene.file.stem().string() : scene.title,
      .variant = variant.label.empty() ? variant.name : variant.label,
      .version = GLISSON_VERSION,
      .instruments = engine.forms(),
      .recorder = view::recording_writer(scene, variant, overrides_of(options.scene), engine.tools())};
  const std::string told =
      fmt::format("{}{}, {} tets", others(variant.name, scene.variants.size()), facts.title, engine.tets());
  return serve(engine, facts, told, options.server);
}

/// What changes a scene changes no recording.
void require_no_changes(const SceneOptions& options) {
  const std::string way_out = ": " + options.scene + " is a recorded run, which cannot be changed; give the scene";
  if (!options.set.empty()) throw std::invalid_argument("--set " + options.set.front() + way_out);
  if (!options.mesh.empty()) throw std::invalid_argument("--mesh " + options.mesh + way_out);
  if (options.variants.size() > 1) throw std::invalid_argument("--variant: view shows one variant");
}

int view_run(const Options& options) {
  require_no_changes(options.scene);
  const std::string wanted = options.scene.variants.empty() ? "" : options.scene.variants.front();
  view::RunFolder run = view::open_run(options.scene.scene, wanted);
  const view::SceneFacts facts{
      .title = run.title, .variant = run.label, .version = GLISSON_VERSION, .instruments = run.forms, .recorder = {}};
  std::string told = wanted.empty() ? others(run.variant, run.variants.size()) : "";
  told += fmt::format("{}, {} recorded frames, {} s", run.title, run.frames.size(), run.frames.back().time);
  if (!run.notice.empty()) told += "\n" + run.notice;
  view::Replay replay(std::move(run));
  return serve(replay, facts, told, options.server);
}

int view_any(const Options& options) {
  return view::is_folder(options.scene.scene) ? view_run(options) : view_scene(options);
}

}  // namespace

void add_view(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("view", "touch a scene in the browser, or play a recorded run");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene);
  command->add_option("--port", options->server.port, "port to listen on; 0: any free port")
      ->type_name("N")
      ->check(within(between(0, 65535), Numbers::whole, "0 takes any free port"))
      ->capture_default_str();
  command->add_option("--host", options->server.host, "address to listen on; one beyond this machine needs a --token")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command->add_option("--token", options->server.token, "token in the address of the page; default: random")
      ->type_name("TEXT")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const bool plain =
                text.find_first_not_of("0123456789abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ-_.") ==
                std::string::npos;
            return text.size() >= 16 && plain ? std::string()
                                              : std::string("16 characters or more, of letters, digits, - _ .");
          },
          "", "token"));
  command->add_option("--threads", options->threads, "threads of the engine; 0: chosen by the size of the body")
      ->type_name("N")
      ->check(within(between(0, 1024), Numbers::whole, "0 chooses by the size of the body"))
      ->capture_default_str();
  command->add_flag("--keep-running", options->server.keep_running,
                    "go on while no page is open or all are hidden; else the clock is held after 10 s of that");
  command->footer(kViewFooter);
  command->callback([options, &action] { action = [options] { return view_any(*options); }; });
}

}  // namespace glisson::app
