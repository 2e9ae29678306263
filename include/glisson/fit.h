// fit.h — fits the numbers of a scene or specimen to measured curves, with intervals and a verdict for each
// (Glisson::fit; docs/fit.md).
//
//   FIT.toml ──▶ run_fit ──▶ FitResult: values, intervals, curves, laws compared, what to measure next
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glisson/indentation.h"
#include "glisson/scene/scene.h"
#include "glisson/words.h"

namespace glisson::fit {

/// What a laboratory does to a specimen.
enum class LabTest {
  compression,
  tension,
  relaxation,
  creep,
  cyclic,
  equibiaxial,
  planar,
  simple_shear,
  torsion,
  oscillation,
  indentation,
  heat
};
}  // namespace glisson::fit

namespace glisson {

template <>
inline constexpr Word<fit::LabTest> kWords<fit::LabTest>[] = {
    {"compression", fit::LabTest::compression, "pressed between plates, or by an instrument of the scene"},
    {"tension", fit::LabTest::tension, "pulled along its height; the sides are free"},
    {"relaxation", fit::LabTest::relaxation, "brought to a strain and held there: the stress over time"},
    {"creep", fit::LabTest::creep, "loaded and held there: the strain over time"},
    {"cyclic", fit::LabTest::cyclic, "strained to and fro"},
    {"equibiaxial", fit::LabTest::equibiaxial, "stretched alike along two axes; the third is free"},
    {"planar", fit::LabTest::planar, "stretched along one axis, held along the second; the third is free: pure shear"},
    {"simple_shear", fit::LabTest::simple_shear, "one face moved along the other at a constant distance"},
    {"torsion", fit::LabTest::torsion, "a cylinder twisted at a constant length: torque over angle"},
    {"oscillation", fit::LabTest::oscillation, "small shear to and fro: storage and loss modulus over frequency"},
    {"indentation", fit::LabTest::indentation, "an indenter pressed into a layer: force over depth, and as it is held"},
    {"heat", fit::LabTest::heat,
     "a body that a scene with [heat] cools or heats: a column of its temperature.csv or heat.csv over time"}};

}  // namespace glisson

namespace glisson::fit {

/// How a specimen deforms in a test.
enum class Deforming { compression, tension, equibiaxial, planar, simple_shear, torsion, indentation };
}  // namespace glisson::fit
namespace glisson {
template <>
inline constexpr Word<fit::Deforming> kWords<fit::Deforming>[] = {
    {"compression", fit::Deforming::compression, "along its height, the sides free"},
    {"tension", fit::Deforming::tension, "along its height, the sides free"},
    {"equibiaxial", fit::Deforming::equibiaxial, "alike along two axes, the third free"},
    {"planar", fit::Deforming::planar, "along one axis, held along the second, the third free"},
    {"simple_shear", fit::Deforming::simple_shear, "one face along the other at a constant distance"},
    {"torsion", fit::Deforming::torsion, "a cylinder about its axis at a constant length"},
    {"indentation", fit::Deforming::indentation, "a layer under an indenter"}};
}  // namespace glisson
namespace glisson::fit {

/// The measured quantity of a test; the forward model gives the same.
enum class Measured { nominal, cauchy, second_piola, torque, axial, strain, storage, loss, heat };

/// What of a scene of heat is measured.
struct HeatReading {
  std::string column;   ///< of its temperature.csv or heat.csv
  std::string over;     ///< a column that it is divided by; empty: none
  std::string variant;  ///< of the scene; empty: that of the fit

  bool operator==(const HeatReading&) const = default;
};

/// Meaning of the numbers of a curve. By default a press or an insertion: force over displacement.
struct Measurement {
  LabTest test = LabTest::compression;
  Deforming deforming = Deforming::compression;
  Measured measured = Measured::nominal;
  double stretch = 1.0;                ///< at rest about which an oscillation is small [-]
  bool timed = true;                   ///< false: the file has no times, those of the curve are made up
  bool point = false;                  ///< the specimen has no size: force on 1 m², displacement of 1 m
  std::string unit = "N";              ///< of Curve::force
  std::string drive_unit = "m";        ///< of Curve::displacement
  std::optional<Indenter> indenter{};  ///< of an indentation
  std::optional<HeatReading> heat{};   ///< of a test of heat

  bool operator==(const Measurement&) const = default;
  /// 1 where a positive displacement extends the specimen, −1 where it compresses it.
  double outward() const { return deforming == Deforming::compression ? -1.0 : 1.0; }
  /// A creep: a load is driven, and the strain or depth answers.
  bool loaded() const { return measured == Measured::strain; }
  bool is_press() const { return test == LabTest::compression && measured == Measured::nominal && !point; }
};

/// How a parameter is searched between its bounds.
enum class Scale { linear, logarithmic };
}  // namespace glisson::fit
namespace glisson {
template <>
inline constexpr Word<fit::Scale> kWords<fit::Scale>[] = {
    {"log", fit::Scale::logarithmic, "by factors: for numbers of unknown size; bounds > 0"},
    {"linear", fit::Scale::linear, "by differences"}};
}  // namespace glisson
namespace glisson::fit {

/// A number that the fit is free to choose, in the unit of its key.
struct Parameter {
  std::string name;              ///< what it is called in tables, unique, e.g. "tissue.law.slope_Pa"
  std::string unit;              ///< for tables; may be empty
  double low = 0.0, high = 1.0;  ///< bounds, low < high; both > 0 where the scale is logarithmic
  Scale scale = Scale::linear;
  double start = 0.0;  ///< of the first start, within the bounds
};

/// A test: how far the tool went and how hard it was pushed, at the same instants. Compression and insertion count positive.
///
/// In other tests `displacement` is what was driven and `force` what was measured, both positive as the test goes:
///
///   test                                       displacement                            force
///   compression, tension, equibiaxial, planar  |λ − 1| × height [m]                     P, σ or S × area [N]
///   simple_shear                               γ × height [m]                           the same of xz [N]
///   torsion                                    angle [rad]                              torque [N m], or axial force [N],
///                                                                                       positive as it pushes the plates apart
///   creep                                      nominal stress × area [N]                strain × height [m]
///   indentation                                depth [m]                                force [N]; of a creep the reverse
///   oscillation                                frequency [Hz], `time` is the row        storage or loss modulus [Pa]
///   heat                                       time [s]                                 the column, in its unit
struct Curve {
  std::string name;                  ///< unique among the curves of a fit, e.g. the file's stem
  std::string group;                 ///< repetitions of one test share it, e.g. "2 mm/s"
  std::string batch;                 ///< specimens that were made or taken together share it; empty: not said
  std::vector<double> time;          ///< ascending, from 0 [s]
  std::vector<double> displacement;  ///< of the tool from the point of contact [m]
  std::vector<double> force;         ///< on the tool, along its motion [N]
  /// History of the specimen before the first instant, as the cycles before the fitted one: ascending, before time[0] [s, m].
  std::vector<double> past_time, past_displacement;
  double velocity = 0.0;     ///< mean speed while loading [m/s]
  double noise = 0.0;        ///< standard deviation of the force about a smooth curve [N]; 0: not known
  bool noise_given = false;  ///< whoever measured says it; else it was estimated
  double weight = 1.0;       ///< factor on the residuals, ≥ 0
  bool held_out = false;     ///< kept from the fit, to test it
  Measurement measurement{};

  std::size_t size() const { return time.size(); }
};

/// In the parameter's own unit. An open end lies at the parameter's bound: the curves do not limit it before.
struct Interval {
  double low = 0.0, high = 0.0;
  bool low_open = false, high_open = false;

  bool open() const { return low_open && high_open; }
  bool holds(double value) const { return low <= value && value <= high; }
};

/// A fitted number and its uncertainty.
struct ParameterResult {
  Parameter parameter;
  double value = 0.0;                                              ///< in the parameter's unit
  std::optional<double> sd;                                        ///< in the parameter's unit, by curvature
  std::optional<Interval> by_curvature, by_profile, by_bootstrap;  ///< of 95 %
  std::optional<Interval> further;        ///< 95 % prediction interval of a further specimen's value; none: not known
  std::optional<Interval> further_batch;  ///< of the optimum of a further batch; none: fewer than three were fitted
  std::string verdict;                    ///< identified, negligible, weak, not identifiable, at bound, read off
  std::string words;                      ///< the verdict in two sentences

  /// The interval to trust most: by profile, else by bootstrap, else by curvature.
  std::optional<Interval> ci95() const {
    return by_profile ? by_profile : (by_bootstrap ? by_bootstrap : by_curvature);
  }
};

/// A curve and its fit.
struct CurveResult {
  Curve curve;
  std::vector<double> fitted;  ///< force at its instants [N]; empty where the simulation failed
  double rms = 0.0;            ///< of fitted − measured [N]
  /// 95 % prediction interval of a further specimen's force, at the same instants [N]; empty: not known.
  std::vector<double> further_low, further_high;
};

/// Repetitions of one test.
struct GroupResult {
  std::string name;
  bool held_out = false;
  double rms = 0.0;              ///< [N]
  std::optional<double> spread;  ///< rms of the repetitions about their mean [N]
};

/// Profile likelihood of a parameter.
struct ProfileResult {
  std::string parameter;
  std::vector<double> values, rise;  ///< values of the parameter and the rise of −2 ln L at each
  double threshold = 0.0;            ///< of the rise, at 95 %
  std::string words;
};

/// An optimum that was found.
struct BasinResult {
  double cost = 0.0;           ///< ½ Σ ρ(r²) [-]
  int found = 0;               ///< by how many descents
  std::vector<double> values;  ///< of the parameters
};

/// Where one descent ended.
struct StartResult {
  double cost = 0.0;  ///< ½ Σ ρ(r²) [-]
  int basin = -1;     ///< in FitResult::basins; −1: failed
};

/// All curves of one test: how well the fit of all meets them, and fits to each test alone.
struct TestResult {
  std::string name;  ///< of its group
  LabTest test = LabTest::compression;
  double r2 = 0.0;         ///< 1 − Σ (fitted − measured)² / Σ (measured − mean)²
  double rms = 0.0;        ///< of fitted − measured, in `unit`
  std::string unit;        ///< of rms
  std::size_t points = 0;  ///< of its curves
  bool held_out = false;
  /// r2 of this test by a fit to one test alone, in the order of FitResult::tests; NaN for a test that is held out or has no
  /// such fit; empty: there is only one.
  std::vector<double> r2_of_alone;
};

/// A law that was compared.
struct LawResult {
  std::string name;
  int parameters = 0;                 ///< free ones
  double rms_fit = 0.0;               ///< [N]
  std::optional<double> rms_heldout;  ///< of curves that its fit has not seen: held out, or left out in turn [N]
  double aic = 0.0, bic = 0.0;        ///< information criteria
  bool best = false;                  ///< the law that the result is of
  std::string words;
};

/// A law made of terms of the library, fitted in the search for a law with few terms.
struct DiscoveredLaw {
  std::string name;
  int terms = 0, parameters = 0;
  double cost = 0.0;   ///< ½ Σ ρ(r²) of its best descent
  double r2 = 0.0;     ///< the least of all tests
  bool taken = false;  ///< compared with the others by data its fit has not seen
};

/// A further test and the interval that it would narrow.
struct DesignResult {
  std::string what, parameter;                ///< the test, and the parameter it narrows most
  double width_now = 0.0, width_after = 0.0;  ///< of its interval, in its unit
};

/// Where the fitted law is stable on a path of deformation, dσ : dε > 0: looked at from half to twice the stretches of the data, or to
/// twice their shear, or as far as the law has answers. At rest a stretch is 1, and shear 0.
struct StabilityResult {
  std::string path;                              ///< uniaxial, equibiaxial: free stretch; simple_shear
  double low = 1.0, high = 1.0;                  ///< what was looked at [-]
  std::optional<double> lost_below, lost_above;  ///< beyond which it is not stable; none: it is [-]
};

/// Result of a fit: fit.json and the page are made from it.
struct FitResult {
  std::string law;  ///< its name
  std::vector<ParameterResult> parameters;
  std::vector<std::vector<double>> correlation;  ///< NaN where it could not be found
  std::vector<CurveResult> curves;
  std::vector<std::string> accounts;  ///< what was done to each curve, in a sentence
  std::vector<GroupResult> groups;
  std::vector<TestResult> tests;  ///< as `groups`
  std::string unit =
      "N";               ///< of all errors below; "" where tests differ in theirs: parts of each curve's largest number
  double rms_fit = 0.0;  ///< [N], or in `unit`
  std::optional<double> rms_heldout, spread;  ///< of held-out curves; of repetitions about their mean
  std::vector<ProfileResult> profiles;
  std::vector<BasinResult> basins;  ///< best first
  std::vector<StartResult> starts;
  int starts_planned = 0;
  std::uint64_t forward_runs = 0;              ///< a run of one curve each
  double forward_run_s = 0.0;                  ///< mean time of one [s]
  std::string forward;                         ///< which forward model, and why
  std::optional<double> forward_error;         ///< against the finest [N]
  double wall_s = 0.0;                         ///< time of the fit by the clock [s]
  bool complete = true;                        ///< false: interrupted
  std::vector<std::vector<double>> bootstrap;  ///< replicates, a row of parameters each
  std::vector<LawResult> laws;
  std::vector<DiscoveredLaw> discovered;  ///< all that were looked at; within a size the best first
  std::vector<DesignResult> designs;
  std::vector<StabilityResult> stability;  ///< of the law at once; empty where its measure depends on the mesh
  std::vector<std::string> conclusions;    ///< sentences
  std::string tissue;                      ///< text of tissue.toml, which a scene reads with `tissue.file`
  /// "membranes.toml" of a fit of [insertion], whose text is part of a scene; "keys.toml" of a fit of heat, the [set] of a FIT.toml.
  std::string result_file = "tissue.toml";
  std::optional<double> area, height;  ///< of the specimen [m²], [m]

  /// Whether each parameter stands at a bound or is not identifiable: the curves tell nothing of this law.
  bool identifies_nothing() const;
};

/// Progress of a fit.
struct FitProgress {
  std::string law;    ///< being fitted
  std::string stage;  ///< "forward models", "starts", "profiles", "bootstrap"
  std::size_t done = 0, planned = 1;
  double best_rms = 0.0;   ///< of all fitted curves, in `unit`
  std::string unit = "N";  ///< as that of FitResult
  int found = 0;           ///< how often the best optimum was found so far
  std::uint64_t forward_runs = 0;
};

/// Expected cost of the fit of a law; known once its forward model is chosen.
struct FitForecast {
  std::string law, forward;  ///< the forward model's name
  std::uint64_t least_runs = 0,
                most_runs = 0;  ///< forward runs: where every descent goes well, where starts have to go on
  double run_s = 0.0;           ///< of one run, one core
};

/// Options of run_fit. Callbacks are called one at a time.
struct FitOptions {
  std::vector<std::string> laws;  ///< further laws to compare, besides those of the file: names of `glisson fit --laws`
  /// Searches all subsets of a library of terms for a law with at most this many, 1 to 4; 0: no search. The best of each size are
  /// compared in place of the file's law. For a [specimen] with smooth faces.
  int discover = 0;
  std::filesystem::path data_folder;  ///< that files of curves are relative to; empty: the folder of FIT.toml
  MeshLoader load;                    ///< reads mesh files of the scene; none: a scene with a mesh file is an error
  const std::atomic<bool>* stop = nullptr;  ///< set it to end the fit early with an incomplete result
  std::function<void(const FitProgress&)> progress;
  std::function<void(const FitForecast&)> forecast;  ///< called once per law
};

/// Runs the fit that a FIT.toml describes (docs/fit_file.md). A fit that is stopped returns an incomplete
/// result, marked as such.
/// @throws SceneError, std::invalid_argument, std::runtime_error for descriptions, scenes and files that cannot be used
FitResult run_fit(const std::filesystem::path& file, const FitOptions& options = {});
/// The same from text; `name` stands for the file in messages, and its folder is that of the scene and the curves.
FitResult run_fit_text(std::string_view text, const std::string& name, const FitOptions& options = {});

}  // namespace glisson::fit
