#include "fit/uncertainty/bootstrap.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <random>

#include "fit/search/least_squares.h"
#include "fit/uncertainty/distribution.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kFewestRepetitions = 3;
constexpr double kBlockTimes = 3.0;

/// Whole numbers below a limit, the same with every library; the standard's own distributions are not.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t replicate) : random_(mix(mix(seed) ^ replicate)) {}
  std::size_t below(std::size_t limit) {
    const std::uint64_t n = limit,
                        beyond = (0 - n) % n;  // 2⁶⁴ mod n: the numbers that would make the first ones likelier
    for (;;) {
      const std::uint64_t x = random_();
      if (x >= beyond) return x % n;
    }
  }

  /// Of a standard normal distribution [BoxMuller1958].
  double normal() {
    const double u = (static_cast<double>(below(1ull << 53)) + 0.5) * 0x1p-53;
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(below(1ull << 53)) * 0x1p-53;
    return std::sqrt(-2.0 * std::log(u)) * std::cos(angle);
  }

 private:
  /// Spreads neighbouring numbers over all bits: an odd factor and shifts, each of which can be undone.
  static std::uint64_t mix(std::uint64_t x) {
    x = (x + 0x9E3779B97F4A7C15ull) * 0xD1342543DE82EF95ull;
    x ^= x >> 32;
    x *= 0xD1342543DE82EF95ull;
    return x ^ (x >> 29);
  }
  std::mt19937_64 random_;
};

struct Group {
  std::string name;
  std::vector<std::size_t> curves;
};

/// What every replicate is drawn from.
class Source {
 public:
  Source(const Problem& problem, std::span<const double> optimum, const Covariance& covariance)
      : problem_(problem), residuals_(problem.residuals(optimum, false).values) {
    for (std::size_t c = 0; c < problem.curves().size(); ++c) {
      const Curve& curve = problem.curves()[c];
      if (!(curve.weight > 0.0) || curve.size() == 0) continue;
      auto g =
          std::find_if(groups_.begin(), groups_.end(), [&](const Group& known) { return known.name == curve.group; });
      if (g == groups_.end()) g = groups_.insert(g, {curve.group, {}});
      g->curves.push_back(c);
    }
    times_.assign(problem.curves().size(), 1.0);
    for (std::size_t c = 0; c < times_.size(); ++c) {
      const double effective = covariance.noise.effective_by_curve[c];
      if (effective > 0.0) times_[c] = static_cast<double>(problem.curves()[c].size()) / effective;
    }
    given_ = covariance.noise.kind == NoiseKind::given;
    variance_ = covariance.noise.variance;
    if (given_) {
      freedom_ = covariance.freedom;
      return;
    }
    const double effective = covariance.noise.effective;
    const double left = std::max(effective - static_cast<double>(covariance.parameters()), 1.0);
    growth_ = std::sqrt(std::max(effective / left, 1.0));
    for (const Group& g : groups_) {
      if (g.curves.size() >= kFewestRepetitions) freedom_ += static_cast<double>(g.curves.size() - 1);
      for (const std::size_t c : g.curves)
        if (g.curves.size() < kFewestRepetitions) freedom_ += covariance.noise.effective_by_curve[c];
    }
  }

  bool usable() const { return !residuals_.empty(); }
  double freedom() const { return std::max(freedom_, 1.0); }

  /// A problem of its own, with curves drawn anew.
  std::unique_ptr<Problem> replicate(Draw& draw) const {
    std::vector<Curve> curves;
    std::vector<std::size_t> origin;
    for (const Group& g : groups_) {
      if (given_)
        draw_noise(g, draw, curves, origin);
      else if (g.curves.size() >= kFewestRepetitions)
        draw_curves(g, draw, curves, origin);
      else
        draw_blocks(g, draw, curves, origin);
    }
    return problem_.with(std::move(curves), origin);
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> out;
    if (given_) return {"replicates are the fitted curves with noise of the deviations that are given"};
    for (const Group& g : groups_) {
      const std::string n = std::to_string(g.curves.size());
      out.push_back(g.curves.size() >= kFewestRepetitions
                        ? g.name + ": " + n + " repetitions resampled with replacement"
                        : g.name + ": only " + n + (g.curves.size() == 1 ? " curve" : " curves") +
                              ", residuals resampled in blocks; differences between repetitions are not included");
    }
    return out;
  }

 private:
  void draw_curves(const Group& g, Draw& draw, std::vector<Curve>& curves, std::vector<std::size_t>& origin) const {
    const std::size_t n = g.curves.size();
    std::vector<int> times(n, 0);
    for (std::size_t k = 0; k + 1 < n; ++k) ++times[draw.below(n)];
    const double share = static_cast<double>(n) / static_cast<double>(n - 1);
    // squares can be weighed, which saves the forward runs of twins; a robust loss has to see each
    const bool weigh = problem_.loss().kind == LossKind::squares;
    for (std::size_t k = 0; k < n; ++k) {
      for (int copy = 0; copy < (weigh ? std::min(times[k], 1) : times[k]); ++copy) {
        curves.push_back(problem_.curves()[g.curves[k]]);
        curves.back().weight *= std::sqrt(share * (weigh ? times[k] : 1));
        origin.push_back(g.curves[k]);
      }
    }
  }

  void draw_noise(const Group& g, Draw& draw, std::vector<Curve>& curves, std::vector<std::size_t>& origin) const {
    for (const std::size_t c : g.curves) {
      Curve curve = problem_.curves()[c];
      const double unit = problem_.spread()[c] / curve.weight, deviation = std::sqrt(variance_);
      for (std::size_t i = 0; i < curve.size(); ++i)
        curve.force[i] += unit * (residuals_[problem_.offset(c) + i] + deviation * draw.normal());
      curves.push_back(std::move(curve));
      origin.push_back(c);
    }
  }

  void draw_blocks(const Group& g, Draw& draw, std::vector<Curve>& curves, std::vector<std::size_t>& origin) const {
    for (const std::size_t c : g.curves) {
      Curve curve = problem_.curves()[c];
      const std::size_t n = curve.size(), first = problem_.offset(c);
      const double unit = problem_.spread()[c] / curve.weight;
      double mean = 0.0;
      for (std::size_t i = 0; i < n; ++i) mean += residuals_[first + i] / static_cast<double>(n);
      const auto most = std::max<std::size_t>(1, n / 3);
      const auto block = std::clamp(static_cast<std::size_t>(std::ceil(kBlockTimes * times_[c])), std::size_t{1}, most);
      std::size_t from = 0;
      for (std::size_t i = 0; i < n; ++i) {
        if (i % block == 0) from = draw.below(n);
        const double drawn = residuals_[first + (from + i % block) % n] - mean;
        curve.force[i] += unit * (residuals_[first + i] + growth_ * drawn);
      }
      curves.push_back(std::move(curve));
      origin.push_back(c);
    }
  }

  const Problem& problem_;
  std::vector<double> residuals_;
  std::vector<Group> groups_;
  std::vector<double> times_;
  double growth_ = 1.0, freedom_ = 0.0, variance_ = 1.0;
  bool given_ = false;  ///< the noise is what whoever measured says
};

struct Refit {
  std::optional<Optimum> optimum;  ///< empty: not begun
  std::uint64_t runs = 0;
};

/// The value below which a share of the sorted numbers lies, between neighbours by a line.
double percentile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto i = std::min(static_cast<std::size_t>(at), sorted.size() - 1);
  const std::size_t j = std::min(i + 1, sorted.size() - 1);
  return sorted[i] + (at - static_cast<double>(i)) * (sorted[j] - sorted[i]);
}

void summarise(Bootstrap& b, const Problem& problem, double level) {
  const std::size_t parameters = problem.parameters().size();
  std::vector<double> low(parameters), high(parameters);
  for (std::size_t p = 0; p < parameters; ++p) {
    std::vector<double> z;
    for (const std::vector<double>& refit : b.scaled) z.push_back(refit[p]);
    double mean = 0.0, squares = 0.0;
    for (const double x : z) mean += x / static_cast<double>(z.size());
    for (const double x : z) squares += (x - mean) * (x - mean);
    b.sd.push_back(std::sqrt(squares / static_cast<double>(z.size() - 1)));
    std::sort(z.begin(), z.end());
    const double median = percentile(z, 0.5);
    low[p] = median - b.widening * (median - percentile(z, 0.5 * (1.0 - level)));
    high[p] = median + b.widening * (percentile(z, 0.5 * (1.0 + level)) - median);
  }
  const std::vector<double> values_low = problem.to_values(low), values_high = problem.to_values(high);
  for (std::size_t p = 0; p < parameters; ++p)
    b.interval.push_back({values_low[p], values_high[p], low[p] <= 1e-6, high[p] >= 1.0 - 1e-6});
}

}  // namespace

Bootstrap bootstrap(const Problem& problem, std::span<const double> optimum, const Covariance& covariance,
                    const BootstrapOptions& options) {
  Bootstrap b;
  b.asked = std::max(options.replicates, 0);
  const Source source(problem, optimum, covariance);
  if (!source.usable()) {
    b.failed = b.asked;
    return b;
  }
  b.notes = source.notes();
  constexpr double kMany = 1e6;  // degrees of freedom of a normal distribution, near enough
  const double share = 0.5 * (1.0 + options.level);
  b.widening = student_quantile(share, source.freedom()) / student_quantile(share, kMany);
  std::vector<Refit> refits(static_cast<std::size_t>(b.asked));
  DescentOptions descent;
  descent.most_iterations = options.most_iterations;
  descent.tolerance = 1e-8;
  descent.stop = options.stop;
  const auto stopped = [&] { return options.stop != nullptr && options.stop->load(); };
  tbb::parallel_for(std::size_t{0}, refits.size(), [&](std::size_t k) {
    // a thread that waits for its forward runs takes no other refit on top of them
    tbb::this_task_arena::isolate([&] {
      if (stopped()) return;
      Draw draw(options.seed, k);
      const std::unique_ptr<Problem> drawn = source.replicate(draw);
      Optimum o = descend(*drawn, optimum, descent);
      refits[k].runs = drawn->forward_runs();
      if (!stopped()) refits[k].optimum = std::move(o);
    });
  });
  for (Refit& r : refits) {
    b.forward_runs += r.runs;
    if (!r.optimum) {
      b.stopped = true;
    } else if (!std::isfinite(r.optimum->cost)) {
      ++b.failed;
    } else {
      b.unfinished += r.optimum->converged ? 0 : 1;
      b.scaled.push_back(std::move(r.optimum->scaled));
    }
  }
  if (b.scaled.size() > 1) summarise(b, problem, options.level);
  return b;
}

}  // namespace glisson::fit
