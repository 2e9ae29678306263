#include "fit/run_fit.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>

#include "fit/fill_result.h"
#include "fit/forward/offset_model.h"
#include "fit/insertion/run_insertion_fit.h"
#include "fit/laws/discovery.h"
#include "fit/laws/fit_curves.h"
#include "fit/laws/forecast.h"
#include "fit/laws/law_candidates.h"
#include "fit/laws/law_search.h"
#include "fit/laws/law_stability.h"
#include "fit/model/curve_kinds.h"
#include "fit/tissue_of_fit.h"
#include "fit/uncertainty/covariance.h"
#include "fit/uncertainty/criteria.h"
#include "fit/uncertainty/left_out.h"
#include "fit/uncertainty/test_table.h"
#include "fit/uncertainty/validation.h"
#include "fit/uncertainty/verdict.h"

namespace glisson::fit {
namespace {

using Searches = std::vector<std::unique_ptr<LawSearch>>;

/// Area and height where the fit says them.
SpecimenSize size_of(const FitSpec& spec) {
  if (!spec.specimen) return {};
  if (spec.specimen->shape == SpecimenShape::layer)
    return {.area = {}, .height = spec.specimen->thickness, .radius = {}};
  const Specimen s = specimen_of(*spec.specimen);
  return {.area = s.area,
          .height = s.height,
          .radius = s.radius > 0.0 ? std::optional(s.radius) : std::nullopt,
          .point = spec.specimen->shape == SpecimenShape::point};
}

/// A description alone may name no parameter: those of laws that are asked for come with them.
void require_something_free(const FitSpec& spec, const FitRun& options) {
  if (!spec.parameters.empty() || !spec.laws.empty() || !options.laws.empty() || options.discover > 0) return;
  throw SceneError(
      spec.file.string() +
      ": nothing is free; give one or more [[parameter]] with key, low and high, or fit laws by name: --laws "
      "constant,linear (glisson fit --list-laws)");
}

/// The law of [[parameter]], those of [[law]], those asked for by name.
std::vector<LawSpec> laws_of(const FitSpec& spec, const FitRun& options, const FitCurves& curves) {
  std::vector<LawSpec> laws;
  if (!spec.parameters.empty() && options.laws.empty()) laws.push_back({own_law_name(spec), {}, spec.parameters});
  laws.insert(laws.end(), spec.laws.begin(), spec.laws.end());
  const SpecimenSize size = size_of(spec);
  if (!options.laws.empty() && spec.is_heat())
    throw std::invalid_argument("--laws names laws of tissues that deform; compare scenes of heat by [[law]] of " +
                                spec.file.string());
  for (const std::string& name : options.laws) {
    const double modulus = spec.specimen ? initial_modulus(curves.chosen(curves.indices(false)),
                                                           size.area.value_or(1.0), size.height.value_or(1.0))
                                         : own_modulus(spec);
    LawSpec& law = laws.emplace_back(law_candidate(name, modulus, spec.specimen.has_value()));
    for (const ParameterSpec& p : spec.parameters) {  // those of the measurement belong to every law
      if (is_curve_key(p.key) || is_plate_key(p.key)) law.parameters.push_back(p);
    }
  }
  std::set<std::string> names;
  for (const LawSpec& law : laws) {
    if (!names.insert(law.name).second)
      throw std::invalid_argument("the law \"" + law.name + "\" is there twice; name each once");
  }
  return laws;
}

/// With a capital letter, unless it begins with the name of a parameter, and a full stop.
std::string as_sentence(std::string text) {
  for (const char* word : {"the ", "least ", "each "}) {
    if (text.rfind(word, 0) == 0) text.front() = static_cast<char>(text.front() - 'a' + 'A');
  }
  if (!text.empty() && text.back() != '.') text += '.';
  return text;
}

class Run {
 public:
  Run(const FitSpec& spec, const FitRun& options) : spec_(spec), options_(options), memory_(options.memory) {}
  FitResult to_end();

 private:
  std::vector<LawSpec> discover(FitResult& result);
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }
  bool search_all(const std::vector<LawSpec>& laws);
  bool search_one(const LawSpec& law);
  std::size_t choose(FitResult& result) const;
  void fill_file(const LawSearch& search, double radius, FitResult& result) const;
  void count_runs(FitResult& result) const;

  const FitSpec& spec_;
  const FitRun& options_;
  FitMemory memory_;
  FitCurves curves_;
  Searches searches_;
  std::uint64_t discovery_runs_ = 0;
  std::vector<std::string> left_out_;  ///< a sentence for each law that does not run
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// Fits every law of the library from a few starts; the best of each size, of the invariants and of the stretches, go on.
std::vector<LawSpec> Run::discover(FitResult& result) {
  constexpr int kStarts = 4;  // of a sum of invariants; one of stretches has an optimum for each order of its terms
  const SpecimenSize size = size_of(spec_);
  if (!size.area || plates_of(*spec_.specimen))
    throw std::invalid_argument(
        "--discover needs a [specimen] that deforms alike all over, no layer, with smooth faces: hundreds of laws "
        "are fitted");
  const std::vector<TermLaw> all =
      term_laws(initial_modulus(curves_.chosen(curves_.indices(false)), *size.area, *size.height), options_.discover);
  FitSpec quick = spec_;
  FitRun silent = options_;
  silent.progress = {}, silent.forecast = {}, silent.remember = {}, silent.memory = {};
  for (std::size_t i = 0; i < all.size() && !stopped(); ++i) {
    if (options_.progress) options_.progress({all[i].law.name, "discovery", i, all.size()});
    DiscoveredLaw found{all[i].law.name,
                        all[i].terms,
                        static_cast<int>(all[i].law.parameters.size()),
                        std::numeric_limits<double>::infinity(),
                        -std::numeric_limits<double>::infinity(),
                        false};
    quick.search.starts = all[i].stretches ? kStarts * all[i].terms * all[i].terms : kStarts;
    try {
      LawSearch search(quick, all[i].law, curves_, silent);
      LawMemory memory;
      search.search(memory, {});
      found.cost = search.optimum().cost;
      found.r2 = 1.0;
      for (const TestResult& t : test_results(curves_.curves, search.predictions()))
        found.r2 = std::min(found.r2, t.r2);
      discovery_runs_ += search.forward_runs();
    } catch (const std::runtime_error&) {  // a law that does not run anywhere is none that the data carry
    }
    result.discovered.push_back(std::move(found));
  }
  std::vector<LawSpec> best;
  for (int terms = 1; terms <= options_.discover; ++terms) {
    for (const bool stretches : {false, true}) {
      std::size_t least = result.discovered.size();
      for (std::size_t i = 0; i < result.discovered.size(); ++i) {
        const bool of_kind = all[i].terms == terms && all[i].stretches == stretches;
        if (!of_kind || !std::isfinite(result.discovered[i].cost)) continue;
        if (least == result.discovered.size() || result.discovered[i].cost < result.discovered[least].cost) least = i;
      }
      if (least == result.discovered.size()) continue;
      result.discovered[least].taken = true;
      best.push_back(all[least].law);
    }
  }
  std::stable_sort(result.discovered.begin(), result.discovered.end(),
                   [](const DiscoveredLaw& a, const DiscoveredLaw& b) {
                     return a.terms != b.terms ? a.terms < b.terms : a.cost < b.cost;
                   });
  return best;
}

/// False where it was stopped before all laws had been looked at.
bool Run::search_all(const std::vector<LawSpec>& laws) {
  for (const LawSpec& law : laws) {
    try {
      if (!search_one(law)) return false;
    } catch (const SceneError&) {
      throw;  // a mistake of the file, which all laws may share
    } catch (const std::runtime_error& error) {
      if (stopped()) return false;  // a forward run that was halted is no fault of the law
      if (laws.size() == 1) throw;
      left_out_.push_back("The law " + law.name + " is left out: " + error.what());
    }
  }
  return true;
}

/// False where it was stopped. Throws std::runtime_error where the law does not run anywhere.
bool Run::search_one(const LawSpec& law) {
  if (options_.progress) options_.progress({law.name, "forward models", 0, 1});
  auto search = std::make_unique<LawSearch>(spec_, law, curves_, options_);
  if (options_.forecast) options_.forecast(forecast_of(*search, spec_, memory_[law.name].starts.size()));
  search->search(memory_[law.name], [&](const MultiStart& so_far) {
    if (options_.remember) options_.remember(memory_);
    if (!options_.progress) return;
    FitProgress p{law.name, "starts", so_far.starts.size(), static_cast<std::size_t>(spec_.search.starts)};
    p.unit = common_unit(curves_.curves);
    if (!so_far.basins.empty()) {
      p.best_rms = rms_at(search->problem(), so_far.basins.front().scaled);
      p.found = so_far.basins.front().found;
    }
    p.forward_runs = search->forward_runs();
    options_.progress(p);
  });
  const bool complete = search->found().complete;
  if (complete) search->optimum();  // says why there is none
  searches_.push_back(std::move(search));
  return complete;
}

/// Ranks the laws; the number of the one that the data support.
std::size_t Run::choose(FitResult& result) const {
  std::vector<LawFit> fits;
  std::vector<std::size_t> of;
  for (std::size_t s = 0; s < searches_.size(); ++s) {
    const LawSearch& search = *searches_[s];
    if (search.found().basins.empty()) continue;
    const Problem& problem = search.problem();
    const Covariance known = covariance(problem, search.optimum().scaled);
    const double effective = known.failure.empty() ? known.noise.effective : static_cast<double>(problem.size());
    LawFit fit{
        search.law().name, problem.parameters().size(), 2.0 * search.optimum().cost, problem.size(), effective, {}};
    const std::vector<Prediction> predictions = search.predictions();
    const Validation errors = errors_in_common_unit(curves_.curves, predictions);
    for (const CurveError& e : errors.curves) {
      if (e.held_out) fit.heldout_rms.push_back(e.failure.empty() ? e.rms : std::numeric_limits<double>::infinity());
    }
    const std::vector<double> left_out = left_out_errors(problem, search.optimum(), search.descent());
    fit.heldout_rms.insert(fit.heldout_rms.end(), left_out.begin(), left_out.end());
    LawResult row{fit.name, static_cast<int>(fit.parameters), errors.rms_fit, {}, 0.0, 0.0, false, ""};
    if (!std::isnan(errors.rms_heldout)) row.rms_heldout = errors.rms_heldout;
    result.laws.push_back(std::move(row));
    fits.push_back(std::move(fit));
    of.push_back(s);
  }
  if (fits.empty()) return 0;
  const LawRanking ranking = rank_laws(fits, common_unit(curves_.curves));
  std::vector<LawResult> ordered;
  for (const LawRank& rank : ranking.order) {
    LawResult row = result.laws[rank.law];
    row.aic = rank.criteria.aic;
    row.bic = rank.criteria.bic;
    row.best = rank.law == ranking.chosen;
    if (rank.heldout > 0.0) row.rms_heldout = rank.heldout;
    row.words = row.best ? "what the data support" : rank.words;
    ordered.push_back(std::move(row));
  }
  result.laws = std::move(ordered);
  result.conclusions.push_back(ranking.sentence);
  return of[ranking.chosen];
}

void Run::count_runs(FitResult& result) const {
  double seconds = 0.0;
  result.forward_runs = discovery_runs_;
  for (const auto& search : searches_) {
    result.forward_runs += search->forward_runs();
    seconds += search->forward_seconds();
  }
  if (result.forward_runs > 0) result.forward_run_s = seconds / static_cast<double>(result.forward_runs);
  result.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count();
}

/// The text of the file that scenes or fits go on with; of a tissue where its law is stable, too.
void Run::fill_file(const LawSearch& search, double radius, FitResult& result) const {
  if (spec_.is_heat()) {
    result.tissue = keys_of_fit(search, result, spec_);
    result.result_file = "keys.toml";
    return;
  }
  result.tissue = tissue_of_fit(search, result, spec_);
  const DataRange range = data_range(result.curves, result.height, radius);
  result.stability = law_stability(fitted_tissue(search), range);
  result.conclusions.push_back(stability_sentence(result.stability, range));
  std::erase(result.conclusions, std::string());
}

FitResult Run::to_end() {
  require_something_free(spec_, options_);
  const SpecimenSize size = size_of(spec_);
  curves_ = read_curves(spec_, size, options_.data_folder.empty() ? spec_.file.parent_path() : options_.data_folder);
  FitResult result;
  const std::vector<LawSpec> laws = options_.discover > 0 ? discover(result) : laws_of(spec_, options_, curves_);
  result.area = size.area;
  if (size.area) result.height = size.height;  // of a layer displacements are depths
  const bool all = search_all(laws);
  if (all && searches_.empty()) throw std::runtime_error(left_out_.front() + "; nor does any other run");
  std::size_t chosen = 0;
  std::vector<std::string> about_laws;
  if (laws.size() > 1) {
    chosen = choose(result);
    about_laws.swap(result.conclusions);
  }
  result.complete = all;
  if (searches_.empty()) {  // stopped before the first law had a forward model
    result.starts_planned = spec_.search.starts;
    return result;
  }
  LawSearch& search = *searches_[chosen];
  if (!search.found().basins.empty() || all) {
    fill_proof(search, spec_, curves_, options_, result);
    fill_file(search, size.radius.value_or(0.0), result);
  } else {
    result.starts_planned = spec_.search.starts;
  }
  result.complete = all && !stopped();
  about_laws.insert(about_laws.end(), left_out_.begin(), left_out_.end());
  result.conclusions.insert(result.conclusions.begin(), about_laws.begin(), about_laws.end());
  for (std::string& sentence : result.conclusions) sentence = as_sentence(std::move(sentence));
  count_runs(result);
  return result;
}

}  // namespace

bool FitResult::identifies_nothing() const {
  return complete && !parameters.empty() && std::ranges::all_of(parameters, [](const ParameterResult& p) {
           return p.verdict == name_of(Verdict::at_bound) || p.verdict == name_of(Verdict::not_identifiable);
         });
}

FitResult run_fit(const FitSpec& spec, const FitRun& options) {
  return spec.insertion ? run_insertion_fit(spec, options) : Run(spec, options).to_end();
}

FitResult run_fit(const std::filesystem::path& file, const FitOptions& options) {
  return run_fit(load_fit(file), {options, {}, {}});
}

FitResult run_fit_text(std::string_view text, const std::string& name, const FitOptions& options) {
  return run_fit(parse_fit(text, name), {options, {}, {}});
}

}  // namespace glisson::fit
