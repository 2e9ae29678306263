#include "fit/data/contact.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "fit/data/bent_line.h"
#include "fit/data/smooth.h"
#include "fit/data/units.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kFewestAtRest = 5, kInARow = 5, kFewestRows = 12;
// Up to where the parabola is fitted: farther, noise weighs less and stiffening more.
constexpr double kPartOfRise = 0.03, kDeviations = 20.0;

// Of a baseline with a slope. Of 4 800 made-up curves that begin in contact the evidence of a bend is below 6 in all and below 3 in 99 of
// 100; of the silicone phantoms, which have a straight toe of a tenth of the way, it is below -100.
constexpr std::size_t kFewestOnSlope = 10, kMostRows = 2000;
constexpr double kCertain = 6.0, kDoubtful = -2.0;
constexpr double kSignificant = 4.0;  ///< standard deviations
constexpr double kLeastSlope = 1e-3;  ///< of the rise, over the whole way: less is the misfit of the parabola
constexpr double kSteepest = 0.35;    ///< of the rise, over the whole way
constexpr double kLoosest = 0.02;     ///< of the way: how vaguely a touch on a slope may be placed
constexpr double kBlunt = 0.1;  ///< of the way from the touch to where the fit ends: how late a blunt force is placed
// Of a force that is carried back to zero, of the whole way.
constexpr double kFarthestBack = 0.1, kVaguest = 0.01;

/// First row from which the force stays above a level for five rows; the number of rows where none does.
std::size_t first_above(std::span<const double> f, double level) {
  std::size_t run = 0;
  for (std::size_t i = 0; i < f.size(); ++i) {
    run = f[i] > level ? run + 1 : 0;
    if (run == kInARow) return i + 1 - kInARow;
  }
  return f.size();
}

/// The bent line without a slope: its touch.
std::optional<Contact> rested_contact(std::span<const double> x, std::span<const double> f) {
  const BentLine bent = bent_line(x, f, false);
  return Contact{.at = bent.touch, .deviation = bent.deviation, .rest_force = bent.level, .before = bent.before};
}

/// The parabola through the first rows, carried to F = 0; its deviation by that of the fitted force there.
std::optional<Contact> extrapolated_contact(std::span<const double> x, std::span<const double> f, double noise) {
  const auto n = static_cast<Eigen::Index>(x.size());
  const double width = x.back() - x.front();
  Eigen::MatrixX3d powers(n, 3);
  Eigen::VectorXd force(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double u = (x[static_cast<std::size_t>(i)] - x.front()) / width;
    powers.row(i) << 1.0, u, u * u;
    force[i] = f[static_cast<std::size_t>(i)];
  }
  const Eigen::Matrix3d inverse = (powers.transpose() * powers).inverse();
  const Eigen::Vector3d a = inverse * (powers.transpose() * force);
  double u = 0.0;
  for (int i = 0; i < 30; ++i) {
    const double slope = a[1] + 2.0 * a[2] * u;
    if (!(slope > 0.0)) return std::nullopt;
    u -= (a[0] + a[1] * u + a[2] * u * u) / slope;
  }
  const double slope = a[1] + 2.0 * a[2] * u;
  if (!(slope > 0.0) || !std::isfinite(u) || std::abs(u) > 1.0) return std::nullopt;
  const Eigen::Vector3d row(1.0, u, u * u);
  Contact contact{.at = x.front() + u * width, .extrapolated = true};
  contact.deviation = noise * std::sqrt(row.dot(inverse * row)) / slope * width;
  contact.before =
      static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [&](double v) { return v < contact.at; }));
  return contact;
}

}  // namespace

namespace {

/// Rows up to the largest force.
std::size_t loading_of(std::span<const double> f) {
  return static_cast<std::size_t>(std::max_element(f.begin(), f.end()) - f.begin()) + 1;
}

double noise_of(std::span<const double> f) {
  std::vector<double> rows(f.size());
  std::iota(rows.begin(), rows.end(), 0.0);
  return noise_about_curve(rows, f);
}

}  // namespace

namespace {

/// What the rows say of a baseline that rises or falls.
struct SlopedStudy {
  BentLine bent;
  double evidence = 0.0;  ///< of a bend rather than a smooth curve, as a logarithm
  double rise = 0.0;      ///< of the force above the baseline, to its largest [N]
  double part = 0.0;      ///< of that the baseline rises over the whole way
  double reach = 0.0;     ///< from the touch to the end of the fit
  bool risen = false;     ///< the force leaves the baseline for good

  bool rests() const { return risen && bent.before >= kFewestOnSlope && rise > 0.0; }
  bool significant() const {
    return std::abs(bent.slope) > kSignificant * bent.slope_deviation && std::abs(part) > kLeastSlope;
  }
  /// No tissue in contact gives way before it resists: there is a baseline.
  bool falls() const { return significant() && bent.slope < 0.0; }
  bool certain() const { return rests() && evidence > (falls() ? kDoubtful : kCertain); }
  /// A slope that no baseline has is tissue from the first row on.
  bool doubtful() const { return rests() && evidence > kDoubtful && std::abs(part) <= kSteepest; }
};

/// Means of neighbours, so many that what is left is few enough to be fitted over and over.
std::vector<double> thinned(std::span<const double> values, std::size_t most) {
  const std::size_t group = (values.size() + most - 1) / most;
  std::vector<double> out;
  for (std::size_t i = 0; i + group <= values.size(); i += group)
    out.push_back(std::accumulate(values.begin() + static_cast<std::ptrdiff_t>(i),
                                  values.begin() + static_cast<std::ptrdiff_t>(i + group), 0.0) /
                  static_cast<double>(group));
  return out;
}

/// A line through rows: level at x = 0, slope, and the slope's standard deviation.
struct Trend {
  double level = 0.0, slope = 0.0, deviation = 0.0;
};
Trend trend_of(std::span<const double> x, std::span<const double> f) {
  const auto n = static_cast<double>(x.size());
  const double mean_x = std::accumulate(x.begin(), x.end(), 0.0) / n,
               mean_f = std::accumulate(f.begin(), f.end(), 0.0) / n;
  double xx = 0.0, xf = 0.0, left = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mean_x) * (x[i] - mean_x);
    xf += (x[i] - mean_x) * (f[i] - mean_f);
  }
  Trend line;
  if (!(xx > 0.0)) return {mean_f, 0.0, 0.0};
  line.slope = xf / xx;
  line.level = mean_f - line.slope * mean_x;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double r = f[i] - line.level - line.slope * x[i];
    left += r * r;
  }
  if (n > 2.0) line.deviation = std::sqrt(left / (n - 2.0) / xx);
  return line;
}

/// The bent line of a free slope over the rows up to where the force has left its own baseline by as much as `rested_contact`
/// looks at: the window and the line are found in turn, from a line through the first eighth of the rows.
SlopedStudy study_slope(std::span<const double> all_x, std::span<const double> all_f, double threshold) {
  constexpr int kRounds = 8;
  const std::vector<double> x = thinned(all_x, kMostRows), f = thinned(all_f, kMostRows);
  SlopedStudy study;
  if (x.size() < 2 * kFewestRows || !(x.back() > x.front())) return study;
  const double noise = noise_of(f);
  const std::size_t head = std::max<std::size_t>(kFewestRows, x.size() / 8);
  Trend line = trend_of(std::span(x).first(head), std::span(f).first(head));
  std::vector<double> above(f.size());
  std::size_t end = 0;
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t i = 0; i < f.size(); ++i) above[i] = f[i] - line.level - line.slope * x[i];
    const std::size_t upper = first_above(above, std::max(kPartOfRise * above.back(), kDeviations * noise));
    const std::size_t last = std::exchange(end, std::clamp<std::size_t>(upper, 2 * kFewestRows, x.size()));
    if (end == last || !(x[end - 1] > x.front())) break;
    study.bent = bent_line(std::span(x).first(end), std::span(f).first(end), true);
    line.slope = study.bent.slope;
    line.level = study.bent.level - study.bent.slope * study.bent.touch;
  }
  for (std::size_t i = 0; i < f.size(); ++i) above[i] = f[i] - line.level - line.slope * x[i];
  study.rise = above.back();
  study.reach = x[end - 1] - study.bent.touch;
  study.risen = first_above(above, threshold * noise) < f.size() && study.rise > threshold * noise;
  study.part = study.bent.slope * (x.back() - x.front()) / study.rise;
  study.evidence = evidence_of_bend(std::span(x).first(end), std::span(f).first(end), study.bent);
  study.bent.before = static_cast<std::size_t>(
      std::count_if(all_x.begin(), all_x.end(), [&](double v) { return v < study.bent.touch; }));
  return study;
}

Contact on_slope(const SlopedStudy& study, double way) {
  const BentLine& bent = study.bent;
  Contact contact{.at = bent.touch, .deviation = bent.deviation, .rest_force = bent.level, .before = bent.before};
  contact.sloped = true, contact.slope = bent.slope, contact.slope_deviation = bent.slope_deviation;
  const std::string about = "the force changes by " + brief(100.0 * study.part, 2) +
                            " % of its rise over the whole way before it bends at contact";
  if (std::abs(study.part) > kSteepest)
    contact.doubt = about + ", more than the baseline of a cell does";
  else if (2.0 * bent.deviation + kBlunt * study.reach > kLoosest * way)
    contact.doubt = about + ", and the bend is too blunt to place contact on such a baseline";
  return contact;
}

/// Contact at rest, or carried back to zero where the file begins in contact; nothing where the force never rises.
std::optional<Contact> on_rest(std::span<const double> x, std::span<const double> f, double threshold) {
  const std::size_t loading = x.size();
  const double noise = noise_of(f);
  const std::size_t head = std::clamp<std::size_t>(loading / 50, kFewestAtRest, 50);
  const double rest = median_of({f.begin(), f.begin() + static_cast<std::ptrdiff_t>(head)});
  const double rise = f.back() - rest;
  const std::size_t risen = first_above(f, rest + threshold * noise);
  if (risen == f.size() || !(rise > threshold * noise)) return std::nullopt;
  const std::size_t upper = first_above(f, rest + std::max(kPartOfRise * rise, kDeviations * noise));
  const std::size_t end = std::min(loading, std::max({upper, risen + kFewestRows, kFewestRows}));
  if (!(x[end - 1] > x.front())) return std::nullopt;
  std::optional<Contact> contact;
  if (risen >= 2 * kFewestAtRest) contact = rested_contact(x.first(end), f.first(end));
  if (contact && contact->before >= kFewestAtRest) {
    const Trend line = trend_of(x.first(contact->before), f.first(contact->before));
    contact->slope = line.slope, contact->slope_deviation = line.deviation;
    // rows that rise from the first on, beyond their noise, are no rest: nothing is to be subtracted
    const bool rises = std::abs(line.slope) > kSignificant * line.deviation &&
                       std::abs(line.slope) * (contact->at - x.front()) > threshold * noise;
    if (contact->before >= kFewestOnSlope && rises) contact.reset();
  } else {
    contact.reset();
  }
  if (!contact) contact = extrapolated_contact(x.first(end), f.first(end), noise);
  if (contact) contact->first_force = rest;
  return contact;
}

constexpr const char* kBaselineOrTissue =
    "the force changes from the first row on, and its bend does not show whether that is a baseline with a slope or "
    "tissue";

/// Why a contact at rest is not to be believed: with a slope, which the rows do not exclude, it is elsewhere.
std::string doubt_of_rest(const Contact& contact, const SlopedStudy& study, double way) {
  const double apart = std::abs(contact.at - study.bent.touch);
  const bool elsewhere = apart > std::max(kLoosest * way, 3.0 * std::hypot(contact.deviation, study.bent.deviation));
  return study.rests() && elsewhere ? kBaselineOrTissue : "";
}

/// Why a contact that was carried back is not to be believed; empty: it is.
std::string doubt_of_extrapolated(const Contact& contact, const SlopedStudy& study, std::span<const double> x) {
  const double way = x.back() - x.front();
  if (study.doubtful()) return kBaselineOrTissue;
  if (study.rests() && study.falls())
    return "the force falls before it rises, as no tissue in contact does, and no bend shows where contact begins";
  if (x.front() - contact.at > kFarthestBack * way)
    return "the file begins in contact, and its force leads back to a place before the first row, by " +
           brief(100.0 * (x.front() - contact.at) / way, 2) + " % of the whole way";
  if (contact.deviation > kVaguest * way)
    return "the file begins in contact, and its force tells the place only within ± " +
           brief(100.0 * contact.deviation / way, 2) + " % of the whole way";
  return {};
}

}  // namespace

std::optional<Contact> find_contact(std::span<const double> x, std::span<const double> f, double threshold,
                                    bool sloped) {
  if (x.size() < kFewestRows) return std::nullopt;
  const std::size_t loading = loading_of(f);
  if (loading < kFewestRows) return std::nullopt;
  x = x.first(loading);
  f = f.first(loading);
  const SlopedStudy study = study_slope(x, f, threshold);
  const double way = x.back() - x.front();
  if (study.certain() && (sloped || study.significant())) return on_slope(study, way);
  std::optional<Contact> contact = on_rest(x, f, threshold);
  if (sloped && contact && !contact->extrapolated && study.rests()) return on_slope(study, way);
  if (sloped && contact)
    contact->doubt =
        "other curves of this test have a baseline with a slope, and too few rows before contact show that of this one";
  else if (contact)
    contact->doubt =
        contact->extrapolated ? doubt_of_extrapolated(*contact, study, x) : doubt_of_rest(*contact, study, way);
  return contact;
}

RestLine rest_before(std::span<const double> x, std::span<const double> f, double at, bool sloped) {
  RestLine out;
  if (x.empty()) return out;
  const Trend line = trend_of(x, f);
  out.slope = line.slope, out.slope_deviation = line.deviation;
  out.sloped = x.size() >= kFewestOnSlope && (sloped || std::abs(line.slope) > kSignificant * line.deviation);
  out.force = out.sloped ? line.level + line.slope * at
                         : std::accumulate(f.begin(), f.end(), 0.0) / static_cast<double>(f.size());
  return out;
}

std::optional<Contact> contact_from(std::span<const double> x, std::span<const double> f, const Contact& own,
                                    double preload) {
  const std::size_t loading = loading_of(f);
  std::vector<double> force(f.begin(), f.begin() + static_cast<std::ptrdiff_t>(loading));
  for (double& value : force) value -= own.rest_force;
  const double noise = noise_of(force);
  const std::size_t from = first_above(force, preload);
  const std::size_t upper = first_above(force, preload + std::max(kPartOfRise * force.back(), kDeviations * noise));
  const std::size_t end = std::min(loading, std::max(upper, from + kFewestRows));
  if (from >= end || end - from < kFewestRows) return std::nullopt;
  auto contact = extrapolated_contact(x.subspan(from, end - from), std::span(force).subspan(from, end - from), noise);
  if (!contact) return std::nullopt;
  contact->rest_force = own.rest_force, contact->first_force = own.first_force;
  contact->before =
      static_cast<std::size_t>(std::count_if(x.begin(), x.end(), [&](double v) { return v < contact->at; }));
  return contact;
}

}  // namespace glisson::fit
