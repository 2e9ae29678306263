#include "fit/data/prepare.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "fit/data/contact.h"
#include "fit/data/samples.h"
#include "fit/data/smooth.h"

namespace glisson::fit {
namespace {

constexpr std::size_t kFewestPoints = 5;
constexpr double kFarOut = 5.0;      ///< standard deviations that are no noise
constexpr double kPastPart = 0.002;  ///< of the whole time, between two rows that are kept of the past

class Preparation {
 public:
  Preparation(const RawTest& test, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems)
      : test_(test), spec_(spec), size_(size), problems_(problems), rows_{test.time, test.displacement, test.force} {
    account_.name = test.file.stem().string();
    account_.file = test.file;
    account_.rows_read = test.size() + test.rows_skipped + test.rows_merged;
    account_.rows_skipped = test.rows_skipped;
    account_.rows_merged = test.rows_merged;
    account_.turned = test.turned;
    account_.clock = test.clock;
    account_.unit = test.measurement.unit;
    account_.drive_unit = test.measurement.point ? "whole strain" : test.measurement.drive_unit;
  }

  std::optional<PreparedCurve> run() {
    if (!enough("the file", "record or export more rows") || !suits_creep()) return std::nullopt;
    if (spec_.filter.kind == FilterKind::median)
      rows_.force = running_median(rows_.force, static_cast<std::size_t>(spec_.filter.half_width));
    if (!take_cycle() || !enough("the cycle", "choose another `cycle`")) return std::nullopt;
    if (!take_contact() || !enough("what follows contact", "check `contact`")) return std::nullopt;
    return finish();
  }

 private:
  bool enough(const std::string& where, const std::string& way_out) {
    if (rows_.size() >= kFewestPoints) return true;
    complain("too few points: " + where + " has " + std::to_string(rows_.size()) + " of the " +
             std::to_string(account_.rows_read) + " rows read; at least " + std::to_string(kFewestPoints) +
             " are needed; " + way_out);
    return false;
  }
  void complain(const std::string& what) {
    problems_.add({test_.lines.empty() ? 1U : test_.lines.back(), 1, {}}, "", what);
  }

  /// What goes by the displacement does not go with a test that is driven by its load.
  bool suits_creep() {
    if (!test_.measurement.loaded()) return true;
    const CropSpec& c = spec_.crop;
    if (spec_.contact.kind != ContactKind::none)
      complain(
          "a creep is driven by its load, in which no contact is found; remove `contact`, and free "
          "curve.contact_mm where the file's zero is not at contact");
    else if (c.min_displacement || c.max_displacement || c.min_strain || c.max_strain || c.min_force || c.max_force ||
             c.until != CropUntil::end)
      complain("a creep is cropped by time: give crop.min_time_s or crop.max_time_s alone");
    else
      return true;
    return false;
  }

  bool take_cycle() {
    const auto turns = turning_points(rows_.displacement, spec_.cycle.least);
    account_.cycles = turns.size() / 2;
    const bool whole = spec_.cycle.part == CyclePart::both && !spec_.cycle.number;
    const auto number = static_cast<std::size_t>(spec_.cycle.number.value_or(1));
    const std::size_t first = 2 * (number - 1) + (spec_.cycle.part == CyclePart::unloading ? 1 : 0);
    const std::size_t last = first + (spec_.cycle.part == CyclePart::both ? 2 : 1);
    if (!whole && first + 1 >= turns.size()) {
      complain("has no " + std::string(spec_.cycle.part == CyclePart::unloading ? "unloading" : "loading") +
               " of cycle " + std::to_string(number) + ": " + std::to_string(account_.cycles) +
               " found; choose another cycle.number or cycle.part, or lower cycle.least");
      return false;
    }
    if (!whole) {
      const std::size_t end = turns[std::min(last, turns.size() - 1)] + 1;
      keep_past(turns, turns[first], rows_.time[end - 1] - rows_.time.front());
      rows_ = rows_.part(turns[first], end);
    }
    account_.rows_in_cycle = rows_.size();
    return true;
  }

  /// What was before a row, which branches and viscosity remember: its turns, and rows at a five-hundredth of the whole time.
  void keep_past(const std::vector<std::size_t>& turns, std::size_t until, double whole) {
    for (std::size_t i = 0; i < until; ++i) {
      const bool turn = std::binary_search(turns.begin(), turns.end(), i);
      if (turn || rows_.time[i] - past_.time.back() >= kPastPart * whole) past_.push(rows_, i);
    }
  }

  bool take_contact() {
    const ContactSpec& contact = spec_.contact;
    if (contact.kind == ContactKind::none) {
      account_.contact_how = "as recorded";
      start_at(0.0, spec_.is_heat() ? 0.0 : rows_.time.front());  // a probe's time is that of the scene
      return true;
    }
    Contact found{.at = contact.at};
    if (contact.kind == ContactKind::detect) {
      const auto detected = find_contact(rows_.displacement, rows_.force, contact.threshold, contact.sloped);
      if (!detected) {
        complain(
            "contact not found: the force does not rise clearly above its noise at the start; check the columns, "
            "lower contact.threshold_sd, or give contact = { kind = \"given\", at_mm = … } or kind = \"none\"");
        return false;
      }
      if (!detected->doubt.empty()) {
        complain(
            "contact is not certain: " + detected->doubt +
            "; give contact = { kind = \"given\", at_mm = … }, which takes the line through the rows before it off "
            "the force, or kind = \"none\" where the file's zero is at contact, or record more rows before the touch");
        return false;
      }
      found = *detected;
      account_.first_force = found.first_force;
      if (contact.preload > 0.0)
        found = contact_from(rows_.displacement, rows_.force, found, contact.preload).value_or(found);
    }
    account_.contact_how = contact.kind == ContactKind::given ? "given"
                           : found.extrapolated               ? "extrapolated"
                                                              : "detected";
    apply(found);
    return true;
  }

  void apply(Contact contact) {
    const auto touch = static_cast<std::size_t>(
        std::find_if(rows_.displacement.begin(), rows_.displacement.end(), [&](double x) { return x >= contact.at; }) -
        rows_.displacement.begin());
    if (spec_.contact.kind == ContactKind::given && touch > 0) {
      const RestLine rest = rest_before(std::span(rows_.displacement).first(touch), std::span(rows_.force).first(touch),
                                        contact.at, spec_.contact.sloped);
      contact.rest_force = rest.force, contact.sloped = rest.sloped;
      contact.slope = rest.slope, contact.slope_deviation = rest.slope_deviation;
    }
    account_.contact = contact.at;
    account_.contact_deviation = contact.deviation;
    account_.rows_before_contact = touch;
    account_.slope = contact.slope, account_.slope_deviation = contact.slope_deviation;
    if (spec_.contact.zero_force) take_off_baseline(contact);
    const double start = time_at(contact.at, touch);
    rows_ = rows_.part(touch, rows_.size());
    start_at(contact.at, start);
  }

  void take_off_baseline(const Contact& contact) {
    account_.force_at_rest = contact.rest_force;
    account_.sloped = contact.sloped;
    const double slope = contact.sloped ? contact.slope : 0.0;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      rows_.force[i] -= contact.rest_force + slope * (rows_.displacement[i] - contact.at);
  }

  /// Time at which the way crosses a displacement between two rows; before the first row, by the speed of the first rows.
  double time_at(double x, std::size_t row) const {
    if (row >= rows_.size()) return rows_.time.back();
    const std::size_t other = row > 0 ? row - 1 : std::min(row + 5, rows_.size() - 1);
    const double way = rows_.displacement[row] - rows_.displacement[other];
    const double part = way != 0.0 ? (rows_.displacement[row] - x) / way : 0.0;
    const double time = rows_.time[row] - part * (rows_.time[row] - rows_.time[other]);
    return std::isfinite(time) ? std::min(time, rows_.time[row]) : rows_.time[row];
  }

  void start_at(double displacement, double time) {
    for (Samples* rows : {&rows_, &past_}) {
      for (double& x : rows->displacement) x -= displacement;
      for (double& t : rows->time) t -= time;
    }
  }

  std::optional<PreparedCurve> finish() {
    if (!size_.height && (spec_.crop.min_strain || spec_.crop.max_strain)) {
      complain(
          "cannot be cropped by strain: the height of the specimen is not known; give height_mm or crop by "
          "displacement");
      return std::nullopt;
    }
    const double all_noise = noise_about_curve(rows_.time, rows_.force);
    const std::size_t before = rows_.size();
    rows_ = cropped(rows_, spec_.crop, size_.height.value_or(1.0), all_noise);
    account_.rows_cropped = before - rows_.size();
    if (!enough("what the crop leaves", "widen `crop`")) return std::nullopt;
    account_.row_noise = noise_about_curve(rows_.time, rows_.force);
    if (!pushes()) return std::nullopt;
    if (spec_.filter.kind == FilterKind::savitzky_golay)
      rows_.force = local_fit(rows_.time, rows_.force, static_cast<std::size_t>(spec_.filter.half_width),
                              static_cast<std::size_t>(spec_.filter.degree))
                        .values;
    const Measurement& m = test_.measurement;
    const double velocity = m.timed && m.drive_unit == "m" ? loading_velocity() : 0.0;
    if (!can_resample()) return std::nullopt;
    const Resampled points = resampled(rows_, spec_.resample);
    rows_ = points.rows;
    if (!enough("the resampled curve", "raise resample.points")) return std::nullopt;
    account_.points = rows_.size();
    const double row_noise = spec_.deviation.value_or(account_.row_noise);
    return PreparedCurve{curve(velocity, row_noise / std::sqrt(points.rows_a_point)), account_};
  }

  /// Whether an indenter pushes all along. Adhesion is not in the model: of a pull-off the fit would make a softer tissue.
  bool pushes() {
    constexpr double kPull = 0.1;  // of the largest push
    if (!test_.measurement.indenter || test_.measurement.loaded() || spec_.unlikely) return true;
    const auto [least, most] = std::minmax_element(rows_.force.begin(), rows_.force.end());
    if (-*least < kPull * *most || -*least < kFarOut * account_.row_noise) return true;
    complain("the indenter is pulled by up to " + measured_text(-*least, account_.unit) + " where it pushes by up to " +
             measured_text(*most, account_.unit) +
             ": adhesion is not in the model; fit the way in alone, cycle = { part = \"loading\" }, or give "
             "contact where the file's zero is wrong, or unlikely = true to take it as it is");
    return false;
  }

  bool can_resample() {
    if (spec_.resample.over != ResampleOver::displacement) return true;
    if (turning_points(rows_.displacement, spec_.cycle.least).size() <= 2) return true;
    complain(
        "goes in and out again, so that a displacement comes more than once; give cycle.part = \"loading\", or "
        "resample.over = \"time\"");
    return false;
  }

  /// From the first row to the deepest.
  double loading_velocity() const {
    const auto& x = rows_.displacement;
    const auto deepest = static_cast<std::size_t>(std::max_element(x.begin(), x.end()) - x.begin());
    const std::size_t end = deepest > 0 ? deepest : x.size() - 1;
    const double time = rows_.time[end] - rows_.time.front();
    return time > 0.0 ? std::abs(x[end] - x.front()) / time : 0.0;
  }

  Curve curve(double velocity, double noise) {
    Curve c;
    c.name = account_.name;
    c.group = spec_.group;
    c.batch = spec_.batch;
    c.time = std::move(rows_.time);
    c.displacement = std::move(rows_.displacement);
    c.past_time = std::move(past_.time);
    c.past_displacement = std::move(past_.displacement);
    c.force = std::move(rows_.force);
    c.velocity = velocity;
    c.noise = noise;
    c.noise_given = spec_.deviation.has_value();
    c.weight = spec_.weight;
    c.held_out = spec_.held_out;
    c.measurement = test_.measurement;
    return c;
  }

  const RawTest& test_;
  const DataSpec& spec_;
  const SpecimenSize& size_;
  scene::Problems& problems_;
  Samples rows_, past_;  ///< past: before the first of a cycle
  CurveAccount account_;
};

}  // namespace

namespace {

/// "0.169 mN a mm ± 0.001 mN".
std::string slope_text(const CurveAccount& a) {
  const bool length = a.drive_unit == "m";
  const double step = length ? 1e-3 : 1.0;
  return measured_text(step * a.slope, a.unit, 4) + " a " + (length ? "mm" : a.drive_unit) + " ± " +
         measured_text(step * a.slope_deviation, a.unit, 2);
}

}  // namespace

std::string CurveAccount::text() const {
  if (file.empty())
    return name + ": " + std::to_string(points) + (points == 1 ? " value" : " values") + " of FIT.toml, ± " +
           measured_text(row_noise, unit, 4);
  std::string t = name + ": " + std::to_string(rows_read) + " rows";
  if (rows_skipped > 0) t += ", " + std::to_string(rows_skipped) + " bad ones skipped";
  if (rows_merged > 0) t += ", " + std::to_string(rows_merged) + " of equal time averaged";
  if (cycles > 1) t += ", " + std::to_string(cycles) + " cycles";
  if (!clock.empty()) t += "; clock times, read as seconds since " + clock;
  for (const std::string& column : turned) t += "; sign of " + column + " turned";
  if (contact_how.starts_with("as recorded (")) t += "; contact " + contact_how;
  if (!contact_how.starts_with("as recorded")) {
    t += "; contact " + contact_how + " at " + brief(contact * 1e3) + " mm";
    if (contact_deviation > 0.0) t += " ± " + brief(contact_deviation * 1e3) + " mm";
    t += ", " + measured_text(force_at_rest, unit, 4) + " subtracted from the force";
    if (slope_deviation > 0.0)
      t += std::string(sloped ? " there, with the baseline's slope of " : "; the baseline's slope, ") +
           slope_text(*this) + (sloped ? "" : ", is left in it");
  }
  if (rows_cropped > 0) t += "; " + std::to_string(rows_cropped) + " rows cropped";
  return t + "; " + std::to_string(points) + " points, noise of a row " + measured_text(row_noise, unit, 4);
}

std::string CurveAccount::skipped_text() const {
  return std::to_string(rows_skipped) + " of " + std::to_string(rows_read) + " rows of " + name +
         " have no number in a column that is needed and were skipped (skip_bad_rows).";
}

std::optional<PreparedCurve> prepare(const RawTest& test, const DataSpec& spec, const SpecimenSize& size,
                                     scene::Problems& problems) {
  return Preparation(test, spec, size, problems).run();
}

}  // namespace glisson::fit
