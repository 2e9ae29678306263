// fit_spec.h — what FIT.toml says: which scene, which of its numbers are free, which curves, and how sure the answer is to be.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fit/data/data_spec.h"
#include "fit/forward/forward_spec.h"
#include "fit/search/loss.h"
#include "fit/spec/insertion_spec.h"
#include "glisson/scene/scene.h"

namespace glisson::fit {

/// A free number of the scene.
struct ParameterSpec {
  std::string key;   ///< of the scene, as --set takes it; `[i]` behind it for an element of a list
  std::string name;  ///< for tables; the key where empty
  double low = 0.0, high = 1.0;
  Scale scale = Scale::logarithmic;
  std::optional<double> start;  ///< none: the middle of the bounds
  std::string origin;           ///< `file:line:column: key`, for messages
};

/// The parameter as the optimiser knows it; its unit is read off its key.
Parameter parameter_of(const ParameterSpec& spec);
/// "Pa" of `tissue.law.slope_Pa`, "N·s/m²" of `…_N_s_m2`; empty where the key has none.
std::string unit_of_key(const std::string& key);

/// How the residuals of different curves are weighed against each other.
enum class Weighing {
  automatic,  ///< common where all curves are of one kind of test, else peak
  common,     ///< one standard deviation for all: the root mean square of the curves' noise
  noise,      ///< each curve its own noise
  peak        ///< one hundredth of each curve's largest force
};

struct SearchSpec {
  int starts = 20, found_again = 0, screen = 4, most_iterations = 100;
  std::uint64_t seed = 1;
  Weighing weighing = Weighing::automatic;
  Loss loss;
};

struct ProofSpec {
  bool profiles = true;
  int bootstrap = 200;                 ///< replicates, ≥ 0
  bool next = true;                    ///< looks for the test to make next
  std::optional<double> displacement;  ///< held-out errors are also told up to this displacement [m]
};

/// A law that is fitted beside others.
struct LawSpec {
  std::string name;
  std::vector<Override> set;  ///< keys of the scene that make it
  std::vector<ParameterSpec> parameters;
};

/// A test that could be made next.
struct ExperimentSpec {
  std::string name;
  double velocity = 0.0;       ///< [m/s], > 0
  double depth = 0.0;          ///< [m], > 0
  std::optional<double> hold;  ///< rest at depth [s]
};

struct FitSpec {
  std::filesystem::path file;
  std::string title, description;
  std::vector<std::string> notes;
  std::string source;           ///< the text of the file
  std::filesystem::path scene;  ///< empty: a specimen
  std::string variant;          ///< of the scene; empty: its only one
  std::optional<SpecimenSpec> specimen;
  std::vector<Override> set;  ///< keys of the scene with their values, [tissue] among them
  std::vector<ParameterSpec> parameters;
  std::vector<DataSpec> data;
  ForwardSpec forward;
  SearchSpec search;
  ProofSpec proof;
  std::vector<LawSpec> laws;
  std::vector<ExperimentSpec> experiments;
  std::optional<InsertionSpec> insertion;  ///< fits membranes in place of parameters

  bool is_heat() const { return !data.empty() && data.front().is_heat(); }
};

/// Reads FIT.toml. @throws SceneError with every problem of the file
FitSpec load_fit(const std::filesystem::path& file);
/// The same from text; `name` stands for the file in messages.
FitSpec parse_fit(std::string_view text, const std::string& name);

/// The reference of every key of FIT.toml in Markdown: docs/fit_file.md is this text.
std::string fit_reference_markdown();

}  // namespace glisson::fit
