// indentation_model.h — the forward model of a layer under an indenter: force over depth and time.
//
//   F(t) = F₀ − Σ g_i q_i + (η/μ) dF₀/dt,   q_i′ = (F₀ − q_i)/τ_i,   F₀(d) of indented_layer.h at depth d(t)
//
// F₀ is E/(1 − ν²) times the closed form of a thick layer times φ(d); ln φ is solved at ten depths, a monotone cubic joins them,
// and law_table.h keeps them between runs: most runs of a fit solve nothing. Branches are exact while the contact grows or
// rests, of the deviator where κ ≫ μ [LeeRadok1960], viscosity where strains are small and κ ≫ μ. While it shrinks, both are
// approximations. The indenter does not pull.
//
// In a creep F(t) is given: the same equation is one for F₀(t), linear and solved step by step, and d is where F₀(d) is that.
#pragma once

#include <memory>
#include <vector>

#include "fit/forward/law_table.h"
#include "fit/forward/specimen_model.h"
#include "instruments/motion/monotone_cubic.h"
#include "lab/indented_layer.h"

namespace glisson::fit {

struct IndentationOptions {
  double fineness = 1.0;  ///< of the mesh
  double margin = 0.0;    ///< by which curves may go deeper than they say, where contact is a parameter [m]
  bool table = true;      ///< false: every law is solved itself
};

class IndentationModel final : public MotionModel {
 public:
  /// @param curves  of measurements with an indenter @param parameters  of the values
  /// @throws std::invalid_argument naming what cannot be used
  IndentationModel(std::vector<Curve> curves, const Layer& layer, TissueAt tissue, std::vector<Parameter> parameters,
                   const IndentationOptions& options = {});
  Prediction predict_from(std::size_t curve, std::span<const double> values, double contact) const override;
  /// Laws that were solved so far.
  std::size_t solved() const;

 private:
  /// All curves of one indenter.
  struct Indenting {
    Indenter indenter;
    double deepest = 0.0;
    std::unique_ptr<LawTable> table;
  };
  const Indenting& indenting(std::size_t curve) const { return *indenting_[of_[curve]]; }
  std::vector<double> factors(const Indenting& own, std::span<const double> values) const;
  std::vector<std::size_t> of_law(const std::vector<Parameter>& parameters) const;

  Layer layer_;
  TissueAt tissue_;
  IndentationOptions options_;
  std::vector<std::unique_ptr<Indenting>> indenting_;
  std::vector<std::size_t> of_;  ///< of each curve
};

}  // namespace glisson::fit
