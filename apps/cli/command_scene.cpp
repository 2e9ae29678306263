// command_scene.cpp — glisson scene from-image: a commented scene of an organ in a labelled image.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <memory>

#include "cli/commands.h"
#include "cli/image_scene.h"
#include "glisson/scene/scene.h"
#include "program/exit_code.h"
#include "program/option_check.h"
#include "program/standard_streams.h"

namespace glisson::app {
namespace {

struct SceneCommandOptions {
  ImageSceneOptions scene;
  std::string image, out, posture = "supine";
  bool force = false;
};

const std::map<std::string, Posture>& postures() {
  static const std::map<std::string, Posture> all{{"supine", Posture::supine},
                                                  {"prone", Posture::prone},
                                                  {"left", Posture::left},
                                                  {"right", Posture::right},
                                                  {"upright", Posture::upright}};
  return all;
}

int scene_from_image(SceneCommandOptions options) {
  const std::filesystem::path out = options.out;
  if (out.extension() != ".toml")
    throw std::invalid_argument("--out " + options.out +
                                ": a scene is written as .toml; give a name that ends in .toml");
  if (std::filesystem::exists(out) && !options.force)
    throw std::invalid_argument("--out " + options.out +
                                " exists and may hold your changes; give another name, or --force");
  options.scene.image = options.image;
  options.scene.posture = postures().at(options.posture);
  const std::string text = image_scene(options.scene, out.parent_path());
  std::ofstream file(out, std::ios::binary);
  if (!(file << text << std::flush)) throw std::invalid_argument("--out " + options.out + " cannot be written");
  load_scene(out);
  say("{}\n", options.out);
  return kDone;
}

void add_from_image(CLI::App& scene, Action& action) {
  CLI::App* command = scene.add_subcommand(
      "from-image", "write a commented scene of an organ in a labelled image: mesh, tissues, supports, gravity");
  const auto options = std::make_shared<SceneCommandOptions>();
  ImageSceneOptions& o = options->scene;
  command->add_option("image", options->image, "labelled image: .nii, .nii.gz, .nrrd, .nhdr, .seg.nrrd, .mha, .mhd")
      ->required()
      ->type_name("IMAGE");
  command->add_option("--out", options->out, "the scene to be written")->required()->type_name("SCENE.toml");
  command->add_option("--organ", o.organ, "name or number of its label; `glisson info IMAGE` lists them")
      ->type_name("L")
      ->capture_default_str();
  command->add_option("--labels", o.labels, "further regions of the body, as in [mesh]: gallbladder,vessels=63+64")
      ->delimiter(',')
      ->type_name("L,…");
  command
      ->add_option("--implant", o.implants,
                   "NAME=ball:X,Y,Z,DIAMETERmm or NAME=ellipsoid:X,Y,Z,A,B,Cmm, RAS in mm; may be given again")
      ->allow_extra_args(false)
      ->type_name("NAME=SHAPE");
  command
      ->add_option("--beside", o.beside,
                   "what holds it: labels that are not meshed, as table=9; may be given again. Otherwise those near it "
                   "with names as rib_, vertebra, kidney, lung, colon")
      ->allow_extra_args(false)
      ->type_name("NAME=L+…");
  command->add_option("--beside-mm", o.beside_mm, "how near these are")->type_name("MM")->capture_default_str();
  command->add_option("--posture", options->posture, "how the patient lies or stands")
      ->check(one_of({"supine", "prone", "left", "right", "upright"}))
      ->capture_default_str();
  command
      ->add_option("--press", o.press_mm,
                   "a finger presses so deep, from the front, above the first implant or the organ")
      ->type_name("MM");
  command->add_option("--edge-mm", o.edge_mm, "mean edge of the tets; default: three voxels")->type_name("MM");
  command->add_flag("--force", options->force, "replace the scene where it exists");
  command->footer(
      "The scene starts under gravity as it is in the image (motion.start = \"loaded\").\n\nExamples:\n"
      "  glisson scene from-image labels.nii.gz --organ liver --press 10 --out liver.toml\n"
      "  glisson run liver.toml --out liver");
  command->callback([&action, options] { action = [options] { return scene_from_image(*options); }; });
}

}  // namespace

void add_scene(CLI::App& program, Action& action) {
  CLI::App* scene = program.add_subcommand("scene", "write a scene");
  scene->require_subcommand(1);
  add_from_image(*scene, action);
}

}  // namespace glisson::app
