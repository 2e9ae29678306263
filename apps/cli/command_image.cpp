// command_image.cpp — glisson image: a field of a run, or the regions of a mesh, on the voxels of an image.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>

#include "base/text.h"
#include "cli/commands.h"
#include "glisson/image/body_image.h"
#include "glisson/image/read_image.h"
#include "glisson/image/write_image.h"
#include "glisson/io.h"
#include "program/exit_code.h"
#include "program/json_option.h"
#include "program/standard_streams.h"
#include "view/replay/variant_folder.h"

namespace glisson::app {
namespace {

constexpr const char* kImageFooter =
    "Each voxel of FILE has what the body has at its centre: fields at vertices linear in each tet, fields of tets by\n"
    "means at the vertices of a region (--own: that of the tet), labels the region. Displacements are in mm, other\n"
    "fields in SI as their arrays; vectors and tensors along RAS. The body lies where the image has it at rest, or\n"
    "--deformed where it is in that frame.\n"
    "\n"
    "Examples:\n"
    "  glisson image out/liver --like ct.nii.gz --field displacement --out displacement.nii.gz\n"
    "  glisson image out/liver --frame 12 --like ct.nii.gz --field von_mises --outside 0 --out stress.nii.gz\n"
    "  glisson image out/liver --like ct.nii.gz --field labels --deformed --out pressed_labels.nii.gz\n"
    "  glisson image body.vtu --like labels.nii.gz --field labels --out meshed_labels.nii.gz";

/// Behind the name of an array stands its unit.
constexpr const char* kUnits[] = {"", "_m", "_m_s", "_Pa", "_C", "_min"};
constexpr const char* kDisplacement = "displacement_m";
constexpr const char* kRemoved = "removed";

struct ImageOptions {
  std::string body, variant, like, field, out, outside;
  int frame = -1;
  bool deformed = false, own = false, quiet = false;
};

std::filesystem::path frame_of(const std::filesystem::path& collection, int number) {
  const auto frames = read_pvd(collection);
  const int count = static_cast<int>(frames.size());
  if (number < -count || number >= count)
    throw std::invalid_argument(fmt::format("--frame {}: {} has {} frames, 0 to {}, and -1 is the last", number,
                                            collection.string(), count, count - 1));
  return collection.parent_path() / frames[static_cast<std::size_t>(number < 0 ? number + count : number)].second;
}

/// The file of a body: a .vtu, a frame of a .pvd, or of a run's folder.
std::filesystem::path body_file(const ImageOptions& options) {
  std::filesystem::path body = options.body;
  std::error_code none;
  if (std::filesystem::is_directory(body, none))
    return frame_of(view::variant_folder(std::filesystem::weakly_canonical(body), options.variant).path / "frames.pvd",
                    options.frame);
  if (!options.variant.empty())
    throw std::invalid_argument("--variant is for the folder of a run; " + options.body + " is none");
  if (body.extension() == ".pvd") return frame_of(body, options.frame);
  if (body.extension() != ".vtu")
    throw std::invalid_argument(options.body + ": give the folder of a run, a .pvd or a .vtu");
  if (options.frame != -1)
    throw std::invalid_argument("--frame is for a run or a .pvd; " + options.body + " is one frame");
  return body;
}

/// What is read of a frame, and the array that is asked for: on vertices or on tets.
struct Body {
  ReadFrame frame;
  const Field* field = nullptr;
  bool on_vertices = false;
  std::vector<Vec3d> positions;  ///< empty: at rest
  std::vector<char> removed;     ///< empty: none is
};

const Field* find_field(const std::vector<Field>& fields, const std::string& word) {
  for (const char* unit : kUnits) {
    for (const Field& f : fields) {
      if (f.name == word + unit) return &f;
    }
  }
  return nullptr;
}

std::vector<Vec3d> deformed(const std::filesystem::path& file, const ReadFrame& frame) {
  const Field* u = find_field(frame.vertex_fields, kDisplacement);
  if (u == nullptr || u->components != 3)
    throw std::invalid_argument(file.string() + ": has no displacement, so --deformed says nothing; leave it out");
  std::vector<Vec3d> positions = frame.mesh.vertices;
  for (std::size_t v = 0; v < positions.size(); ++v)
    positions[v] += Vec3d{u->values[3 * v], u->values[3 * v + 1], u->values[3 * v + 2]};
  return positions;
}

bool are_labels(const std::string& word) { return word == "labels" || word == "label" || word == "region"; }

void read_body(const ImageOptions& options, Body& body) {
  const std::filesystem::path file = body_file(options);
  std::vector<std::string> wanted{kDisplacement, kRemoved};
  for (const char* unit : kUnits) wanted.push_back(options.field + unit);
  body.frame = read_frame(file, wanted);
  for (const Field& f : body.frame.tet_fields) {
    if (f.name == kRemoved) body.removed.assign(f.values.begin(), f.values.end());
  }
  if (options.deformed) body.positions = deformed(file, body.frame);
  if (are_labels(options.field)) return;
  body.field = find_field(body.frame.vertex_fields, options.field);
  body.on_vertices = body.field != nullptr;
  if (body.field == nullptr) body.field = find_field(body.frame.tet_fields, options.field);
  if (body.field == nullptr)
    throw std::invalid_argument(fmt::format("{}: has no field \"{}\"; it has: {}{}labels", file.string(), options.field,
                                            fmt::join(body.frame.arrays, ", "), body.frame.arrays.empty() ? "" : ", "));
}

/// The number of --outside. @throws std::invalid_argument
std::optional<double> outside_of(const ImageOptions& options) {
  if (options.outside.empty()) return {};
  double value = 0.0;
  const char *first = options.outside.data(), *last = first + options.outside.size();
  const auto [end, error] = std::from_chars(first, last, value);
  const bool is_label = value >= 0.0 && value <= 65535.0 && value == std::floor(value);
  if (error != std::errc() || end != last || std::isinf(value) || (are_labels(options.field) && !is_label))
    throw std::invalid_argument("--outside " + options.outside + ": give a " +
                                (are_labels(options.field) ? "label, 0 to 65535" : "number, or nan"));
  return value;
}

/// xx, xy, yy, xz, yz, zz of symmetric tensors that stand row by row.
Field symmetric_half(const Field& field) {
  Field half{.name = field.name, .components = 6, .values = {}};
  for (std::size_t i = 0; i + 9 <= field.values.size(); i += 9) {
    const double* s = field.values.data() + i;
    half.values.insert(half.values.end(), {s[0], s[1], s[4], s[2], s[5], s[8]});
  }
  return half;
}

/// Writes a field. @return its name and unit
std::string write_field(const ImageOptions& options, const Body& body, const VoxelPlaces& places, float outside) {
  Field field = *body.field;
  const bool shift = field.name == kDisplacement;
  if (shift) {
    for (double& x : field.values) x *= 1e3;
  }
  if (field.components == 9) field = symmetric_half(field);
  const ValueImage image = body.on_vertices
                               ? places.vertex_values(field.values, field.components, outside)
                               : places.tet_values(field.values, field.components,
                                                   options.own ? TetValues::own : TetValues::smooth, outside);
  const VoxelValues kind = shift                   ? VoxelValues::displacement
                           : field.components == 3 ? VoxelValues::vector
                           : field.components == 6 ? VoxelValues::symmetric
                                                   : VoxelValues::plain;
  std::string name = shift ? "displacement_mm" : field.name;
  write_nifti(options.out, image, kind, name);
  return name;
}

std::string box_text(const TetMesh& mesh) {
  const auto [low, high] = box_of(mesh);
  return fmt::format("{:.0f} to {:.0f}, {:.0f} to {:.0f}, {:.0f} to {:.0f} mm", 1e3 * low.x, 1e3 * high.x, 1e3 * low.y,
                     1e3 * high.y, 1e3 * low.z, 1e3 * high.z);
}

int image(const ImageOptions& options) {
  const std::optional<double> outside = outside_of(options);
  const ImageGrid grid = read_image_grid(options.like);
  Body body;
  read_body(options, body);
  const VoxelPlaces places(body.frame.mesh, grid, body.positions, body.removed);
  if (places.inside() == 0)
    throw std::invalid_argument(
        fmt::format("{}: no voxel's centre lies in the body, which is at {} in RAS; give the image that it was made "
                    "of (`glisson info {}` gives its extent)",
                    options.like, box_text(body.frame.mesh), options.like));
  std::string name = "labels";
  if (body.field != nullptr) {
    name = write_field(options, body, places,
                       static_cast<float>(outside.value_or(std::numeric_limits<double>::quiet_NaN())));
  } else {
    const auto label = static_cast<std::uint16_t>(outside.value_or(0.0));
    write_nifti(options.out, places.labels(label), name);
    const std::vector<int>& regions = body.frame.mesh.regions;
    if (regions.empty() || std::find(regions.begin(), regions.end(), int{label}) != regions.end())
      tell_warning(fmt::format("region {0} has the same number as what is outside; give another by --outside", label));
  }
  if (options.quiet) return kDone;
  say("{}: {}, {} × {} × {} voxels, {} of them in the body ({:.4g} mL), {} outside\n", options.out, name, grid.size[0],
      grid.size[1], grid.size[2], places.inside(), 1e6 * static_cast<double>(places.inside()) * grid.voxel_volume(),
      outside                 ? fmt::format("{:g}", *outside)
      : body.field != nullptr ? "NaN"
                              : "0");
  return kDone;
}

}  // namespace

void add_image(CLI::App& program, Action& action) {
  CLI::App* command =
      program.add_subcommand("image", "a field of a run, or the regions of a mesh, on an image's voxels");
  const auto options = std::make_shared<ImageOptions>();
  command->add_option("body", options->body, "folder of a run with frames, a .pvd, or a .vtu")
      ->required()
      ->type_name("BODY");
  command
      ->add_option("--like", options->like, "the image whose grid is taken (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd)")
      ->required()
      ->type_name("IMAGE");
  command
      ->add_option("--field", options->field,
                   "labels, or an array of the frame, with or without its unit: displacement, stress, von_mises, "
                   "pressure, temperature …")
      ->required()
      ->type_name("NAME");
  command->add_option("--out", options->out, "the image, a .nii or .nii.gz file")
      ->required()
      ->type_name("FILE")
      ->check(file_place);
  command->add_option("--frame", options->frame, "number of the frame, from 0; -1: the last")->capture_default_str();
  command->add_option("--variant", options->variant, "default: the first");
  command
      ->add_option("--outside", options->outside, "what voxels outside the body get: nan, or 0 of labels, unless given")
      ->type_name("VALUE");
  command->add_flag("--deformed", options->deformed, "on the body as it is in that frame; else at rest");
  command->add_flag("--own", options->own, "of tets: the value of each, with jumps at its faces");
  command->add_flag("--quiet", options->quiet, "print nothing but errors");
  command->footer(kImageFooter);
  command->callback([options, &action] { action = [options] { return image(*options); }; });
}

}  // namespace glisson::app
