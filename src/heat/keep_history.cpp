#include "heat/keep_history.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace glisson {
namespace {

constexpr double kGas = 8.31446261815324, kZeroCelsius = 273.15;  // [J/(mol K)], [K]
constexpr double kLargestExponent = 600.0;                        // so that what is absurd stays finite

/// Mean of exp(k (T − 43)) where T goes linearly between two temperatures.
double mean_power(double k, double a, double b) {
  const auto at = [k](double t) { return std::exp(std::min(kLargestExponent, k * (t - 43.0))); };
  if (std::abs(k * (b - a)) < 1e-6) return at(0.5 * (a + b));
  return (at(b) - at(a)) / (k * (b - a));
}

/// The part of a linear course between two levels: its share of the time, and the temperatures at its ends.
struct CoursePart {
  double share = 0.0, from = 0.0, to = 0.0;
};
CoursePart part_between(double from, double to, double low, double high) {
  const double least = std::min(from, to), most = std::max(from, to), a = std::max(least, low),
               b = std::min(most, high);
  if (a > b) return {};
  if (most == least) return {1.0, a, a};
  return {(b - a) / (most - least), a, b};
}

/// Share of the time for which a linear course is below a level.
double share_of_time_below(double from, double to, double level) {
  const double low = std::min(from, to), high = std::max(from, to);
  if (low >= level) return 0.0;
  return high <= level ? 1.0 : (level - low) / (high - low);
}

/// ∫ A exp(−E/(R T)) dt.
double damage_of(const TissueDeath& death, double from, double to, double h) {
  if (death.ln_frequency_factor == 0.0) return 0.0;
  constexpr double kSteady = 0.01;  // [K]: the middle alone errs by some 1e-6
  const double half = 0.5 * std::sqrt(0.6);
  const auto at = [&](double share) {
    const double kelvin = std::max(1.0, std::lerp(from, to, share) + kZeroCelsius);
    return std::exp(std::min(kLargestExponent, death.ln_frequency_factor - death.activation_energy / (kGas * kelvin)));
  };
  if (std::abs(to - from) < kSteady) return h * at(0.5);
  return h * (5.0 * at(0.5 - half) + 8.0 * at(0.5) + 5.0 * at(0.5 + half)) / 18.0;
}

}  // namespace

double cem43(double from, double to, double time) {
  const CoursePart warm = part_between(from, to, 39.0, 43.0),
                   hot = part_between(from, to, 43.0, std::max({from, to, 43.0}));
  const double at_43 = from == to && from == 43.0 ? 0.0 : 1.0;  // counts once
  return time / 60.0 *
         (at_43 * warm.share * mean_power(std::log(4.0), warm.from, warm.to) +
          hot.share * mean_power(std::log(2.0), hot.from, hot.to));
}

namespace heat {

HistoryKeeper::HistoryKeeper(const HeatBody& body, std::vector<double> isotherms)
    : body_(&body), isotherms_(std::move(isotherms)) {
  for (std::size_t i = 0; i < body.size(); ++i) {
    const std::span<const Part> parts = body.parts(i);
    const auto largest =
        std::max_element(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.volume < b.volume; });
    const auto& death = body.curve(largest->tissue).death;
    death_.push_back(death && largest->volume > 0.0 ? &*death : nullptr);
  }
}

HeatHistory HistoryKeeper::begin(std::span<const double> temperature) const {
  const std::size_t n = temperature.size();
  HeatHistory history;
  history.coldest.assign(temperature.begin(), temperature.end());
  history.hottest = history.coldest;
  for (auto* of : {&history.cem43, &history.damage, &history.cold_time}) of->assign(n, 0.0);
  history.below.assign(isotherms_.size(), std::vector<double>(n, 0.0));
  history.freezings.assign(n, 0);
  history.dead.assign(n, 0);
  for (std::size_t i = 0; i < n; ++i)
    history.frozen.push_back(liquid_share(i, temperature[i]) < 0.5 ? 1 : 0), history.freezings[i] = history.frozen[i];
  return history;
}

double HistoryKeeper::liquid_share(std::size_t vertex, double temperature) const {
  double liquid = 0.0, volume = 0.0;
  for (const Part& p : body_->parts(vertex))
    liquid += p.volume * body_->curve(p.tissue).at(temperature).liquid, volume += p.volume;
  return volume > 0.0 ? liquid / volume : 1.0;
}

void HistoryKeeper::add_at(std::size_t i, double h, double before, double after, HeatHistory& history) const {
  history.coldest[i] = std::min(history.coldest[i], after);
  history.hottest[i] = std::max(history.hottest[i], after);
  if (std::max(before, after) > 39.0) history.cem43[i] += cem43(before, after, h);
  for (std::size_t k = 0; k < isotherms_.size(); ++k)
    history.below[k][i] += h * share_of_time_below(before, after, isotherms_[k]);
  const double liquid = liquid_share(i, after);
  if (history.frozen[i] == 0 && liquid < 0.5)
    history.frozen[i] = 1, ++history.freezings[i];
  else if (liquid >= 1.0)
    history.frozen[i] = 0;
  if (death_[i] == nullptr) return;
  const TissueDeath& death = *death_[i];
  history.cold_time[i] += h * share_of_time_below(before, after, death.cold);
  history.damage[i] += damage_of(death, before, after, h);
  const bool of_cold = history.cold_time[i] > 0.0 && history.cold_time[i] >= death.cold_time;
  if (of_cold || history.damage[i] >= 1.0) history.dead[i] = 1;
}

void HistoryKeeper::add(double h, std::span<const double> before, std::span<const double> after, Blocks& blocks,
                        HeatHistory& history) const {
  blocks.run([&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) add_at(i, h, before[i], after[i], history);
  });
}

}  // namespace heat
}  // namespace glisson
