// stiffness_levels.h — single tets that are stiffer than the level h* is known for, and what they take off the step.
//
// h* is known for one level L of stiffness per tissue block (step_limits.h). A tet above it gets a level ℓ of its own, and n of
// its norm (element/stiff_element.h). With K_e what it adds to the stiffness at rest, m = λ_max of its tangent there,
//   tangent ≤ L K_e + x V m ‖Σ x_a ⊗ s_a‖²,   x = min(ℓ − L, n),
// and the second part is held against the masses of its vertices alone. Tets that share a vertex divide its mass by what each
// asks for, as in element_step_bound.h but among the few that are stiff: one that is alone has all of it,
//   ω² = max_e V x m λ_max(Σ_a s_a s_aᵀ/W_a),   W_a = m_a x V m |s_a|² / Σ of it over the stiff tets at a.
// With φ of the level, φ + h² ω² bounds that of the body (stable_step.h). The viscosity of such a tet may have grown as much as
// its stiffness and makes a ω_c of the same kind.
//
// A level has room above what was seen, so that it is looked at again only when a tet leaves it; it follows what is seen down
// once in a window, and a tet that has recovered is forgotten.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "element/body.h"
#include "element/stiff_element.h"
#include "glisson/archive.h"

namespace glisson {

/// Stiffness and viscosity that act beside those that h* is known for: λ_max on the body's masses, from above.
struct AddedStiffness {
  double k = 0.0;  ///< [1/s²]
  double c = 0.0;  ///< [1/s]
};

class StiffnessLevels {
 public:
  /// @param body  must outlive this
  explicit StiffnessLevels(const Body& body) : body_(body) {}

  /// What meet() found.
  struct Met {
    bool above = false;  ///< some tet is above the level it has
    double rise = 1.0;   ///< how many times as stiff as a step before the worst of those is
  };
  /// Takes in the elements that are stiff after a step; at the first time none has risen.
  /// @param base  level per block  @param unseen  stiffness per block up to which elements were not told before
  Met meet(std::span<const StiffElement> stiff, std::span<const double> base, std::span<const double> unseen);
  /// Gives those that the last meet() found above their level another, with room above the stiffness seen, more where a tet's
  /// own part in what all take was small, and times its rise within the last step, up to `most_ahead`.
  void raise(double most_ahead);
  /// Gives levels to all that the last meeting saw without or above one.
  void complete();
  /// The largest level per block, not below `base`.
  std::vector<double> largest(std::span<const double> base) const;
  /// Lets levels come down to the stiffest moment since the last time, with room.
  void settle();
  /// Forgets tets that the level of their block bears: they are told again where they rise above it.
  void forget_below(std::span<const double> base);
  /// What the tets above `base` take. @param viscous  per block, whether viscosity grows with them
  /// Cost: some 20 ns a tet above the base, and an eigenvalue for each that may be the worst.
  AddedStiffness added(std::span<const double> base, const std::vector<char>& viscous);
  /// Tets above a base.
  std::size_t count_above(std::span<const double> base) const;
  bool empty() const { return members_.empty(); }

  /// Forgets elements that are gone.
  void remove(std::span<const std::uint32_t> elements);
  /// Takes in that elements have another shape at rest.
  void reshape(std::span<const std::uint32_t> elements);
  void clear();
  void archive(Archive& ar);

 private:
  struct Member {
    std::uint32_t element = 0, block = 0;
    double ratio = 0.0, norm = 0.0;            ///< levels; 0: none of its own
    double seen_ratio = 0.0, seen_norm = 0.0;  ///< since levels came down last
    double last = 0.0, before = 0.0;           ///< ratio at the last two meetings
    double part = 1.0;                         ///< of what all took, at most; 1 until it is known
    std::uint64_t met = 0;                     ///< number of the last
    std::array<double, 4> squares{};           ///< |s_a|² [1/m²]
    double volume = 0.0;                       ///< at rest [m³]
    double elastic = 0.0, viscous = 0.0;       ///< bounds of the moduli [Pa], [Pa s]
    void archive(Archive& ar) { ar(element, met, ratio, norm, seen_ratio, seen_norm, last, before, part); }
  };
  /// What a tet above the base asks of its vertices' masses.
  struct Asking {
    std::uint32_t place;       ///< among members
    double k, c;               ///< V x m, of stiffness and of viscosity
    double upper;              ///< of λ_max(Σ s sᵀ/W)
    std::array<double, 4> of;  ///< V x m |s_a|²
  };
  Member& member(std::uint32_t element);
  void measure(Member& m) const;
  Asking ask(std::uint32_t place, std::span<const double> base, const std::vector<char>& viscous) const;
  void gather_asking(std::span<const double> base, const std::vector<char>& viscous);
  static bool is_above(const Member& m, double base);
  static double room_of(const Member& m);
  void keep_ordered();

  const Body& body_;
  std::vector<Member> members_;
  std::vector<std::uint32_t> place_;  ///< per element: 1 + place among members, 0 where it is none; empty: none is
  std::vector<std::uint32_t> above_;  ///< members that the last meet() found above
  std::uint64_t meetings_ = 0;
  std::vector<Asking> asking_;
  std::vector<double> asked_;  ///< per vertex, 0 between calls
};

}  // namespace glisson
