// blade.h — a blade as an instrument: its edge meets the fracture toughness of the tissue and cuts it.
//
//   Simulation::step ── pose, resistance ──▶ Blade ── cut() between steps ──▶ Cutter ── split faces ─▶ Simulation
//
// The edge meets a resistance of G l along its path, with l the length of edge in uncut tissue: the work of a cut is G
// times its area. Tissue that yields to less than that is carried along and not cut. The flat of the blade does not
// touch the tissue; attach a contact tool of its shape for that.
#pragma once

#include "glisson/instruments/cutting.h"
#include "glisson/instruments/instrument.h"

namespace glisson {

struct BladeOptions {
  Vec3d edge_from{0.0, -0.01, 0.0}, edge_to{0.0, 0.01, 0.0};  ///< ends of the cutting edge in the tool's own axes [m]
  double toughness = 100.0;                                   ///< G of the tissue [J/m²], ≥ 0
  CutOptions cutting{};
};

class Blade final : public Instrument {
 public:
  /// @param simulation  it will be attached to; must outlive this, and stay where it is
  /// @throws std::invalid_argument naming the option, its value and the allowed range
  Blade(Simulation& simulation, std::string name, std::shared_ptr<ToolDriver> driver, const Vec3d& direction,
        const BladeOptions& options = {});

  /// Cuts the tissue that the edge has passed since the last call; to be called between steps, every one or every few.
  CutReport cut();

  BladeEdge edge() const;                                    ///< present position [m]
  double area() const { return area_; }                      ///< cut so far, at rest [m²]
  double work_of_cut() const { return toughness_ * area_; }  ///< [J]
  double length_in_tissue() const;                           ///< length of edge in uncut tissue [m]
  Cutter& cutter() { return cutter_; }                       ///< for its checkpoint

  void attached(const BodyView& body, double time) override;
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override;
  std::span<const std::uint32_t> reach(double time, double h) override;
  void constrain(const InteractionStep& step) override;
  void archive(Archive& ar) override;

 private:
  /// A piece of the edge and the vertices of its tet.
  struct Piece {
    EdgePiece at;
    Tet vertices{};
    void archive(Archive& ar);
  };
  void find_pieces();
  void resist(const InteractionStep& step, const Piece& piece, const Vec3d& velocity, const Vec3d& along);

  Simulation& simulation_;
  Cutter cutter_;
  Vec3d from_, to_;
  double toughness_, area_ = 0.0;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> reached_;
};

}  // namespace glisson
