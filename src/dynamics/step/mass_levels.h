// mass_levels.h — levels of stiffness per tet under variable mass scaling, and the mass that their vertices need for them.
//
// Tets above the level of their block give their vertices mass in the place of a shorter step. With K_e and C_e what a level of its
// own leaves above that of the block, and w_a = ¼ (k h² + 2 c h) λ |s_a|², k and c the bounds of K_e and C_e, λ = λ_max(Σ ŝ_a ŝ_aᵀ),
//   h² K_e + 2 h C_e ≤ 4 Σ w_a |x_a|²,
// so that with masses w_a beside their own the step is as safe as without the tet.
//
// Where the body does not bear the level r of a block itself at h, each of its elements gets what its own mass m_e lacks,
//   h² r K_e + 2 h C_e ≤ 4 (M_e + ΔM_e)    and, with drag in stages,    h C_e ≤ ζ (M_e + ΔM_e).
//
// A level has room above what was seen, so that masses change seldom, and comes down to what was seen since the last time, a part of
// the tets after the other, so that no step has to look at all of them. As it is usual that half of the tets have one, all are kept, in
// the order of the elements.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "dynamics/step/added_levels.h"
#include "element/body.h"
#include "element/stiff_element.h"
#include "glisson/archive.h"

namespace glisson {

/// Mass of a vertex [kg].
struct VertexMass {
  std::uint32_t vertex = 0;
  double mass = 0.0;
};

/// What a step asks of the tets' masses beyond what the body is known to bear.
struct MassNeed {
  double step = 0.0;      ///< h [s]
  double weight = 1.0;    ///< on stiffness
  bool at_level = false;  ///< whether the body does not bear the levels of its blocks themselves at h
  bool drags = false;     ///< then: whether viscosity counts beside stiffness
  double drag_end = 0.0;  ///< ζ where h C ≤ ζ M has to hold beside, for drag in stages; 0: it does in any case
  const AddedLevels* beside = nullptr;  ///< of what acts beside the tissue
  /// Whether elements lack the same as by another one.
  bool asks_the_same(const MassNeed& other) const {
    return step == other.step && weight == other.weight && at_level == other.at_level && drags == other.drags &&
           drag_end == other.drag_end;
  }
};

class MassLevels {
 public:
  /// @param body  must outlive this
  explicit MassLevels(const Body& body) : body_(body) { body_changed(); }

  /// Whether no tet is above its level and that of its block.
  bool bear(std::span<const StiffElement> stiff, std::span<const double> base) const;
  /// Takes in what is stiff, and gives room to what comes close to its level.
  /// @param base, unseen  per block: its level, and the stiffness up to which elements were not told before
  /// @return how many times as stiff as when it was told last the worst of those above their levels is, at least 1; 1 at first
  double raise(std::span<const StiffElement> stiff, std::span<const double> base, std::span<const double> unseen);
  static constexpr std::uint32_t kParts = 32;  ///< of the tets, that settle in turn
  /// Has all tets of a part told, at any stiffness.
  void tell(std::uint32_t part);
  /// Lets levels of a part come down to the stiffest moment since the last time, with room; tets that were not told lose theirs.
  void settle(std::uint32_t part);
  /// Mass of the vertices of tets above `base`, of those that do not bear that, and of what acts beside the tissue.
  /// @param viscous  per block, whether viscosity grows with its tets
  /// @param masses  [out] ascending by vertex
  void find_masses(std::span<const double> base, const std::vector<char>& viscous, const MassNeed& need,
                   std::vector<VertexMass>& masses);
  /// Per element: from which it has to be told, a little below its level.
  std::span<const StiffLimit> limits() const { return limits_; }

  void clear();
  /// Takes another body in, without levels.
  void body_changed();
  /// Forgets elements that are gone.
  void remove(std::span<const std::uint32_t> elements);
  /// Takes in that tissues are others.
  void tissues_changed() { rates_.clear(); }
  /// Takes in that elements have another shape at rest.
  void reshape(std::span<const std::uint32_t> elements);
  void archive(Archive& ar);

 private:
  struct Tet {
    StiffLimit level;   ///< 0: none
    StiffLimit seen;    ///< largest since levels came down last
    float last = 0.0F;  ///< ratio when it was told last; 0: not since then
    void archive(Archive& ar) { ar(level.ratio, level.norm, seen.ratio, seen.norm, last); }
  };
  void measure(std::uint32_t element);
  void limit(std::uint32_t element);
  void find_rates();
  void ask_for_blocks(std::span<const double> base, const std::vector<char>& viscous, const MassNeed& need);
  std::uint32_t begin_of(std::uint32_t part) const { return static_cast<std::uint32_t>(tets_.size() * part / kParts); }

  /// Of an element: what each of its vertices has of its mass, and that times the largest eigenvalues of M⁻¹ K and M⁻¹ C.
  struct Rates {
    double mass = 0.0, stiff = 0.0, drag = 0.0;  ///< [kg, kg/s², kg/s]
  };

  const Body& body_;
  std::vector<Tet> tets_;
  std::vector<StiffLimit> limits_;
  std::vector<std::array<double, 4>> weights_;  ///< per element: ¼ V λ |s_a|² [m]
  std::vector<Rates> rates_;                    ///< per element; empty: not found yet
  bool fresh_ = true;                           ///< nothing has been taken in yet
  MassNeed known_;                              ///< what asked_for_blocks_ was found for, where rates_ are known
  std::vector<double> known_base_;              ///< the same
  std::vector<double> asked_for_blocks_;        ///< per vertex, by elements at the level of their block [kg]
  std::vector<double> asked_;                   ///< per vertex [kg]
};

}  // namespace glisson
