// needle.h — a needle that presses, pierces, cuts, rubs along its shaft, rests and withdraws.
//
//            hand ┬                 material points of the path, one every `spacing`:
//                 │                   across the shaft they stay on it, and bend it,
//     surface ════╪════  P₀           along it they stick until friction yields
//                 │
//      tissue     ·      P₁           the tip is held back until its force suffices to pierce or
//                 ·      P₂           to cut; then the path grows along its track
//                 ▼ tip
//
// Where the path leaves the tissue, at the far side, in a cavity or before another piece, it may enter anew: each stretch of tissue
// has its own contact, puncture and cutting, and only the shaft within them rubs.
//
// The tissue is not remeshed: the path is embedded. A path point represents the tissue within `zone` of it, so that
// forces do not depend on the mesh as long as it resolves the zone (docs/needles.md).
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "glisson/contact/shaft_friction.h"
#include "glisson/field.h"
#include "glisson/instruments/instrument.h"
#include "glisson/words.h"

namespace glisson {

/// Resistance at the tip in a region, or at its boundary.
struct TipResistance {
  double cutting = 0.0;   ///< cutting force in the region [N]
  double puncture = 0.0;  ///< force to enter the region through its boundary [N]; 0: the cutting force

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("cutting", &TipResistance::cutting, "N", at_least(0), "cutting force"),
                field("puncture", &TipResistance::puncture, "N", at_least(0),
                      "of a region: force to enter it; 0: the cutting force"));
  }
};

/// A membrane across the path, below the surface; it holds the tip up to a force, as a region's boundary does.
struct InnerMembrane {
  double depth = 0.0;               ///< below the first entry, along the needle, in tissue at rest [m]
  double puncture = 0.0;            ///< force of the tip to break it [N]; 0: the cutting force before it
  std::optional<double> cutting{};  ///< cutting force beyond it, up to the next that gives one or the next region [N]

  template <class Take>
  static constexpr auto fields(Take take) {
    using M = InnerMembrane;
    return take(field("depth", &M::depth, "mm", at_least(0), "depth below the first entry, in tissue at rest").must(),
                field("puncture", &M::puncture, "N", at_least(0), "force to break it; 0: the cutting force"),
                field("cutting", &M::cutting, "N", at_least(0), "cutting force beyond it").otherwise("as before it"));
  }
};

/// Membranes drawn at random from the surface to the needle's length: a Poisson process of exponential distances, and normally
/// distributed forces, drawn again where not above 0 (src/instruments/needle/membranes.cpp).
struct MembraneProcess {
  double spacing = 5e-3;   ///< mean distance [m]
  double puncture = 1.0;   ///< mean force to break one [N]
  double spread = 0.2;     ///< standard deviation of that force over its mean [-]
  std::uint64_t seed = 1;  ///< the same membranes on every machine

  template <class Take>
  static constexpr auto fields(Take take) {
    using M = MembraneProcess;
    return take(field("spacing", &M::spacing, "mm", at_least(0.1), "mean distance of two"),
                field("puncture", &M::puncture, "N", above(0), "mean force to break one"),
                field("spread", &M::spread, "-", between(0, 1), "standard deviation of that force over its mean"),
                field("seed", &M::seed, "each seed draws other membranes"));
  }
};

/// Puncture criterion of the surface under the tip.
struct Rupture {
  std::optional<double> force{};      ///< puncture at this force of the tip [N]; or
  std::optional<double> toughness{};  ///< when spring-back releases this energy per area of the slit [J/m²] …
  double membrane_thickness = 1e-4;   ///< … of this thickness, one needle diameter long [m]

  template <class Take>
  static constexpr auto fields(Take take) {
    return take(field("force", &Rupture::force, "N", above(0), "force of the tip at the puncture"),
                field("toughness", &Rupture::toughness, "J/m²", above(0),
                      "puncture when spring-back releases this energy per area of the slit, one diameter long"),
                field("membrane_thickness", &Rupture::membrane_thickness, "mm", above(0), "depth of the slit"));
  }
  Fault check() const;
};

class Needle;

struct NeedleOptions {
  using Instrument = Needle;  ///< constructed from these options
  static constexpr std::string_view kName = "needle";
  std::string name = "needle";
  double diameter = 1.27e-3;  ///< [m]; 18 G
  double length = 0.1;        ///< from the hand to the tip [m]
  Vec3d direction{0, 0, -1};  ///< initial direction, from the hand to the tip; any length
  double zone = 3e-3;         ///< radius of the tissue around a path point that carries its force [m]
  double spacing = 2e-3;      ///< distance of path points [m]; less than a third of the zone only costs time
  Rupture rupture{};          ///< neither given: puncture at the cutting force of the tissue below
  TipResistance tip{};        ///< of regions that `regions` does not name; its puncture is not used
  std::map<int, TipResistance> regions{};            ///< by region number
  std::vector<InnerMembrane> membranes{};            ///< by ascending depth
  std::optional<MembraneProcess> drawn_membranes{};  ///< besides these
  ShaftFriction friction{};
  /// Young's modulus [Pa]: the needle bends as a cantilever from the hand; none: it is rigid.
  std::optional<double> youngs_modulus{};
  double inner_diameter = 0.0;  ///< inner diameter of a tube, for its bending [m], below the diameter
  /// Sideways force on a bevelled tip relative to its cutting force [-], and its direction. It steers needles that bend.
  double bevel_share = 0.0;
  Vec3d bevel_side{1, 0, 0};  ///< across the direction; any length

  template <class Take>
  static constexpr auto fields(Take take) {
    using N = NeedleOptions;
    return take(
        no_key("name", &N::name), field("diameter", &N::diameter, "mm", above(0), "diameter"),
        field("length", &N::length, "mm", above(0), "from the hand to the tip"),
        no_key("direction", &N::direction).direction(),
        field("zone", &N::zone, "mm", above(0), "radius of the tissue around a path point that carries its force"),
        field("spacing", &N::spacing, "mm", above(0), "distance of the path points"),
        field("rupture", &N::rupture, "when the surface is punctured"), field("tip", &N::tip, "resistance at the tip"),
        no_key("regions", &N::regions),
        field("membranes", &N::membranes, "membranes below the surface that the tip has to break"),
        field("drawn_membranes", &N::drawn_membranes, "membranes at random, besides these"),
        field("friction", &N::friction, "friction along the inserted shaft"),
        field("youngs_modulus", &N::youngs_modulus, "Pa", above(0),
              "Young's modulus of the needle, a cantilever clamped at the hand")
            .otherwise("rigid"),
        field("inner_diameter", &N::inner_diameter, "mm", at_least(0), "inner diameter of a tube, for its bending"),
        field("bevel_share", &N::bevel_share, "-", at_least(0),
              "sideways force of a bevelled tip over its cutting force"),
        no_key("bevel_side", &N::bevel_side));
  }
  Fault check() const;
};

/// All membranes of a needle, those that are given and those that are drawn, by ascending depth, down to its length.
/// The drawn ones are the same bytes on every machine.
std::vector<InnerMembrane> membranes_of(const NeedleOptions& options);

/// Stage of an insertion.
enum class NeedleStage {
  outside,   ///< no contact
  pressing,  ///< the tip presses on an intact surface; before it the shaft may be in tissue
  inside     ///< a surface is pierced; the tip may have come out at the far side
};
template <>
inline constexpr Word<NeedleStage> kWords<NeedleStage>[] = {
    {"outside", NeedleStage::outside}, {"pressing", NeedleStage::pressing}, {"inside", NeedleStage::inside}};

/// A stretch of a line that lies in tissue.
struct TissueInterval {
  double from = 0.0, to = 0.0;  ///< distances along the line [m]
};

class Needle final : public Instrument {
 public:
  /// @param driver  moves the tip of the unbent needle; its axes are not used: the needle keeps its direction
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  /// Depth and events count along the needle from where its tip starts.
  Needle(const NeedleOptions& options, std::shared_ptr<ToolDriver> driver);
  ~Needle() override;

  NeedleStage stage() const;
  /// What of the needle is in tissue as it is deformed now: distances from the hand, ascending.
  std::vector<TissueInterval> crossing() const;
  double inserted_length() const;   ///< of the shaft in tissue: that of all of crossing() [m]
  double path_length() const;       ///< depth of the path's end below the first entry, in tissue at rest [m]
  double tip_force() const;         ///< force of the tip along the needle [N]; no step shows in it (docs/needles.md)
  std::vector<Vec3d> path() const;  ///< material points from the first surface to the deepest, present positions [m]
  const NeedleOptions& options() const;

  InstrumentForm form() const override;
  std::vector<Vec3d> centre_line() const override;
  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  std::optional<std::span<const std::uint32_t>> keeps() override;
  std::string refuses_long_steps() const override;
  bool overshoots(const InteractionStep& step) override;
  void add_forces(const InteractionStep& step) override;
  void declare(const InteractionStep& step, StepRows& rows, int round) override;
  void solved(const InteractionStep& step, const StepRows& rows) override;
  int most_drag_stages() const override;
  void moved(const InteractionStep& step) override;
  void between_steps(Simulation& simulation) override;
  double tool_energy() const override;  ///< of its bending [J]
  Vec3d handle() const override;        ///< its length behind the tip, as if nothing bent it
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  struct State;
  struct Solver;
  void look_for_contact(const InteractionStep& step);
  void press_on(const InteractionStep& step);
  void pierce(const InteractionStep& step);
  void go_on(const InteractionStep& step);
  void go_through(const InteractionStep& step, const Vec3d& at);
  void watch_withdrawal(const InteractionStep& step, double gap);
  void watch_drop(double time, double h);
  std::unique_ptr<State> state_;
};

}  // namespace glisson
