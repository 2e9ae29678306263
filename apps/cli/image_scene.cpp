// image_scene.cpp — see image_scene.h.
#include "cli/image_scene.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "glisson/image/clean_labels.h"
#include "glisson/image/image_body.h"
#include "glisson/image/neighbours.h"
#include "glisson/image/read_image.h"
#include "glisson/scene/tissue_presets.h"

namespace glisson::app {
namespace {

constexpr double kSceneVoxelsAnEdge = 3.0;
constexpr double kClearanceMm = 5.0;         ///< of the finger from the organ at the start
constexpr std::size_t kFewestVoxels = 10;    ///< near the organ, of a label that is to support it
constexpr const char* kOfUnknown = "liver";  ///< whose tissue an organ without a preset gets

/// Words in the names of labels, and what they stand for.
struct Meaning {
  std::string_view of;  ///< a support's name, or a preset
  std::vector<std::string_view> words;
};

const std::vector<Meaning>& supports() {
  static const std::vector<Meaning> all{
      {"ribs", {"rib_", "costal_cartilage", "sternum"}},
      {"spine", {"vertebra", "sacrum"}},
      {"muscles", {"autochthon", "iliopsoas", "psoas"}},
      {"diaphragm", {"diaphragm", "lung", "heart"}},
      {"kidneys", {"kidney", "adrenal"}},
      {"bowel", {"stomach", "duodenum", "small_bowel", "colon", "pancreas", "esophagus", "intestine"}},
      {"spleen", {"spleen"}},
      {"table", {"table", "support"}},
      {"organs", {"liver", "gallbladder"}}};
  return all;
}

const std::vector<Meaning>& presets() {
  static const std::vector<Meaning> all{
      {"liver_tumour", {"tumour", "tumor", "lesion", "metasta", "cancer"}},
      {"liver_mre", {"liver"}},
      {"kidney_mre", {"kidney"}},
      {"brain_balbi", {"brain"}},
      {"muscle_thigh", {"muscle", "gluteus", "iliopsoas", "autochthon", "quadriceps"}}};
  return all;
}

/// What a name stands for; empty: nothing known.
std::string meaning_of_name(const std::vector<Meaning>& meanings, std::string name) {
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char c) { return std::tolower(c); });
  for (const Meaning& m : meanings) {
    const bool found = std::any_of(m.words.begin(), m.words.end(), [&](auto w) { return name.find(w) != name.npos; });
    if (found) return std::string(m.of);
  }
  return {};
}

bool is_vessel(const std::string& name) {
  static const std::vector<Meaning> vessels{
      {"vessel", {"vein", "vena", "artery", "aorta", "portal", "vessel", "cava", "gallbladder"}}};
  return !meaning_of_name(vessels, name).empty();
}

std::string toml_text(const std::string& word) {
  std::string text = "\"";
  for (const char c : word) {
    if (c == '"' || c == '\\') text += '\\';
    text += c;
  }
  return text + '"';
}

std::string list_of(const std::vector<std::string>& words) {
  std::vector<std::string> all;
  for (const std::string& w : words) all.push_back(toml_text(w));
  return fmt::format("[{}]", fmt::join(all, ", "));
}

Vec3d direction_of(Posture posture) {
  switch (posture) {
    case Posture::supine:
      return {0.0, -1.0, 0.0};
    case Posture::prone:
      return {0.0, 1.0, 0.0};
    case Posture::left:
      return {-1.0, 0.0, 0.0};
    case Posture::right:
      return {1.0, 0.0, 0.0};
    case Posture::upright:
      return {0.0, 0.0, -1.0};
  }
  return {};
}

const char* text_of(Posture posture) {
  switch (posture) {
    case Posture::supine:
      return "on the back";
    case Posture::prone:
      return "on the belly";
    case Posture::left:
      return "on the left side";
    case Posture::right:
      return "on the right side";
    case Posture::upright:
      return "upright";
  }
  return "";
}

/// Writes the parts of a scene one after the other.
class SceneWriter {
 public:
  SceneWriter(const ImageSceneOptions& options, const std::filesystem::path& folder);
  std::string text();

 private:
  void find_supports(const LabelImage& image);
  void add_head();
  void add_mesh();
  void add_tissues();
  void add_region(const std::string& name);
  void add_motion();
  void add_supports();
  void add_finger();
  std::string beside_name(const std::string& word) const { return word.substr(0, word.find('=')); }

  const ImageSceneOptions& o_;
  std::string path_, organ_, main_preset_;
  double edge_mm_ = 0.0;
  std::vector<LabelGroup> groups_;       ///< the organ's first
  std::vector<std::string> beside_;      ///< words of [mesh]
  std::vector<std::string> also_there_;  ///< names of labels beside the organ that nothing is made of
  bool cut_ = false;                     ///< by the image's border
  std::string out_;
};

SceneWriter::SceneWriter(const ImageSceneOptions& options, const std::filesystem::path& folder) : o_(options) {
  if (!(o_.beside_mm > 0.0) || (o_.press_mm && !(*o_.press_mm > 0.0)) || (o_.edge_mm && !(*o_.edge_mm > 0.0)))
    throw std::invalid_argument("--beside-mm, --press and --edge-mm have to be numbers above 0, in mm");
  path_ = std::filesystem::proximate(std::filesystem::absolute(o_.image),
                                     std::filesystem::absolute(folder.empty() ? "." : folder))
              .generic_string();
  std::vector<std::string> words{o_.organ};
  words.insert(words.end(), o_.labels.begin(), o_.labels.end());
  const LabelImage image = read_label_image(o_.image);
  groups_ = label_groups(words, image.names);
  organ_ = groups_.front().name;
  const Vec3d spacing = image.grid.spacing();
  edge_mm_ = o_.edge_mm.value_or(1e3 * kSceneVoxelsAnEdge * std::cbrt(spacing.x * spacing.y * spacing.z));
  for (const LabelFigures& f : label_figures(image)) {
    for (const LabelGroup& g : groups_)
      cut_ = cut_ || (f.at_border && std::find(g.labels.begin(), g.labels.end(), f.label) != g.labels.end());
  }
  find_supports(image);
}

/// What lies beside the body and is known by its name, a group for each support.
void SceneWriter::find_supports(const LabelImage& image) {
  const GroupImage body = clean_labels(image, groups_, {});
  std::map<std::string, std::vector<std::string>> found;
  for (const Neighbour& n : neighbours(image, body, 1e-3 * o_.beside_mm)) {
    const std::string support = meaning_of_name(supports(), n.name);
    if (support.empty() || n.voxels < kFewestVoxels)
      also_there_.push_back(n.name);
    else
      found[support].push_back(n.name);
  }
  beside_ = o_.beside;
  if (beside_.empty()) {
    for (const Meaning& m : supports()) {
      const auto it = found.find(std::string(m.of));
      if (it != found.end()) beside_.push_back(fmt::format("{}={}", m.of, fmt::join(it->second, "+")));
    }
  }
  if (!beside_.empty() || cut_) return;
  throw std::invalid_argument(
      fmt::format("{}: nothing holds \"{}\": no label within {} mm of it has the name of a support, as ribs or "
                  "vertebrae, and the image does not cut it. Give --beside NAME=LABELS, or a larger --beside-mm{}",
                  o_.image.string(), organ_, o_.beside_mm,
                  also_there_.empty() ? "" : fmt::format("; beside it are: {}", fmt::join(also_there_, ", "))));
}

void SceneWriter::add_head() {
  out_ += fmt::format(
      "# A scene of {}, written by `glisson scene from-image`. Every value may be changed; docs/scene.md has all "
      "keys.\n#\n#   glisson check THIS_FILE     what it holds, and what could be better\n"
      "#   glisson run THIS_FILE       forces, frames and a report\n\ntitle = {}\nnotes = [\n",
      organ_, toml_text(fmt::format("{} of {}", organ_, o_.image.filename().string())));
  out_ += fmt::format("  {},\n",
                      toml_text(fmt::format("Axes RAS: x to the patient's right, y to the front, z to the head; the "
                                            "patient lies or stands {}.",
                                            text_of(o_.posture))));
  out_ +=
      "  \"Tissues are presets, not measurements of this patient; supports are springs of a guessed "
      "stiffness.\",\n]\n\n";
}

void SceneWriter::add_mesh() {
  std::vector<std::string> words{o_.organ};
  words.insert(words.end(), o_.labels.begin(), o_.labels.end());
  out_ += fmt::format("[mesh]\nkind = \"image\"\npath = {}\nlabels = {}\n", toml_text(path_), list_of(words));
  if (!o_.implants.empty()) out_ += fmt::format("implants = {}\n", list_of(o_.implants));
  if (!beside_.empty()) {
    out_ += "# labels that are not meshed: the organ's surface near each is a set, for supports\nbeside = [\n";
    for (const std::string& word : beside_) out_ += fmt::format("  {},\n", toml_text(word));
    out_ += fmt::format("]\nbeside_mm = {:.6g}\n", o_.beside_mm);
  }
  if (!also_there_.empty()) out_ += fmt::format("# beside it, and left out: {}\n", fmt::join(also_there_, ", "));
  out_ += fmt::format("edge_mm = {:.6g}                # half of it: eight times the tets\n\n", edge_mm_);
}

void SceneWriter::add_tissues() {
  main_preset_ = meaning_of_name(presets(), organ_);
  const bool known = !main_preset_.empty();
  if (!known) main_preset_ = meaning_of_name(presets(), kOfUnknown);
  const TissuePreset& preset = tissue_preset(main_preset_);
  out_ += fmt::format(
      "[tissue]                      # of all regions without their own; `glisson tissues` lists others\n"
      "preset = {}{}# {}\n\n",
      toml_text(main_preset_), std::string(std::max<std::size_t>(1, 19 - main_preset_.size()), ' '),
      known ? preset.what : "no preset is known for " + toml_text(organ_) + ": this is the liver's");
  for (std::size_t i = 1; i < groups_.size(); ++i) add_region(groups_[i].name);
  for (const std::string& implant : o_.implants) add_region(beside_name(implant));
  if (organ_.find("liver") == organ_.npos) return;
  const TissuePreset& capsule = tissue_preset("liver_capsule");
  out_ += fmt::format(
      "[[capsule]]                   # of Glisson, on the surface of the organ\nname = \"capsule\"\nset = {}\n"
      "thickness_mm = 0.1\nyoungs_modulus_Pa = {:.6g}   # preset liver_capsule, {}\n\n",
      toml_text(organ_ + "_surface"), capsule.tissue.youngs_modulus, capsule.what);
}

void SceneWriter::add_region(const std::string& name) {
  const std::string preset = meaning_of_name(presets(), name);
  if (preset.empty() || preset == main_preset_) {
    out_ += fmt::format("# region {}: {}\n\n", toml_text(name),
                        is_vessel(name)  ? "full of blood or bile, as soft as the organ around it"
                        : preset.empty() ? "no preset is known for it, it has the tissue of all"
                                         : "it has the tissue of all");
    return;
  }
  out_ += fmt::format("[[region]]\nname = {}\ntissue.preset = {}   # {}\n\n", toml_text(name), toml_text(preset),
                      tissue_preset(preset).what);
}

void SceneWriter::add_motion() {
  const Vec3d g = direction_of(o_.posture) * 9.81;
  out_ += fmt::format(
      "[motion]\nstart = \"loaded\"              # the image shows the organ under its weight: it starts in "
      "equilibrium\n"
      "gravity_m_s2 = [{:.6g}, {:.6g}, {:.6g}]   # {}\ndamping_rate_per_s = 20\n",
      g.x, g.y, g.z, text_of(o_.posture));
  if (!o_.press_mm) out_ += "duration_s = 0.5\n";
  out_ += '\n';
}

void SceneWriter::add_supports() {
  if (cut_) {
    out_ += "[[fixed]]                     # the image ends in the organ: there it is held\nset = \"image_border\"\n\n";
  }
  if (beside_.empty()) return;
  out_ +=
      "# What lies beside the organ holds it by springs, per area. 200 kPa/m is a centimetre of tissue of 2 kPa;\n"
      "# [[fixed]] with the same set holds it rigidly.\n";
  for (const std::string& word : beside_)
    out_ += fmt::format("[[load]]\nset = {}\nspring_Pa_m = [200000, 200000, 200000]\n\n", toml_text(beside_name(word)));
}

void SceneWriter::add_finger() {
  if (!o_.press_mm) return;
  const std::string aim = o_.implants.empty() ? organ_ : beside_name(o_.implants.front());
  out_ += fmt::format(
      "[[instrument]]                # a finger that presses from the front, above the middle of a region\nkind = "
      "\"ball\"\n"
      "name = \"finger\"\nradius_mm = 10\ndirection = [0, -1, 0]\naim.region = {}\naim.clearance_mm = {:.6g}\n\n"
      "[instrument.motion]\nkind = \"press\"\nvelocity_mm_s = 40\ndepth_mm = {:.6g}               # the clearance, and "
      "{:.6g} mm "
      "into the organ\nhold_s = 0.1\n",
      toml_text(aim), kClearanceMm, kClearanceMm + *o_.press_mm, *o_.press_mm);
}

std::string SceneWriter::text() {
  add_head();
  add_mesh();
  add_tissues();
  add_motion();
  add_supports();
  add_finger();
  while (out_.ends_with("\n\n")) out_.pop_back();
  return std::move(out_);
}

}  // namespace

std::string image_scene(const ImageSceneOptions& options, const std::filesystem::path& folder) {
  return SceneWriter(options, folder).text();
}

}  // namespace glisson::app
