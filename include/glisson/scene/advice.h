// advice.h — what is known of a variant before it runs: meshes too coarse for what presses them, tissues that lock, paths that miss the
// body, steps that could be longer.
//
//   variant ──build──▶ VariantAtRest ──rules, a function each (src/scene/advice/)──▶ advice, in the order of `glisson check`
//
// `glisson check` prints it, each piece below what it is about. A run has in its summary and report what no second body is needed for.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "glisson/scene/scene.h"
#include "glisson/words.h"

namespace glisson {

/// What a rule says of a variant, or of a whole scene.
struct Advice {
  enum class Kind { remark, warning };
  enum class About { mesh, set, region, tissue, tool, instrument, step, scene };

  std::string variant;        ///< its name; empty: the whole scene
  std::string rule;           ///< as in the list of docs/output.md: "locking", "coarse", …
  Kind kind = Kind::remark;   ///< a warning: results may be wrong, or not those of what was meant
  About about = About::mesh;  ///< what it is about
  std::size_t index = 0;      ///< of that in the variant's list; of tissues 0 is the body's, the regions' follow
  std::string name;           ///< of that; empty where it has none
  std::string text;           ///< sentences with the numbers and the way out, a line break where a terminal needs one
};
template <>
inline constexpr Word<Advice::Kind> kWords<Advice::Kind>[] = {
    {"remark", Advice::Kind::remark, "what could be better, or is to be known"},
    {"warning", Advice::Kind::warning, "results may be wrong, or not those of what was meant"}};
template <>
inline constexpr Word<Advice::About> kWords<Advice::About>[] = {
    {"mesh", Advice::About::mesh, "the mesh"},
    {"set", Advice::About::set, "a vertex set"},
    {"region", Advice::About::region, "the bounds of a region"},
    {"tissue", Advice::About::tissue, "a tissue"},
    {"tool", Advice::About::tool, "a driven vertex set"},
    {"instrument", Advice::About::instrument, "an instrument"},
    {"step", Advice::About::step, "the time step"},
    {"scene", Advice::About::scene, "the tissues of all variants"}};

/// What rules look at: the body of a variant before its first step.
struct VariantAtRest {
  VariantAtRest() = default;
  VariantAtRest(const Variant& variant, const Simulation& simulation);

  TetMesh mesh;                         ///< where the run starts, that of the scene
  std::optional<double> largest_shift;  ///< of Start::loaded: of a vertex from its unloaded place [m]
  MeshReport report;                    ///< of the mesh
  double step_s = 0.0, stable_step_s = 0.0, mass_kg = 0.0;  ///< stable_step_s: infinite where any step is stable
  MassScaling scaling;
  std::vector<LimitingTet> limits;  ///< of an explicit step: the twentieth of the tets with the smallest bounds
  std::vector<double> corners;      ///< of motions and loads, 1000 at most, and the end of the run [s]
};

/// The time for rules that build a variant again to try what makes its steps longer. This one has no limit.
class TrialTime {
 public:
  virtual ~TrialTime() = default;
  /// Whether a trial may begin. @param seconds  that it may take
  virtual bool has_time(double /*seconds*/ = 0.0) const { return true; }
  virtual double elapsed() const { return 0.0; }  ///< since some start [s]
  /// A trial begins. @param what  in words
  virtual void begin(const std::string& /*what*/) {}
  /// There is no time for a trial. @param what  remains unknown, in words
  virtual void leave_out(const std::string& /*what*/) {}
};

/// Advice on mesh, sets, regions, tissues, tools and instruments, in this order. @throws std::invalid_argument as start_pose
std::vector<Advice> advise_on_body(const Variant& variant, const VariantAtRest& rest);
/// Advice on the steps. @param load, time  of the bodies that are built to try what makes them longer @throws SceneError
std::vector<Advice> advise_on_step(const Variant& variant, const VariantAtRest& rest, const MeshLoader& load,
                                   TrialTime& time);
/// Advice on laws that variants share, said once of them all.
std::vector<Advice> advise_on_laws(std::span<const Variant> variants);

/// Builds a variant and gives the advice on its body, then on its steps. It may build it several times, without a limit of time.
/// @throws SceneError if it cannot be built, and what `load` throws
std::vector<Advice> advise(const Variant& variant, const MeshLoader& load);

/// The same of a variant that is about to run, without the rules that build it again: `limits` and `viscous` are left out.
/// @param simulation  its body before the first step
std::vector<Advice> advise_at_rest(const Variant& variant, const Simulation& simulation);

/// What quasi_static does with Maxwell branches and viscosity where the variant has them and no `branches`; else empty.
std::string branches_note(const Variant& variant);

}  // namespace glisson
