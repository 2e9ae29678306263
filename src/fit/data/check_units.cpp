// check_units.cpp — numbers that look like another unit: the slip that a factor of 1000 makes without a word.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>

#include "fit/data/raw_test.h"
#include "lab/indenter.h"

namespace glisson::fit {
namespace {

constexpr double kFarOff = 30.0;      // between a true stress against an engineering one, ≈ 3, and a slip of 100
constexpr double kDeepest = 1.0;      // of compression, in heights
constexpr double kFarthest = 10.0;    // of any other test
constexpr double kShallowest = 5e-4;  // of a test of soft tissue, in heights
constexpr double kSoftest = 10.0, kStiffest = 2e7;   // secant moduli of soft tissues and their phantoms [Pa]
constexpr double kSlowest = 1e-8, kFastest = 100.0;  // tools [m/s]
constexpr double kRepetitions = 100.0;
constexpr double kAgainst = 0.5;  // correlation of force and displacement below minus this: a sign is wrong
constexpr const char* kWayOut = ", or unlikely = true to take it as it is";

double largest(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) {
    if (std::isfinite(v)) most = std::max(most, std::abs(v));
  }
  return most;
}

/// How far the numbers go from the first.
double span_of(const std::vector<double>& values) {
  double most = 0.0;
  for (const double v : values) most = std::max(most, std::abs(v - values.front()));
  return most;
}

/// `84.1 kN`.
std::string in_unit(double value, const Unit& unit) {
  return brief(value / unit.factor) + " " + std::string(unit.name);
}

/// The unit that makes numbers `ratio` times smaller, where there is one within half a power of ten.
const Unit* better_unit(const Source& source, double ratio) {
  const Unit* best = nullptr;
  double least = 0.5;
  for (const Unit& unit : units_of(source.quantity)) {
    const double off = std::abs(std::log10(source.unit->factor / unit.factor / ratio));
    if (&unit != source.unit && off < least) {
      least = off;
      best = &unit;
    }
  }
  return best;
}

/// `columns.force = { name = "Load (N)", unit = "N" }`.
std::string as_key(const Source& source, const Unit& unit) {
  const std::string choice = source.title.front() == '"'
                                 ? "name = " + source.title
                                 : "number = " + source.title.substr(source.title.find(' ') + 1);
  return source.key + " = { " + choice + ", unit = \"" + std::string(unit.name) + "\" }";
}

/// `; in N it would be 84.1 N: give columns.force = …`.
std::string way_out(const Source& source, double value, double ratio) {
  if (!source.unit) return std::string("; check speed_mm_s") + kWayOut;
  const Unit* unit = better_unit(source, ratio);
  if (!unit) return std::string("; check the unit of ") + source.title + kWayOut;
  const double as_written = value / source.unit->factor * unit->factor;
  return "; in " + std::string(unit->name) + " it would be " + in_unit(as_written, *unit) + ": give " +
         as_key(source, *unit) + kWayOut;
}

class UnitCheck {
 public:
  UnitCheck(const RawTest& test, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems)
      : test_(test), spec_(spec), size_(size), problems_(problems) {}

  void run() {
    const std::size_t before = problems_.count();
    const Measurement& m = test_.measurement;
    if (m.test == LabTest::oscillation) return check_modulus(test_.force_source, largest(test_.force));
    if (runs_backwards()) return;
    check_signs();
    if (m.drive_unit == "rad") {
      check_twist();
    } else {
      check_depth();
      check_columns();
    }
    if (m.timed && m.drive_unit == "m" && m.test != LabTest::creep) check_speed();
    if (problems_.count() == before) check_stiffness();
  }

  /// Complains of an answer that never changes. An elastic tissue has one modulus at all frequencies, and one stress while held.
  bool answers() {
    const double first = test_.force.front();
    if (test_.measurement.test == LabTest::oscillation || span_of(test_.force) > 0.0) return true;
    if (first != 0.0 && !(span_of(test_.displacement) > 0.0)) return true;
    complain(test_.force_source.title + " is " + in_unit(own(test_.force_source, first), *test_.force_source.unit) +
             " in all of the " + std::to_string(test_.size()) +
             " rows, so that nothing can be fitted to it; choose another column or file" + kWayOut);
    return false;
  }

 private:
  void complain(const std::string& what) { problems_.add({std::max(test_.names_line, 1U), 1, {}}, "", what); }

  std::string read_as(const Source& source, double value) const {
    const bool pure = source.unit->name == "-";
    return source.title + ", read " +
           (pure ? std::string("as a pure number") : "in " + std::string(source.unit->name)) + ", goes to " +
           (pure ? brief(value) : in_unit(value, *source.unit));
  }

  /// Complains of a test that begins at its farthest and ends at rest, as rows that were written from the last to the first.
  bool runs_backwards() {
    constexpr double kRest = 0.1;  // of the first number
    const auto& x = test_.displacement;
    const auto& f = test_.force;
    const bool ends_at_rest =
                   std::abs(x.back()) < kRest * std::abs(x.front()) && std::abs(f.back()) < kRest * std::abs(f.front()),
               begins_farthest = std::abs(x.front()) >= largest(x) && std::abs(f.front()) >= (1.0 - kRest) * largest(f);
    if (!ends_at_rest || !begins_farthest) return false;
    const auto ends = [&](const Source& source, const std::vector<double>& values) {
      return source.title + " goes from " + in_unit(own(source, std::abs(values.front())), *source.unit) + " to " +
             in_unit(own(source, std::abs(values.back())), *source.unit);
    };
    complain("the rows run backwards: " + ends(test_.displacement_source, x) + ", " + ends(test_.force_source, f) +
             "; write them in the order of the test, from rest on" + kWayOut);
    return true;
  }

  /// The number as the file has it: without the height or area that turned strain into way, stress into force.
  double own(const Source& source, double si) const {
    if (source.quantity == Quantity::strain || source.quantity == Quantity::stretch)
      return si / size_.height.value_or(1.0);
    if (source.quantity == Quantity::stress) return si / size_.area.value_or(1.0);
    return si;
  }

  /// Force and displacement of a test change together; relaxation and noise leave that as it is. A baseline that falls before
  /// contact and a pull-off after it do not.
  void check_signs() {
    if (direction_while_loading(test_.force, test_.displacement).value_or(-1.0) > 0.0) return;
    double together = 0.0, d2 = 0.0, f2 = 0.0;
    for (std::size_t i = 0; i < test_.size(); ++i) {
      const double d = test_.displacement[i] - test_.displacement.front(), f = test_.force[i] - test_.force.front();
      together += d * f, d2 += d * d, f2 += f * f;
    }
    if (!(together < -kAgainst * std::sqrt(d2 * f2))) return;
    complain(test_.force_source.title + " falls as " + test_.displacement_source.title +
             " rises, force against its own displacement; give sign = \"positive\" or \"negative\" in " +
             test_.displacement_source.key + " or " + test_.force_source.key + ", or leave both to be found" + kWayOut);
  }

  void check_depth() {
    const double deepest = span_of(test_.displacement);
    if (!size_.height || deepest <= 0.0) return;
    const double strain = deepest / *size_.height;
    const Deforming how = test_.measurement.deforming;
    const bool indented = how == Deforming::indentation, pressed = indented || how == Deforming::compression;
    const double farthest = pressed ? kDeepest : kFarthest;
    if (strain <= farthest && (indented || strain >= kShallowest)) return;
    const Source& source = test_.displacement_source;
    const double value = own(source, deepest);
    double ratio = strain > farthest ? 1000.0 : 1e-3;
    if (source.quantity != Quantity::length) ratio = strain > farthest ? 100.0 : 1e-2;
    const std::string height =
        size_.point
            ? ", a strain of " + brief(strain)
            : ", " + brief(strain) + (indented ? " of the layer's thickness of " : " of the specimen's height of ") +
                  brief(*size_.height * 1e3) + " mm";
    complain(read_as(source, value) + height + "; a test goes to between " + brief(kShallowest) + " and " +
             brief(farthest) + way_out(source, value, ratio));
  }

  /// Surface shear of a twisted cylinder: an angle in degrees taken for radians is far beyond it.
  void check_twist() {
    const double angle = span_of(test_.displacement), shear = angle * *size_.radius / *size_.height;
    if (shear <= kFarthest && shear >= kShallowest) return;
    complain(read_as(test_.displacement_source, angle) + ", a shear of " + brief(shear) +
             " at the surface; a test goes to between " + brief(kShallowest) + " and " + brief(kFarthest) +
             way_out(test_.displacement_source, angle, shear > kFarthest ? 57.3 : 1.0 / 57.3));
  }

  void check_columns() {
    for (const CheckColumn& check : test_.checks) {
      const bool stress = check.source.quantity == Quantity::stress;
      const std::optional<double>& size = stress ? size_.area : size_.height;
      const Source& source = stress ? test_.force_source : test_.displacement_source;
      if (!size || check.source.title == source.title) continue;
      const double used = stress ? largest(test_.force) : span_of(test_.displacement);
      compare(source, used, *size, check.source, largest(check.values));
    }
  }

  void compare(const Source& source, double used, double size, const Source& other, double expected) {
    const double ratio = used / (size * expected);
    if (!(ratio > 0.0) || !std::isfinite(ratio) || (ratio < kFarOff && ratio > 1.0 / kFarOff)) return;
    const bool stress = other.quantity == Quantity::stress;
    const Unit& unit = *other.unit;
    complain(read_as(source, own(source, used)) + (stress ? ", a stress of " : ", a strain of ") +
             in_unit(used / size, unit) + ", but " + other.title + " goes to " + in_unit(expected, unit) +
             way_out(source, own(source, used), ratio));
  }

  void check_speed() {
    if (test_.size() < 2 || test_.displacement.empty()) return;
    const double way = span_of(test_.displacement), time = test_.time.back() - test_.time.front();
    if (!(way > 0.0) || !(time > 0.0)) return;
    if (spec_.speed && test_.time_source.unit) {
      const double ratio = *spec_.speed * time / way;
      // Back and forth and rests take longer than the way alone, by less than a slip of the unit would.
      if (ratio > 300.0 || ratio < 1.0 / kFarOff)
        complain(read_as(test_.time_source, time) + "; at speed_mm_s = " + brief(*spec_.speed * 1e3) +
                 " the tool goes " + brief(*spec_.speed * time * 1e3) + " mm, but " + test_.displacement_source.title +
                 " spans " + brief(way * 1e3) + " mm" + way_out(test_.time_source, time, ratio));
      return;
    }
    const double speed = way / time;
    if (speed < kSlowest || speed > kFastest)
      complain(test_.displacement_source.title + " and " + test_.time_source.title + " give a mean speed of " +
               brief(speed) + " m/s; expected " + brief(kSlowest) + " to " + brief(kFastest) + "; check their units" +
               kWayOut);
  }

  /// Of an indenter by the closed form for a thick layer; a thin one is stiffer, by less than a slip of the unit.
  void check_indentation() {
    const double depth = span_of(test_.displacement), force = span_of(test_.force);
    if (!(depth > 0.0) || !(force > 0.0)) return;
    check_modulus(test_.force_source, force, lab::thick_layer_modulus(*test_.measurement.indenter, depth, force));
  }

  void check_stiffness() {
    if (test_.measurement.indenter) return check_indentation();
    if (!size_.area || !size_.height) return;
    const double way = span_of(test_.displacement), force = span_of(test_.force);
    if (!(way > 0.0) || !(force > 0.0)) return;
    // of a twisted cylinder G = 2 M H / (π R⁴ φ)
    const double over = test_.measurement.drive_unit == "rad"
                            ? 0.5 * *size_.area * *size_.radius * *size_.radius / *size_.height
                            : *size_.area / *size_.height;
    check_modulus(test_.force_source, own(test_.force_source, force), force / way / over);
  }
  void check_modulus(const Source& source, double value) { check_modulus(source, value, value); }
  void check_modulus(const Source& source, double value, double modulus) {
    if (modulus >= kSoftest && modulus <= kStiffest) return;
    complain(read_as(source, value) + ", a stiffness of " + brief(modulus) +
             " Pa over the specimen; soft tissues have " + brief(kSoftest) + " to " + brief(kStiffest) + " Pa" +
             way_out(source, value, modulus > kStiffest ? 1000.0 : 1e-3));
  }

  const RawTest& test_;
  const DataSpec& spec_;
  const SpecimenSize& size_;
  scene::Problems& problems_;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

using Size = std::function<double(const RawTest&)>;
using From = std::function<const Source&(const RawTest&)>;

void compare_with_median(const std::vector<RawTest>& tests, const Size& size, const From& from,
                         std::vector<std::string>& faults) {
  std::vector<double> sizes;
  for (const RawTest& test : tests) sizes.push_back(size(test));
  const double usual = median(sizes);
  for (std::size_t i = 0; i < tests.size(); ++i) {
    const double ratio = sizes[i] / usual;
    const Source& source = from(tests[i]);
    if (!source.unit || !std::isfinite(ratio) || (ratio < kRepetitions && ratio > 1.0 / kRepetitions)) continue;
    const scene::Problems place(tests[i].file.string());
    faults.push_back(place.locate({std::max(tests[i].names_line, 1U), 1, {}}, "") + ": " + source.title + ", read in " +
                     std::string(source.unit->name) + ", spans " + brief(ratio) +
                     " times what the other tests of its group span; check its unit in this file, give the file a "
                     "[[data]] of its own" +
                     kWayOut);
  }
}

}  // namespace

void check_units(const RawTest& test, const DataSpec& spec, const SpecimenSize& size, scene::Problems& problems) {
  if (spec.unlikely || test.size() == 0 || !UnitCheck(test, spec, size, problems).answers()) return;
  if (!test.measurement.loaded()) return UnitCheck(test, spec, size, problems).run();
  RawTest deformed = test;  // as if its strain had been driven
  swap_load(deformed, Measured::nominal);
  UnitCheck(deformed, spec, size, problems).run();
}

std::vector<std::string> repetition_faults(const std::vector<RawTest>& tests) {
  std::vector<std::string> faults;
  if (tests.size() < 2) return faults;
  using Test = const RawTest&;
  const auto way = [](Test t) -> const Source& { return t.displacement_source; };
  const auto force = [](Test t) -> const Source& { return t.force_source; };
  const auto time = [](Test t) -> const Source& { return t.time_source; };
  compare_with_median(
      tests, [](Test t) { return span_of(t.displacement); }, way, faults);
  compare_with_median(
      tests, [](Test t) { return span_of(t.force); }, force, faults);
  compare_with_median(
      tests, [](Test t) { return t.time.back() - t.time.front(); }, time, faults);
  return faults;
}

}  // namespace glisson::fit
