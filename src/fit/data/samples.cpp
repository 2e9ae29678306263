#include "fit/data/samples.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace glisson::fit {
namespace {

/// The rows from `first` on that come before the largest force, or before it drops.
std::size_t end_of(const Samples& rows, const CropSpec& crop, double noise) {
  if (rows.size() == 0 || crop.until == CropUntil::end) return rows.size();
  if (crop.until == CropUntil::peak)
    return static_cast<std::size_t>(std::max_element(rows.force.begin(), rows.force.end()) - rows.force.begin()) + 1;
  std::size_t top = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows.force[i] > rows.force[top]) top = i;
    const double fall = rows.force[top] - rows.force[i];
    if (fall > crop.drop * std::abs(rows.force[top]) && fall > 5.0 * noise) return top + 1;
  }
  return rows.size();
}

bool within(double value, const std::optional<double>& least, const std::optional<double>& most) {
  return (!least || value >= *least) && (!most || value <= *most);
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

void add_mean(Samples& to, const Samples& bin) {
  to.time.push_back(mean(bin.time));
  to.displacement.push_back(mean(bin.displacement));
  to.force.push_back(mean(bin.force));
}

void add_nearest(Samples& to, const Samples& bin, const std::vector<double>& key, double middle) {
  const auto nearer = [&](double a, double b) { return std::abs(a - middle) < std::abs(b - middle); };
  to.push(bin, static_cast<std::size_t>(std::min_element(key.begin(), key.end(), nearer) - key.begin()));
}

/// Bins over the way of an unloading come in the order of the way.
void sort_by_time(Samples& rows) {
  std::vector<std::size_t> order(rows.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rows.time[a] < rows.time[b]; });
  Samples sorted;
  for (const std::size_t row : order) sorted.push(rows, row);
  rows = std::move(sorted);
}

}  // namespace

Samples Samples::part(std::size_t first, std::size_t last) const {
  const auto cut = [&](const std::vector<double>& v) {
    return std::vector<double>(v.begin() + static_cast<std::ptrdiff_t>(first),
                               v.begin() + static_cast<std::ptrdiff_t>(last));
  };
  return {cut(time), cut(displacement), cut(force)};
}

void Samples::push(const Samples& from, std::size_t row) {
  time.push_back(from.time[row]);
  displacement.push_back(from.displacement[row]);
  force.push_back(from.force[row]);
}

std::vector<std::size_t> turning_points(const std::vector<double>& x, double least) {
  if (x.empty()) return {};
  const auto [low, high] = std::minmax_element(x.begin(), x.end());
  const double back = least * (*high - *low);
  std::vector<std::size_t> turns{0};
  std::size_t extreme = 0;
  double direction = 1.0;  // a test begins with loading
  for (std::size_t i = 1; i < x.size(); ++i) {
    const double ahead = direction * (x[i] - x[extreme]);
    if (ahead >= 0.0) {
      extreme = i;
    } else if (ahead < -back) {
      if (extreme != turns.back()) turns.push_back(extreme);
      direction = -direction;
      extreme = i;
    }
  }
  if (turns.back() != x.size() - 1) turns.push_back(x.size() - 1);
  return turns;
}

Samples cropped(const Samples& rows, const CropSpec& crop, double height, double noise) {
  const std::size_t end = end_of(rows, crop, noise);
  Samples kept;
  for (std::size_t i = 0; i < end; ++i) {
    const double x = rows.displacement[i];
    if (within(rows.time[i], crop.min_time, crop.max_time) && within(x, crop.min_displacement, crop.max_displacement) &&
        within(x / height, crop.min_strain, crop.max_strain) && within(rows.force[i], crop.min_force, crop.max_force))
      kept.push(rows, i);
  }
  return kept;
}

Resampled resampled(const Samples& rows, const ResampleSpec& spec) {
  const auto points = static_cast<std::size_t>(spec.points);
  if (spec.over == ResampleOver::none || rows.size() <= points) return {rows, 1.0};
  const auto& key = spec.over == ResampleOver::time ? rows.time : rows.displacement;
  const auto [low, high] = std::minmax_element(key.begin(), key.end());
  const double start = *low, width = (*high - *low) / static_cast<double>(points);
  if (!(width > 0.0)) return {rows, 1.0};
  std::vector<Samples> bins(points);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto bin = static_cast<std::size_t>((key[i] - start) / width);
    bins[std::min(bin, points - 1)].push(rows, i);
  }
  Resampled result;
  for (std::size_t b = 0; b < points; ++b) {
    if (bins[b].size() == 0) continue;
    if (spec.how == ResampleHow::average)
      add_mean(result.rows, bins[b]);
    else
      add_nearest(result.rows, bins[b], spec.over == ResampleOver::time ? bins[b].time : bins[b].displacement,
                  start + (static_cast<double>(b) + 0.5) * width);
  }
  sort_by_time(result.rows);
  if (spec.how == ResampleHow::average)
    result.rows_a_point = static_cast<double>(rows.size()) / static_cast<double>(result.rows.size());
  return result;
}

}  // namespace glisson::fit
