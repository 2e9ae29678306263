// energy_watch.h — whether a body has more energy than was put into it.
//
// Paid until a time is what may be in a body then:
//   |initial| + ∫ max(power of tools, 0) + ∫ max(power of loads, 0) + Σ |energy of changes of tissue and topology|     [J]
// A body that stores and loses energy never holds more. One that does has it from nothing: from a law whose closed cycles give work
// (docs/laws.md §3), or from steps that are unstable.
//
// It reads a ledger where that is read anyway, at samples: a step costs nothing. Between two samples only the difference of the work
// is known, which is less than the integral of its positive part, and still bounds what such a body can hold.
#pragma once

#include <optional>

#include "glisson/simulation/simulation.h"
#include "glisson/words.h"

namespace glisson {

/// What a body had more of than was paid, and from when on.
struct EnergyGain {
  enum class Of { none, kinetic, elastic, stored };
  Of of = Of::none;     ///< which exceeded its bound first
  double began = -1.0;  ///< time of the first look at which one did [s]; −1: never
  double most = 0.0;    ///< largest of kinetic, −elastic and stored energy over the paid energy [-]
  double paid = 0.0;    ///< at the last look [J]
  bool any() const { return of != Of::none; }
};
template <>
inline constexpr Word<EnergyGain::Of> kWords<EnergyGain::Of>[] = {
    {"none", EnergyGain::Of::none},
    {"kinetic", EnergyGain::Of::kinetic, "the kinetic energy is more than was put in"},
    {"elastic", EnergyGain::Of::elastic, "the elastic forces have given more work than they took"},
    {"stored", EnergyGain::Of::stored, "the stored energy is more than was put in"}};

class EnergyWatch {
 public:
  static constexpr double kMore = 1.01;  ///< kinetic energy over the paid one, from which on it is said [-]
  /// The same of W(u). The ledger's work is the trapezoidal rule of the steps: 1.1 % below W(u) in the first long step of a law
  /// that softens (scenes/tissue/brain_cortex.toml), 1.5 % at times in an undamped body at 0.9 h*.
  static constexpr double kMoreStored = 1.02;
  static constexpr double kGivenBack = 0.01;  ///< the same of −elastic [-]
  static constexpr double kRunaway = 10.0;    ///< of any of the three: nothing that follows has a meaning [-]

  /// @param negligible  energy that rounding may bring [J]; see negligible_energy()
  explicit EnergyWatch(double negligible = 0.0) : negligible_(negligible) {}

  /// Looks at the ledger; times rise from call to call. @param stored  W(u), where it is known
  void see(double time, const Energies& now, std::optional<double> stored = {});

  const EnergyGain& gain() const { return gain_; }
  bool runs_away() const { return gain_.most > kRunaway; }

 private:
  void pay(const Energies& now);
  void judge(EnergyGain::Of of, double time, double share, double bound);

  double negligible_;
  Energies last_;
  EnergyGain gain_;
};

/// The elastic energy of a strain of 1e-6 in all of the body [J]: below it, energies are rounding. Cost: a pass over the tets.
double negligible_energy(const Simulation& simulation);

}  // namespace glisson
