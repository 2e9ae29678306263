#include "fit/uncertainty/criteria.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace glisson::fit {
namespace {

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

void measure_heldout(LawRank& rank, const std::vector<double>& rms) {
  if (rms.empty()) return;
  const auto n = static_cast<double>(rms.size());
  double squares = 0.0, sum = 0.0;
  for (const double r : rms) {
    squares += r * r;
    sum += r;
  }
  rank.heldout = std::sqrt(squares / n);
  const double scatter = std::max(0.0, squares - sum * sum / n);
  rank.heldout_error = n > 1.0 ? std::sqrt(scatter / (n - 1.0) / n) : 0.0;
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

std::string write(const LawRanking& ranking, std::span<const LawFit> laws, bool heldout) {
  const LawFit &chosen = laws[ranking.chosen], &best = laws[ranking.best];
  const auto rank_of = [&](std::size_t law) {
    return *std::find_if(ranking.order.begin(), ranking.order.end(), [law](const LawRank& r) { return r.law == law; });
  };
  const LawRank c = rank_of(ranking.chosen), b = rank_of(ranking.best);
  char text[512];
  std::string s = "the data support " + std::to_string(chosen.parameters) +
                  (chosen.parameters == 1 ? " parameter: " : " parameters: ") + chosen.name;
  if (heldout)
    std::snprintf(text, sizeof text, " errs by %.3g N on held-out curves", c.heldout);
  else
    std::snprintf(text, sizeof text, " has an %s %.1f above the least (fewer than two curves are held out%s)",
                  ranking.corrected ? "AICc" : "AIC", c.delta_aicc,
                  ranking.corrected ? "" : ", and the samples that count are too few for AICc");
  s += text;
  if (ranking.chosen == ranking.best) return s + ", the least of all; no simpler law is as good";
  if (heldout)
    std::snprintf(text, sizeof text, ", within one standard error (%.2g N) of the best, %s with %zu at %.3g N",
                  b.heldout_error, best.name.c_str(), best.parameters, b.heldout);
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

LawRanking rank_laws(std::span<const LawFit> laws) {
  check(laws);
  LawRanking out;
  const bool heldout = laws[0].heldout_rms.size() > 1;
  const double effective = effective_of_best(laws);
  for (std::size_t i = 0; i < laws.size(); ++i) {
    LawRank r;
    r.law = i;
    r.criteria = criteria(laws[i].sum_squares, laws[i].samples, effective, laws[i].parameters);
    measure_heldout(r, laws[i].heldout_rms);
    out.order.push_back(r);
  }
  out.corrected =
      std::any_of(out.order.begin(), out.order.end(), [](const LawRank& r) { return std::isfinite(r.criteria.aicc); });
  weigh(out.order, out.corrected);
  const auto figure = [&](const LawRank& r) { return heldout ? r.heldout : r.delta_aicc; };
  std::stable_sort(out.order.begin(), out.order.end(),
                   [&](const LawRank& a, const LawRank& b) { return figure(a) < figure(b); });
  out.best = out.chosen = out.order.front().law;
  const double limit = figure(out.order.front()) + (heldout ? out.order.front().heldout_error : 2.0);
  for (LawRank& r : out.order) {
    r.as_good = figure(r) <= limit;
    if (r.as_good && laws[r.law].parameters < laws[out.chosen].parameters) out.chosen = r.law;
  }
  out.sentence = write(out, laws, heldout);
  return out;
}

}  // namespace glisson::fit
