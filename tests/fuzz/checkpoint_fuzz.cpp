// checkpoint_fuzz.cpp — damaged checkpoints behind their checksum: one that fits is gone on from, any other is refused.
//
// The first byte picks one of the bodies of base/checkpoint, the second is the mode of forged_file.h.
#include <array>
#include <memory>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "forged_file.h"
#include "glisson/archive.h"
#include "glisson/scene/scene.h"
#include "support.h"

namespace {

namespace fs = std::filesystem;
using namespace glisson;
using fuzz::require;

constexpr std::array<const char*, 6> kBodies{"contact", "needle", "blade", "implicit", "static", "semi_implicit"};
constexpr int kSteps = 24;  // before it is saved: needle and blade are inside by then
Variant variant_of(std::size_t body) {
  const fs::path file = fs::path(GLISSON_FUZZ_BASE) / "checkpoint" / (std::string(kBodies[body]) + ".toml");
  Variant variant = load_scene(file).variants.at(0);
  variant.simulation.threads = 1;
  return variant;
}

/// The body after some steps; where its integrator bears it, with a tet gone and another tissue.
std::string saved(const Variant& variant) {
  const auto built = std::make_unique<BuiltVariant>(variant, MeshLoader{});
  for (int i = 0; i < kSteps; ++i) {
    const StepStatus status = built->simulation.step().status;
    require(status == StepStatus::ok || status == StepStatus::inverted, "the bodies that are saved can be stepped");
    if (i != kSteps / 2) continue;
    built->simulation.remove_tets(std::array<std::uint32_t, 1>{2});
    Tissue other = built->simulation.tissue(0);
    other.density *= 1.1;
    built->simulation.set_tissue(0, other);
  }
  std::ostringstream file;
  built->simulation.save(file);
  return file.str();
}

struct Body {
  Variant variant;
  std::string content;  ///< of its own checkpoint, between head and checksum
};

const Body& body_of(std::size_t number) {
  static std::array<std::optional<Body>, kBodies.size()> known;
  std::optional<Body>& body = known[number];
  if (!body) {
    const Variant variant = variant_of(number);
    const std::string file = saved(variant);
    body = Body{variant, fuzz::content_of(file)};
  }
  return *body;
}

/// Everything that can be asked, and some more steps.
void go_on(BuiltVariant& built) {
  for (int i = 0; i < 3; ++i) {
    const TetMesh mesh = built.simulation.present_mesh();
    for (const Tet& tet : mesh.tets) {
      for (const std::uint32_t v : tet) require(v < mesh.vertices.size(), "tets refer to vertices");
    }
    for (const ConstraintId c : built.supports) built.simulation.force(c);
    for (const auto& x : built.instruments) {
      archived(*x);
      for (const InstrumentColumn& column : x->columns()) column.read(*x);
    }
    built.simulation.tet_fields();
    built.simulation.energies();
    static_cast<void>(built.simulation.step());
  }
}

void load(const Body& body, std::string_view content) {
  const auto built = std::make_unique<BuiltVariant>(body.variant, MeshLoader{});
  std::istringstream file(fuzz::file_of(content));
  try {
    built->simulation.load(file);
  } catch (const std::runtime_error& error) {
    require(content != body.content, "what was saved is loaded");
    require(std::string_view(error.what()).substr(0, 10) == "checkpoint", "a refusal says of what");
    return;
  }
  go_on(*built);
}

}  // namespace

/// One of each body as it stands today (fuzz_replay_checkpoint --seeds FOLDER).
void write_seeds(const fs::path& folder) {
  for (std::size_t b = 0; b < kBodies.size(); ++b) {
    const std::string pick(1, static_cast<char>(b));
    fuzz::write_file(folder / (std::string(kBodies[b]) + "_content"), pick + '\0' + body_of(b).content);
    fuzz::write_file(folder / (std::string(kBodies[b]) + "_edits"), pick + '\1');
  }
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const Body& body = body_of(data[0] % kBodies.size());
  const std::string_view rest(reinterpret_cast<const char*>(data) + 2, size - 2);
  load(body, fuzz::forged_content(body.content, data[1], rest));
  return 0;
}
