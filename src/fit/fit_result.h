// fit_result.h — what came out of a fit: all of it, for files, pages and programs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fit/curve.h"
#include "fit/model.h"
#include "fit/uncertainty/interval.h"

namespace glisson::fit {

struct ParameterResult {
  Parameter parameter;
  double value = 0.0;
  std::optional<double> sd;                                        ///< in the parameter's unit, by curvature
  std::optional<Interval> by_curvature, by_profile, by_bootstrap;  ///< of 95 %
  std::string verdict;                                             ///< identified, weak, not identifiable, at bound
  std::string words;

  /// The interval to trust most: by profile, else by bootstrap, else by curvature.
  std::optional<Interval> ci95() const {
    return by_profile ? by_profile : (by_bootstrap ? by_bootstrap : by_curvature);
  }
};

struct CurveResult {
  Curve curve;
  std::vector<double> fitted;  ///< force at its instants [N]; empty where the simulation failed
  double rms = 0.0;            ///< of fitted − measured [N]
};

/// Repetitions of one test.
struct GroupResult {
  std::string name;
  bool held_out = false;
  double rms = 0.0;              ///< [N]
  std::optional<double> spread;  ///< rms of the repetitions about their mean [N]
};

struct ProfileResult {
  std::string parameter;
  std::vector<double> values, rise;  ///< rise of −2 ln L
  double threshold = 0.0;
  std::string words;
};

struct BasinResult {
  double cost = 0.0;
  int found = 0;
  std::vector<double> values;
};

struct StartResult {
  double cost = 0.0;
  int basin = -1;  ///< −1: failed
};

struct LawResult {
  std::string name;
  int parameters = 0;
  double rms_fit = 0.0;
  std::optional<double> rms_heldout;
  double aic = 0.0, bic = 0.0;
  bool best = false;
  std::string words;
};

struct DesignResult {
  std::string what, parameter;
  double width_now = 0.0, width_after = 0.0;
};

struct FitResult {
  std::string law;
  std::vector<ParameterResult> parameters;
  std::vector<std::vector<double>> correlation;  ///< NaN where it could not be found
  std::vector<CurveResult> curves;
  std::vector<std::string> accounts;  ///< what was done to each curve, in a sentence
  std::vector<GroupResult> groups;
  double rms_fit = 0.0;                       ///< [N]
  std::optional<double> rms_heldout, spread;  ///< [N]
  std::vector<ProfileResult> profiles;
  std::vector<BasinResult> basins;  ///< best first
  std::vector<StartResult> starts;
  int starts_planned = 0;
  std::uint64_t forward_runs = 0;
  double forward_run_s = 0.0;           ///< mean cost of one, of one curve
  std::string forward;                  ///< which forward model, and why
  std::optional<double> forward_error;  ///< against the finest [N]
  double wall_s = 0.0;
  bool complete = true;                        ///< false: interrupted
  std::vector<std::vector<double>> bootstrap;  ///< replicates, a row of parameters each
  std::vector<LawResult> laws;
  std::vector<DesignResult> designs;
  std::vector<std::string> conclusions;
  std::string tissue;                  ///< tissue.toml
  std::optional<double> area, height;  ///< of the specimen [m²], [m]
};

}  // namespace glisson::fit
