#include "fit/uncertainty/profile.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace glisson::fit {
namespace {

constexpr double kAccuracy = 1e-3;   // of an end, as a part of the way in √Δcost
constexpr double kFlat = 0.1;        // of the way to the threshold: below it a profile is called flat
constexpr double kLeastStep = 1e-9;  // in z
constexpr double kBetter = 1e-6;     // of the cost: less is the descents' own error

/// A point with its way to the threshold: √(2 Δcost / unit) / t, 1 at the interval's end.
struct Step {
  ProfilePoint point;
  double way = 0.0;
};

/// One side of one parameter's profile.
class Walk {
 public:
  Walk(const Problem& problem, const Optimum& optimum, const ProfileOptions& options, std::size_t parameter,
       double sign, double rise)
      : problem_(problem), options_(options), best_(optimum.cost), parameter_(parameter), sign_(sign), rise_(rise) {
    steps_.push_back({{optimum.scaled, problem.to_values(optimum.scaled)[parameter], optimum.cost}, 0.0});
    descent_.fixed.assign(optimum.scaled.size(), 0);
    descent_.fixed[parameter] = 1;
    descent_.most_iterations = options.most_iterations;
    descent_.tolerance = options.tolerance;
    descent_.secant = options.secant;
    descent_.stop = options.stop;
  }

  void run(double first_step) {
    double step = first_step;
    for (int k = 0; k < options_.most_points && !done_; ++k) {
      const double at = std::clamp(z() + sign_ * step, 0.0, 1.0);
      if (at == z()) break;
      if (!take(at)) break;
      step = done_ ? step : next_step();
    }
    if (crossed()) refine();
  }

  bool crossed() const { return steps_.back().way >= 1.0; }
  /// z of the end: interpolated where the threshold was crossed.
  double end() const {
    if (!crossed()) return z();
    const Step &inner = steps_[steps_.size() - 2], &outer = steps_.back();
    const double part = (1.0 - inner.way) / std::max(outer.way - inner.way, 1e-300);
    return inner.point.scaled[parameter_] +
           std::clamp(part, 0.0, 1.0) * (outer.point.scaled[parameter_] - inner.point.scaled[parameter_]);
  }
  const std::vector<Step>& steps() const { return steps_; }
  /// Points outside the interval that the refinement has passed; for the drawing.
  const std::vector<Step>& beyond() const { return beyond_; }
  const std::string& failure() const { return failure_; }

 private:
  double z() const { return steps_.back().point.scaled[parameter_]; }
  double z(std::size_t back) const { return steps_[steps_.size() - 1 - back].point.scaled[parameter_]; }
  bool stopped() const { return options_.stop != nullptr && options_.stop->load(); }

  /// The line through the last two points, at z.
  std::vector<double> guess(double at) const {
    std::vector<double> start = steps_.back().point.scaled;
    if (steps_.size() > 1) {
      const std::vector<double>& before = steps_[steps_.size() - 2].point.scaled;
      const double part = (at - z(0)) / (z(0) - z(1));
      for (std::size_t p = 0; p < start.size(); ++p)
        start[p] = std::clamp(start[p] + part * (start[p] - before[p]), 0.0, 1.0);
    }
    start[parameter_] = at;
    return start;
  }

  Step evaluate(double at, const std::vector<double>& start) const {
    Optimum o = descend(problem_, start, descent_);
    if (!std::isfinite(o.cost)) {
      std::vector<double> plain = steps_.back().point.scaled;
      plain[parameter_] = at;
      o = descend(problem_, plain, descent_);
    }
    Step s{{o.scaled, problem_.to_values(o.scaled)[parameter_], o.cost}, 0.0};
    s.way = std::isfinite(o.cost) ? std::sqrt(std::max(0.0, o.cost - best_) / rise_) : -1.0;
    if (s.way < 0.0) s.point.scaled.clear();
    message_ = o.message;
    return s;
  }

  /// Goes to z, or less far where the model fails there.
  bool take(double at) {
    for (int halving = 0; halving < 10; ++halving) {
      if (stopped()) {
        failure_ = "stopped";
        return false;
      }
      Step s = evaluate(at, guess(at));
      if (s.way >= 0.0) {
        steps_.push_back(std::move(s));
        done_ = crossed() || at == 0.0 || at == 1.0;
        return true;
      }
      at = 0.5 * (at + z());
    }
    failure_ = message_;
    return false;
  }

  /// So far that √Δcost rises by the aim, as it rose over the last step; at most threefold, at most a fifth of the range.
  double next_step() const {
    const double rose = steps_.back().way - steps_[steps_.size() - 2].way, last = std::abs(z(0) - z(1));
    const double factor = rose > 0.0 ? options_.step / rose : 3.0;
    return std::min(last * std::clamp(factor, 0.2, 3.0), 0.2);
  }

  /// Draws the last two points together about the threshold: regula falsi, halving where it sticks.
  void refine() {
    Step outer = steps_.back();
    steps_.pop_back();
    for (int k = 0; k < 20 && !stopped(); ++k) {
      const double inside = z(), outside = outer.point.scaled[parameter_];
      const double gap = outer.way - steps_.back().way;
      if (gap < kAccuracy * 30 && k > 0) break;
      if (std::abs(outside - inside) < kLeastStep) break;
      double part = gap > 0.0 ? (1.0 - steps_.back().way) / gap : 0.5;
      part = k % 3 == 2 ? 0.5 : std::clamp(part, 0.05, 0.95);
      const double at = inside + part * (outside - inside);
      std::vector<double> start = steps_.back().point.scaled;
      for (std::size_t p = 0; p < start.size(); ++p) start[p] += part * (outer.point.scaled[p] - start[p]);
      start[parameter_] = at;
      Step s = evaluate(at, start);
      if (s.way < 0.0) break;
      const bool close = std::abs(s.way - 1.0) < kAccuracy;
      if (s.way < 1.0) {
        steps_.push_back(std::move(s));
      } else {
        beyond_.push_back(std::move(outer));
        outer = std::move(s);
      }
      if (close) break;
    }
    steps_.push_back(std::move(outer));
  }

  const Problem& problem_;
  const ProfileOptions& options_;
  DescentOptions descent_;
  double best_;
  std::size_t parameter_;
  double sign_, rise_;
  std::vector<Step> steps_, beyond_;
  bool done_ = false;
  std::string failure_;
  mutable std::string message_;
};

double first_step(const Covariance& c, std::size_t p, double part) {
  const double sd = c.sd[p];
  return std::isfinite(sd) ? std::clamp(part * c.quantile * sd, 1e-7, 0.2) : 0.05;
}

/// Where the profile about the optimum stays within kFlat of the way.
void find_flat(Profile& profile, const std::vector<std::pair<double, double>>& ways) {
  profile.flat_low = profile.flat_high = 0.0;
  bool any = false;
  double widest = 0.0;
  for (const auto& [value, way] : ways) {
    widest = std::max(widest, way);
    if (way > kFlat) continue;
    profile.flat_low = any ? std::min(profile.flat_low, value) : value;
    profile.flat_high = any ? std::max(profile.flat_high, value) : value;
    any = true;
  }
  profile.flat = widest <= kFlat;
}

/// Parameters at a bound at the last point of a walk that were free at the optimum.
std::vector<std::size_t> leans_on(const Walk& walk, std::size_t profiled) {
  constexpr double kLeans = 1e-6;  // so near to a bound a parameter leans on it
  const auto at_bound = [](double z) { return z <= kLeans || z >= 1.0 - kLeans; };
  const std::vector<double>&last = walk.steps().back().point.scaled, &first = walk.steps().front().point.scaled;
  std::vector<std::size_t> found;
  for (std::size_t q = 0; q < last.size(); ++q) {
    if (q != profiled && at_bound(last[q]) && !at_bound(first[q])) found.push_back(q);
  }
  return found;
}

Profile assemble(const Problem& problem, std::size_t p, const Walk& low, const Walk& high, double threshold) {
  Profile out;
  out.parameter = p;
  out.threshold = threshold;
  std::vector<Step> all = low.steps();
  all.insert(all.end(), low.beyond().begin(), low.beyond().end());
  all.insert(all.end(), high.steps().begin() + 1, high.steps().end());
  all.insert(all.end(), high.beyond().begin(), high.beyond().end());
  std::stable_sort(all.begin(), all.end(),
                   [p](const Step& a, const Step& b) { return a.point.scaled[p] < b.point.scaled[p]; });
  std::vector<std::pair<double, double>> ways;
  for (Step& s : all) {
    ways.emplace_back(s.point.value, s.way);
    out.points.push_back(std::move(s.point));
  }
  std::vector<double> at = low.steps().front().point.scaled;
  const auto value = [&](double z) {
    at[p] = z;
    return problem.to_values(at)[p];
  };
  out.interval.low_open = !low.crossed();
  out.interval.high_open = !high.crossed();
  out.interval.low = value(out.interval.low_open ? 0.0 : low.end());
  out.interval.high = value(out.interval.high_open ? 1.0 : high.end());
  out.low_leans_on = leans_on(low, p);
  out.high_leans_on = leans_on(high, p);
  out.low_failure = low.failure();
  out.high_failure = high.failure();
  find_flat(out, ways);
  return out;
}

/// Of a direction that is not determined, or a parameter that is held: the inflation of the others.
double inflation_of(const Covariance& c, std::size_t p) {
  if (c.determined[p] != 0) return c.inflation[p];
  double sum = 0.0, count = 0.0;
  for (std::size_t q = 0; q < c.parameters(); ++q) {
    if (c.determined[q] == 0) continue;
    sum += std::log(std::max(c.inflation[q], 1e-300));
    count += 1.0;
  }
  const double of_noise = c.noise.effective > 0.0 ? static_cast<double>(c.noise.samples) / c.noise.effective : 1.0;
  return count > 0.0 ? std::exp(sum / count) : of_noise;
}

}  // namespace

Profiles profiles(const Problem& problem, const Optimum& optimum, const Covariance& covariance,
                  const ProfileOptions& options) {
  const std::size_t n = optimum.scaled.size();
  std::vector<Walk> walks;
  std::vector<double> rises;
  for (std::size_t p = 0; p < n; ++p) {
    // exact data have no noise: the least cost that descents can tell apart stands in for it
    const double unit = std::max(covariance.cost_unit * inflation_of(covariance, p), 1e-12);
    rises.push_back(0.5 * unit * covariance.quantile * covariance.quantile);
    walks.emplace_back(problem, optimum, options, p, -1.0, rises.back());
    walks.emplace_back(problem, optimum, options, p, +1.0, rises.back());
  }
  tbb::parallel_for(std::size_t{0}, walks.size(),
                    [&](std::size_t k) { walks[k].run(first_step(covariance, k / 2, options.step)); });
  Profiles out;
  out.better_cost = optimum.cost;
  const double least = kBetter * optimum.cost;
  for (std::size_t p = 0; p < n; ++p) {
    out.of.push_back(assemble(problem, p, walks[2 * p], walks[2 * p + 1], optimum.cost + rises[p]));
    for (const ProfilePoint& point : out.of.back().points) {
      if (!(point.cost < std::min(out.better_cost, optimum.cost - least))) continue;
      out.better = point.scaled;
      out.better_cost = point.cost;
    }
  }
  return out;
}

}  // namespace glisson::fit
