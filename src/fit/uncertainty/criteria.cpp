#include "fit/uncertainty/criteria.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "fit/data/units.h"

namespace glisson::fit {
namespace {

constexpr double kNoWorse = 1.05, kWorse = 1.2;  ///< times the best law's error: as good to, worse from

void check(std::span<const LawFit> laws) {
  if (laws.empty()) throw std::invalid_argument("there is no law to rank");
  for (const LawFit& law : laws) {
    if (law.samples == laws[0].samples && law.heldout_rms.size() == laws[0].heldout_rms.size()) continue;
    throw std::invalid_argument("law " + law.name + " was fitted to " + std::to_string(law.samples) +
                                " samples and tested on " + std::to_string(law.heldout_rms.size()) + " curves, law " +
                                laws[0].name + " to " + std::to_string(laws[0].samples) + " and " +
                                std::to_string(laws[0].heldout_rms.size()) + "; only fits to the same curves compare");
  }
}

double effective_of_best(std::span<const LawFit> laws) {
  return std::min_element(laws.begin(), laws.end(),
                          [](const LawFit& a, const LawFit& b) { return a.sum_squares < b.sum_squares; })
      ->effective;
}

double root_mean_square(const std::vector<double>& rms) {
  double squares = 0.0;
  for (const double r : rms) squares += r * r;
  return rms.empty() ? 0.0 : std::sqrt(squares / static_cast<double>(rms.size()));
}

/// How far behind the best a law is: the mean difference over the curves, and its standard error.
void measure_behind(LawRank& rank, const std::vector<double>& rms, const std::vector<double>& best) {
  const auto n = static_cast<double>(rms.size());
  double sum = 0.0, squares = 0.0;
  for (std::size_t c = 0; c < rms.size(); ++c) {
    const double more = rms[c] - best[c];
    sum += more, squares += more * more;
  }
  rank.behind = sum / n;
  rank.behind_error = std::sqrt(std::max(0.0, squares - sum * sum / n) / (n - 1.0) / n);
}

/// What the laws are compared by: AICc where a law has one, else AIC.
double criterion(const LawRank& r, bool corrected) { return corrected ? r.criteria.aicc : r.criteria.aic; }

void weigh(std::vector<LawRank>& ranks, bool corrected) {
  double least = std::numeric_limits<double>::infinity(), least_bic = least, sum = 0.0;
  for (const LawRank& r : ranks) {
    least = std::min(least, criterion(r, corrected));
    least_bic = std::min(least_bic, r.criteria.bic);
  }
  for (LawRank& r : ranks) {
    r.delta_aicc = criterion(r, corrected) - least;
    r.delta_bic = r.criteria.bic - least_bic;
    r.akaike_weight = std::exp(-0.5 * r.delta_aicc);
    sum += r.akaike_weight;
  }
  for (LawRank& r : ranks) r.akaike_weight /= sum;
}

bool is_as_good(const LawRank& r, const LawRank& best) {
  return r.heldout <= kNoWorse * best.heldout || (r.heldout < kWorse * best.heldout && r.behind <= r.behind_error);
}

/// `0.12 ± 0.05 N`.
std::string difference_text(const LawRank& r, const std::string& unit) {
  const auto number = [&](double x, int digits) {
    std::string text = measured_text(x, unit, digits);
    return std::pair(text.substr(0, text.find(' ')),
                     text.find(' ') == std::string::npos ? "" : text.substr(text.find(' ')));
  };
  if (number(r.behind, 2).second != number(r.behind_error, 1).second)
    return measured_text(r.behind, unit, 2) + " ± " + measured_text(r.behind_error, unit, 1);
  return number(r.behind, 2).first + " ± " + measured_text(r.behind_error, unit, 1);
}

std::string words_of(const LawRank& r, bool heldout, const std::string& unit) {
  if (!heldout) return r.as_good ? "as good" : "";
  return "errs by " + difference_text(r, unit) + " more than the best" + (r.as_good ? ": as good" : "");
}

std::size_t place_of(const LawRanking& ranking, std::size_t law) {
  std::size_t place = 0;
  while (ranking.order[place].law != law) ++place;
  return place + 1;
}

std::string write(const LawRanking& ranking, std::span<const LawFit> laws, bool heldout, const std::string& unit) {
  const LawFit &chosen = laws[ranking.chosen], &best = laws[ranking.best];
  const LawRank& c = ranking.order[place_of(ranking, ranking.chosen) - 1];
  const LawRank& b = ranking.order.front();
  char text[512];
  std::string s = "the data support " + std::to_string(chosen.parameters) +
                  (chosen.parameters == 1 ? " parameter: " : " parameters: ") + chosen.name;
  if (heldout)
    std::snprintf(text, sizeof text, " errs by %s on curves that its fit has not seen",
                  measured_text(c.heldout, unit).c_str());
  else
    std::snprintf(text, sizeof text, " has an %s %.1f above the least (fewer than two curves are held out%s)",
                  ranking.corrected ? "AICc" : "AIC", c.delta_aicc,
                  ranking.corrected ? "" : ", and the samples that count are too few for AICc");
  s += text;
  if (ranking.chosen == ranking.best) return s + ", the least of all; no simpler law is as good";
  if (heldout)
    std::snprintf(
        text, sizeof text,
        ", rank %zu of %zu; the best, %s with %zu, errs by %s, and %zu curves do not distinguish the two (%s)",
        place_of(ranking, ranking.chosen), laws.size(), best.name.c_str(), best.parameters,
        measured_text(b.heldout, unit).c_str(), chosen.heldout_rms.size(), difference_text(c, unit).c_str());
  else
    std::snprintf(text, sizeof text, ", too little to prefer %s with %zu", best.name.c_str(), best.parameters);
  return s + text;
}

}  // namespace

Criteria criteria(double sum_squares, std::size_t samples, double effective, std::size_t parameters) {
  const double k = static_cast<double>(parameters) + 1.0, n = effective;
  const double variance = std::max(sum_squares / static_cast<double>(samples), std::numeric_limits<double>::min());
  Criteria c;
  c.log_likelihood = -0.5 * n * (std::log(2.0 * std::numbers::pi * variance) + 1.0);
  c.aic = -2.0 * c.log_likelihood + 2.0 * k;
  c.aicc = n > k + 1.0 ? c.aic + 2.0 * k * (k + 1.0) / (n - k - 1.0) : std::numeric_limits<double>::infinity();
  c.bic = -2.0 * c.log_likelihood + k * std::log(n);
  return c;
}

LawRanking rank_laws(std::span<const LawFit> laws, const std::string& unit) {
  check(laws);
  LawRanking out;
  const bool heldout = laws[0].heldout_rms.size() > 1;
  const double effective = effective_of_best(laws);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    LawRank r;
    r.law = i;
    r.criteria = criteria(laws[i].sum_squares, laws[i].samples, effective, laws[i].parameters);
    r.heldout = root_mean_square(laws[i].heldout_rms);
    out.order.push_back(r);
  }
  out.corrected =
      std::any_of(out.order.begin(), out.order.end(), [](const LawRank& r) { return std::isfinite(r.criteria.aicc); });
  weigh(out.order, out.corrected);
  const auto figure = [&](const LawRank& r) { return heldout ? r.heldout : r.delta_aicc; };
  std::stable_sort(out.order.begin(), out.order.end(),
                   [&](const LawRank& a, const LawRank& b) { return figure(a) < figure(b); });
  out.best = out.chosen = out.order.front().law;
  for (LawRank& r : out.order) {
    if (heldout) measure_behind(r, laws[r.law].heldout_rms, laws[out.best].heldout_rms);
    r.as_good = heldout ? is_as_good(r, out.order.front()) : r.delta_aicc <= out.order.front().delta_aicc + 2.0;
    r.words = words_of(r, heldout, unit);
    if (r.as_good && laws[r.law].parameters < laws[out.chosen].parameters) out.chosen = r.law;
  }
  out.sentence = write(out, laws, heldout, unit);
  return out;
}

}  // namespace glisson::fit
