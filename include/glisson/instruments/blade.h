// blade.h — a blade as an instrument: its edge meets the fracture toughness of the tissue and cuts it.
//
//   Simulation::step ── pose, resistance ──▶ Blade ── between steps, every so often ──▶ Cutter ── split faces ─▶ body
//
// The edge meets a resistance of G l along its path, with l the length of edge in uncut tissue: the work of a cut is G
// times its area. Tissue that yields to less than that is carried along and not cut. The flat of the blade does not
// touch the tissue; attach a contact tool of its shape for that.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "glisson/field.h"
#include "glisson/instruments/cutting.h"
#include "glisson/instruments/instrument.h"

namespace glisson {

class Blade;

struct BladeOptions {
  using Instrument = Blade;  ///< constructed from these options
  static constexpr std::string_view kName = "blade";
  std::string name = "blade";
  Vec3d direction{0, 0, -1};                                  ///< direction of the depth; any length
  Vec3d edge_from{0.0, -0.01, 0.0}, edge_to{0.0, 0.01, 0.0};  ///< ends of the cutting edge in the tool's own axes [m]
  double toughness = 100.0;                                   ///< G of the tissue [J/m²]
  double cut_every = 1e-3;  ///< interval at which the passed tissue is separated [s]; 0: after every step
  CutOptions cutting{};

  template <class Take>
  static constexpr auto fields(Take take) {
    using B = BladeOptions;
    return take(
        no_key("name", &B::name), no_key("direction", &B::direction).direction(),
        field("edge_from", &B::edge_from, "mm", "one end of its edge, in its own axes, relative to its tip"),
        field("edge_to", &B::edge_to, "mm", "the other end"),
        field("toughness", &B::toughness, "J/m²", at_least(0), "fracture toughness of the tissue: work per area cut"),
        field("cut_every", &B::cut_every, "s", at_least(0),
              "interval at which the passed tissue is separated; 0: after every step"),
        no_key("cutting", &B::cutting));
  }
  Fault check() const;
};

/// A driven edge that cuts the tissue that it passes, as the body is stepped.
class Blade final : public Instrument {
 public:
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  Blade(const BladeOptions& options, std::shared_ptr<ToolDriver> driver);

  BladeEdge edge() const;                                            ///< present position [m]
  double area() const { return area_; }                              ///< cut so far, at rest [m²]
  double work_of_cut() const { return options_.toughness * area_; }  ///< [J]
  double length_in_tissue() const;                                   ///< length of edge in uncut tissue [m]
  const BladeOptions& options() const { return options_; }

  InstrumentForm form() const override {
    return {.kind = InstrumentForm::Kind::blade, .from = options_.edge_from, .to = options_.edge_to};
  }

  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  std::optional<std::span<const std::uint32_t>> keeps() override { return reached_; }
  void declare(const InteractionStep& step, StepRows& rows, int round) override;
  void solved(const InteractionStep& step, const StepRows& rows) override;
  void between_steps(Simulation& simulation) override;
  bool changes_body() const override { return true; }
  void moved(const InteractionStep& step) override;
  bool overshoots(const InteractionStep& step) override;
  std::string refuses_long_steps() const override;
  void archive(Archive& ar) override;
  std::shared_ptr<const void> save_state() const override;
  void load_state(const std::shared_ptr<const void>& state, const BodyView* other_body) override;

 private:
  struct Saved;
  void cut(double time, const BladeEdge& to);
  const Tet& vertices_of(const EdgePiece& piece) const { return mesh_->tets[piece.tet]; }
  void add_disc(const InteractionStep& step, const EdgePiece& piece, const BladeEdge& before, const BladeEdge& after,
                RowGroup& rows) const;
  bool is_active(const InteractionStep& step, const EdgePiece& piece) const;
  Vec3d last_force(const EdgePiece& piece) const;

  BladeOptions options_;
  std::optional<Cutter> cutter_;   ///< of the body it is attached to
  const TetMesh* mesh_ = nullptr;  ///< of that body
  std::span<const char> removed_;  ///< its tets, as in BodyView
  double area_ = 0.0, next_cut_ = 0.0;
  std::vector<EdgePiece> pieces_;
  std::vector<Vec3d> found_;  ///< per piece: its impulse in this step [N s]
  /// In long steps: force on the piece in a tet at the end of the last one, ascending by tet [N].
  std::vector<std::pair<std::uint32_t, Vec3d>> last_;
  std::vector<std::uint32_t> reached_;
};

}  // namespace glisson
