// command_view.cpp — glisson view: a scene that can be touched, in a browser.
#include <fmt/format.h>

#include <chrono>
#include <memory>
#include <thread>

#include "commands.h"
#include "embedded.h"
#include "exit_code.h"
#include "interrupt.h"
#include "mesh_cache.h"
#include "report/version.h"
#include "scene_options.h"
#include "view/engine.h"
#include "view/server.h"

namespace glisson::app {
namespace {

constexpr const char* kFooter =
    "Runs one variant at the pace of the clock and serves a page to watch and steer it; prints the address to open.\n"
    "Only this machine is let in, and only with the token in the address. Ctrl-C ends it.\n"
    "\n"
    "Examples:\n"
    "  glisson view scenes/needle/bovine_liver.toml\n"
    "  glisson view scenes/paper/figure3a.toml --variant v10 --port 8080\n"
    "  glisson view scenes/organs/liver.toml --mesh liver.vtu --host 0.0.0.0 --token \"$(openssl rand -hex 16)\"";

struct Options {
  SceneOptions scene;
  view::ServerOptions server;
  int threads = 0;
};

void wait_for_the_end() {
  while (!stop_flag().load()) std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

int view_scene(const Options& options) {
  const Scene scene = open_scene(options.scene);
  if (options.scene.variants.size() > 1) throw std::invalid_argument("--variant: view shows one variant");
  Variant variant = scene.variants.front();
  variant.simulation.threads = options.threads;
  MeshCache meshes(false);
  view::Engine engine(variant, meshes.loader());
  const view::SceneFacts facts{.title = scene.title.empty() ? scene.file.stem().string() : scene.title,
                               .variant = variant.label.empty() ? variant.name : variant.label,
                               .version = std::string(version()),
                               .instruments = engine.forms()};
  view::Server server(engine, facts, live_page(), options.server);
  catch_interrupts();
  engine.start();
  server.start();
  if (scene.variants.size() > 1)
    fmt::print("variant {}, the first of {}; --variant NAME takes another\n", variant.name, scene.variants.size());
  fmt::print("{}, {} tets\n{}\nCtrl-C ends it.\n", facts.title, engine.tets(), server.url());
  std::fflush(stdout);
  wait_for_the_end();
  server.stop();
  engine.stop();
  return kDone;
}

}  // namespace

void add_view(CLI::App& program, Action& action) {
  CLI::App* command = program.add_subcommand("view", "touch a scene in the browser: push, pull, read the force");
  const auto options = std::make_shared<Options>();
  add_scene_options(*command, options->scene);
  command->add_option("--port", options->server.port, "port to listen on; 0: one that is free")
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--host", options->server.host, "address to listen on; one beyond this machine needs a --token")
      ->type_name("ADDRESS")
      ->capture_default_str();
  command->add_option("--token", options->server.token, "what the address of the page must hold; none: a random one")
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
  command
      ->add_option("--threads", options->threads, "threads of the engine; 0: as many as pay for the size of the body")
      ->type_name("N")
      ->check(CLI::Range(0, 1024))
      ->capture_default_str();
  command->footer(kFooter);
  command->callback([options, &action] { action = [options] { return view_scene(*options); }; });
}

}  // namespace glisson::app
