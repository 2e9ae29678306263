// precision_choice.h — which submeshes move by the linear law: precision chosen by local deformation.
//
// Now and then a step examines all submeshes: P of the tissue's own law and P_l of its linear twin (linear_twin.h) at the same
// state give
//   e = Σ V (P_l − P) : H        what the linear law gets wrong of the virtual work of the displacement,
//   w = Σ V P : H                that work
// of each. Submeshes are linear, those first that get least wrong a tet, while Σ |e| ≤ share Σ w of the body. One that is not
// linear yet has to fit into four fifths of that, so that few go to and fro. None whose own law has become much stiffer than at
// rest is linear: the step was not chosen for what it would be like a step later. The law changes over 64 steps, in which the
// forces are a mean of both: a jump would make the body ring.
//
// A step in which the longest edge difference of a linear submesh has doubled since then asks for the next look at once.
//
// The energy of the elastic forces changes with the law: by the change of its share times the gap W_l − W = ∫ (P_l − P)(s H) : H ds,
// s from 0 to 1. It is found in the step before the law begins to change; steps that evaluate both laws go on from there by what
// their forces do.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/layout/submesh.h"
#include "glisson/archive.h"

namespace glisson::engine {

/// Tets that a submesh aims at where precision is adaptive: few, so that a small part of the body can have its own.
inline constexpr std::size_t kAdaptiveSubmesh = 1024;

/// By which the share of a linear law changes in a step: exact, so that shares are.
inline constexpr double kShareStep = 1.0 / 64.0;

/// What a look at a submesh found.
struct Examined {
  double work = 0.0, error = 0.0;  ///< w, e [J]
  double stiffening = 0.0;         ///< of its own law [-]
};

class PrecisionChoice {
 public:
  /// @param submeshes  must outlive this @param share  SimulationOptions::precision_error; 0: all move by their own law
  PrecisionChoice(Submeshes& submeshes, double share) : submeshes_(submeshes), share_(share) {}

  bool on() const { return share_ > 0.0; }
  /// All submeshes go by their own law, and the next step looks at them.
  void reset();
  /// A submesh goes by its own law from now on.
  void leave(std::size_t submesh);

  /// @param moves  whether the step has a length
  void begin_step(bool moves);
  /// Whether this step examines a submesh: all now and then, one whose law begins to change, and one that the linear law is to have
  /// alone.
  bool examines(std::size_t submesh) const { return examines_ || begins(submesh) || ends(submesh); }
  /// Whether the law of a submesh begins to change with the next step.
  bool begins(std::size_t submesh) const;
  /// Each of these is for one submesh, and may be called for several at the same time.
  void examined(std::size_t submesh, const Examined& seen) { seen_[submesh] = seen; }
  /// What its own law had come to at the last look, so that the step is chosen for its return.
  double stiffening(std::size_t submesh) const { return std::max(1.0, seen_[submesh].stiffening); }
  void moved(std::size_t submesh, float longest_edge_squared) { longest_[submesh] = longest_edge_squared; }
  /// @param gap  of the elastic forces [J]
  void set_gap(std::size_t submesh, double gap) { gaps_[submesh] = gap; }
  /// @param work  of the linear forces less that of the tissue's own in the last step [J]
  void worked(std::size_t submesh, double work) { gaps_[submesh] -= work; }

  /// Ends a step, after which shares may be others. @return the submeshes that are linear alone from here on, or no more, and those
  /// in which the linear law begins; ascending
  const std::vector<std::size_t>& end_step();
  /// Energy that the end of the step has brought in [J].
  double brought_in() const { return brought_in_; }

  /// Mean share of the linear law over the tets [-].
  double share_of_tets() const;

  void archive(Archive& ar);

 private:
  bool ends(std::size_t submesh) const;
  void choose();
  void shift();

  Submeshes& submeshes_;
  double share_;
  bool moves_ = false, examines_ = false, asked_ = false;
  std::uint64_t since_ = 0, period_ = 0;  ///< steps since the last look, and between two
  std::vector<Examined> seen_;            ///< per submesh, at the last look
  std::vector<double> gaps_;              ///< while the law changes [J]
  std::vector<float> longest_, then_;     ///< squared, now and at the last look [m²]
  std::vector<std::size_t> changed_;
  double brought_in_ = 0.0;
};

}  // namespace glisson::engine
