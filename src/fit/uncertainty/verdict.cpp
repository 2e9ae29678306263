#include "fit/uncertainty/verdict.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "fit/uncertainty/combination.h"

namespace glisson::fit {
namespace {

constexpr double kMember = 0.1;      // of a direction: parameters with less are not named
constexpr double kEntangled = 0.95;  // correlation from which two parameters are named together
constexpr double kWideFactor = 4.0;  // end to end
constexpr double kFlatPart = 0.05;   // of the bounds: a shorter flat stretch is not worth a word

/// Of values away from the optimum, where no profile was walked.
constexpr const char* kNotExamined =
    "; how good other values are was not examined ([proof] profiles = false, or the fit was stopped)";

/// The ends of a parameter's interval, and why one is open.
struct Ends {
  Interval interval;
  std::string low_reason, high_reason;  ///< empty: closed by the curves
  bool flat = false;                    ///< by profile: the whole range costs next to nothing
};

std::string open_reason(const Problem& problem, bool open, double bound, const std::vector<std::size_t>& leans,
                        const std::string& failure, const char* side, const Parameter& x, bool examined = true) {
  if (!failure.empty()) return "the profile to " + std::string(side) + " values ended early (" + failure + ")";
  if (open)
    return std::string("no ") + side + " limit within its bounds (" + number(bound, x.unit) + ")" +
           (examined ? "" : " by the curvature at the optimum alone");
  if (leans.empty()) return "";
  return std::string("its ") + side + " limit is only that of " + problem.parameters()[leans.front()].name + "'s bound";
}

Ends ends_of(const Problem& problem, const Covariance& c, const Profiles* profiled, std::size_t p) {
  const Parameter& x = problem.parameters()[p];
  Ends e;
  if (profiled == nullptr) {
    e.interval = c.interval[p];
    e.low_reason = open_reason(problem, e.interval.low_open, x.low, {}, "", "lower", x, false);
    e.high_reason = open_reason(problem, e.interval.high_open, x.high, {}, "", "upper", x, false);
    return e;
  }
  const Profile& f = profiled->of[p];
  e.flat = f.flat;
  e.interval = f.interval;
  e.low_reason = open_reason(problem, f.interval.low_open, x.low, f.low_leans_on, f.low_failure, "lower", x);
  e.high_reason = open_reason(problem, f.interval.high_open, x.high, f.high_leans_on, f.high_failure, "upper", x);
  return e;
}

/// Largest over smallest magnitude; infinite where zero lies within.
double factor_of(const Interval& i) {
  if (!(i.low * i.high > 0.0)) return kInfinity;
  return std::max(i.low / i.high, i.high / i.low);
}

/// Change of the force over half the interval with the other parameters held, over the residuals' rms.
double effect_of(const Problem& problem, const Covariance& c, const Interval& i, std::size_t p) {
  std::vector<double> low = problem.to_values(c.scaled), high = low;
  low[p] = i.low, high[p] = i.high;
  const double half = 0.5 * (problem.to_scaled(high)[p] - problem.to_scaled(low)[p]);
  const double slope = std::sqrt(c.information[p * c.parameters() + p] / static_cast<double>(c.noise.samples));
  return c.noise.rms > 0.0 ? slope * half / c.noise.rms : kInfinity;
}

Verdict verdict_of(const Covariance& c, const Ends& e, double effect, std::size_t p) {
  const bool low = !e.low_reason.empty(), high = !e.high_reason.empty();
  // on a flat cost the optimum ends anywhere, at a bound too
  if (c.hold[p] != Hold::free) return e.flat ? Verdict::not_identifiable : Verdict::at_bound;
  if (c.determined[p] == 0 || (low && high)) return Verdict::not_identifiable;
  if (low || high) return Verdict::weak;
  if (factor_of(e.interval) <= kWideFactor) return Verdict::identified;
  const bool zero = e.interval.low <= 0.0 && e.interval.high >= 0.0;
  return zero && effect < 1.0 ? Verdict::negligible : Verdict::weak;
}

std::string range(const Interval& i, const std::string& unit) { return number(i.low) + " to " + number(i.high, unit); }

/// "; its profile is flat from … to …", where it is over more than a sliver.
std::string flat_words(const Problem& problem, const Profiles* profiled, std::size_t p,
                       const std::string& whose = "its profile") {
  if (profiled == nullptr) return "";
  const Profile& f = profiled->of[p];
  std::vector<double> low = f.points.front().scaled, high = low;
  low[p] = high[p] = 0.0;
  std::vector<double> values = problem.to_values(low);
  values[p] = f.flat_low;
  low = problem.to_scaled(values);
  values[p] = f.flat_high;
  high = problem.to_scaled(values);
  if (!(high[p] - low[p] > kFlatPart)) return "";
  return "; " + whose + " is flat from " + number(f.flat_low) + " to " +
         number(f.flat_high, problem.parameters()[p].unit);
}

std::string bound_words(const Parameter& x, Hold hold, const Ends& e, bool examined) {
  const bool low = hold == Hold::at_low;
  std::string s = "at its " + std::string(low ? "lower" : "upper") + " bound, " + number(low ? x.low : x.high, x.unit) +
                  ": the curves fit better with " + (low ? "less" : "more");
  if (!examined) return s + kNotExamined;
  return s + "; anything " +
         (low ? "up to " + number(e.interval.high, x.unit) : "down to " + number(e.interval.low, x.unit)) +
         " is nearly as good";
}

/// How much of its value half an interval is: "± 3 %".
std::string part_words(const Interval& i) {
  return " (± " + number(100.0 * std::abs((i.high - i.low) / (i.high + i.low)), "", 2) + " %)";
}

std::string effect_words(double effect) {
  return "Changed alone within that, it moves the force by " + number(effect, "", 2) +
         " times the rms of the residuals";
}

std::string words_of(const Problem& problem, const Covariance& c, const Profiles* profiled, const Ends& e,
                     Verdict verdict, double effect, std::size_t p) {
  const Parameter& x = problem.parameters()[p];
  std::string s = x.name + ": " + name_of(verdict) + ", ";
  if (verdict == Verdict::at_bound) return x.name + ": " + bound_words(x, c.hold[p], e, profiled != nullptr);
  if (verdict == Verdict::not_identifiable && profiled == nullptr)
    return s + "by the derivatives at the optimum, " + number(problem.to_values(c.scaled)[p], x.unit) + kNotExamined;
  if (verdict == Verdict::not_identifiable)
    return s + "anywhere from " + range(e.interval, x.unit) + " fits these curves" + flat_words(problem, profiled, p);
  s += range(e.interval, x.unit);
  if (verdict == Verdict::identified) return s + part_words(e.interval) + ". " + effect_words(effect);
  if (verdict == Verdict::negligible) return s + ": zero is within. " + effect_words(effect) + ": it can be left out";
  const std::string& reason = e.low_reason.empty() ? e.high_reason : e.low_reason;
  if (!reason.empty()) return s + ": " + reason + flat_words(problem, profiled, p);
  s += std::isfinite(factor_of(e.interval)) ? ": a factor of " + number(factor_of(e.interval), "", 2)
                                            : ": of either sign";
  return s + ". " + effect_words(effect) + (effect < 1.0 ? "" : "; the other parameters make up for that");
}

std::vector<std::size_t> members(const std::vector<double>& direction, double least) {
  std::vector<std::size_t> found;
  for (std::size_t p = 0; p < direction.size(); ++p) {
    if (std::abs(direction[p]) > least) found.push_back(p);
  }
  return found;
}

std::string list(const Problem& problem, const std::vector<std::size_t>& which) {
  std::string s;
  for (std::size_t k = 0; k < which.size(); ++k)
    s += (k == 0 ? "" : k + 1 == which.size() ? " and " : ", ") + problem.parameters()[which[k]].name;
  return s;
}

std::string correlation_words(const Covariance& c, std::size_t p, std::size_t q) {
  char text[48];
  std::snprintf(text, sizeof text, "correlation %.3f", c.correlation[p * c.parameters() + q]);
  return text;
}

std::string unseen_words(const Problem& problem, const Covariance& c, const Profiles* profiled, const Direction& d) {
  const std::vector<std::size_t> in = members(d.vector, kMember);
  if (in.size() == 1)
    return problem.parameters()[in[0]].name + ": these curves do not depend on it" +
           flat_words(problem, profiled, in[0]);
  std::string s = list(problem, in) + ": only their combination is fixed by these curves";
  if (in.size() == 2)
    s += ", " + fixed_combination(problem, c, in[0], in[1], d.vector) + "; " + correlation_words(c, in[0], in[1]);
  return s + flat_words(problem, profiled, in[0], "the profile of " + problem.parameters()[in[0]].name);
}

/// The direction along which two parameters move together, from their covariance.
std::vector<double> common_direction(const Covariance& c, std::size_t p, std::size_t q) {
  const std::size_t n = c.parameters();
  const double pp = c.matrix[p * n + p], qq = c.matrix[q * n + q], pq = c.matrix[p * n + q];
  const double angle = 0.5 * std::atan2(2.0 * pq, pp - qq);
  std::vector<double> v(n, 0.0);
  v[p] = std::cos(angle);
  v[q] = std::sin(angle);
  return v;
}

void add_entangled(Verdicts& out, const Problem& problem, const Covariance& c) {
  for (std::size_t p = 0; p < c.parameters(); ++p) {
    for (std::size_t q = p + 1; q < c.parameters(); ++q) {
      if (c.determined[p] == 0 || c.determined[q] == 0) continue;
      if (std::abs(c.correlation[p * c.parameters() + q]) < kEntangled) continue;
      out.conclusions.push_back(problem.parameters()[p].name + " and " + problem.parameters()[q].name +
                                " compensate each other (" + correlation_words(c, p, q) +
                                "): " + fixed_combination(problem, c, p, q, common_direction(c, p, q)));
    }
  }
}

/// Which way the parameters go in a direction: "E up with nu down".
std::string way(const Problem& problem, const Direction& d) {
  std::string s;
  for (const std::size_t p : members(d.vector, 0.3)) {
    s += (s.empty() ? "" : " with ") + problem.parameters()[p].name + (d.vector[p] > 0.0 ? " up" : " down");
  }
  return s;
}

void add_extremes(Verdicts& out, const Problem& problem, const Covariance& c) {
  if (c.directions.size() < 2 || !c.directions.front().determined) return;
  const auto known = [&](const Direction& d) {
    return way(problem, d) + ", to ± " + number(100.0 * c.quantile * d.sd, "", 2) + " % of the bounds";
  };
  out.conclusions.push_back("least known: " + known(c.directions.front()) +
                            "; best known: " + known(c.directions.back()));
}

}  // namespace

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::identified:
      return "identified";
    case Verdict::negligible:
      return "negligible";
    case Verdict::weak:
      return "weak";
    case Verdict::not_identifiable:
      return "not identifiable";
    case Verdict::at_bound:
      return "at bound";
  }
  return "";
}

Verdicts judge(const Problem& problem, const Covariance& covariance, const Profiles* profiled) {
  Verdicts out;
  if (!covariance.failure.empty()) {
    out.conclusions.push_back("no statement about the parameters is possible: " + covariance.failure);
    return out;
  }
  for (std::size_t p = 0; p < covariance.parameters(); ++p) {
    const Ends e = ends_of(problem, covariance, profiled, p);
    const double effect = effect_of(problem, covariance, e.interval, p);
    const Verdict verdict = verdict_of(covariance, e, effect, p);
    out.of.push_back({verdict, e.interval, words_of(problem, covariance, profiled, e, verdict, effect, p)});
  }
  for (const Direction& d : covariance.directions) {
    if (!d.determined) out.conclusions.push_back(unseen_words(problem, covariance, profiled, d));
  }
  add_entangled(out, problem, covariance);
  add_extremes(out, problem, covariance);
  if (profiled != nullptr && !profiled->better.empty())
    out.conclusions.push_back("a profile found a better optimum than the reported one: fit again from there");
  return out;
}

}  // namespace glisson::fit
