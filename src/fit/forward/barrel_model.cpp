#include "fit/forward/barrel_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/text.h"
#include "material/uniaxial_path.h"

namespace glisson::fit {
namespace {

constexpr double kFirst = 0.005;              ///< strain of the first place of φ
constexpr double kBetween = 0.075;            ///< between the others, of |ln λ|
constexpr double kBeyondCreep = 1.2;          ///< how far φ is known beyond what a creep has measured
constexpr double kAlike = 1e-9;               ///< of a creep: last change of its strain
constexpr double kLeast = 0.05, kMost = 5.0;  ///< stretches to which the barrel is followed
constexpr int kMostRounds = 60;               ///< of a creep
constexpr std::size_t kMostKnown = 64;        ///< functions φ that are kept

double area_of(const Plates& plates) { return std::numbers::pi * plates.radius * plates.radius; }

/// Strains from the first to the farthest, evenly spaced in ln λ, < 0 where it is pressed.
std::vector<double> places_of_factor(double farthest) {
  const double side = farthest < 0.0 ? -1.0 : 1.0, most = std::log1p(farthest);
  std::vector<double> strains{side * std::min(kFirst, std::abs(farthest))};
  const int count = static_cast<int>(std::ceil(std::abs(most) / kBetween));
  for (int k = 1; k <= count; ++k) {
    const double strain = k == count ? farthest : std::expm1(most * k / count);
    if (std::abs(strain) > 2.0 * kFirst) strains.push_back(strain);
  }
  return strains;
}

/// Whether the faces have a say in how a specimen deforms: not where they are moved along each other or turned.
bool goes_along(const Curve& curve) {
  const Measurement& m = curve.measurement;
  return m.test != LabTest::oscillation && (m.deforming == Deforming::compression || m.deforming == Deforming::tension);
}

}  // namespace

/// φ of one set of values, made once.
struct BarrelModel::Known {
  std::vector<double> values;
  double contact = 0.0;
  std::once_flag once;
  std::optional<MonotoneCubic<double>> factor;
  std::string failure;
};

BarrelModel::BarrelModel(std::vector<Curve> curves, const Plates& plates, TissueAt tissue,
                         std::vector<std::string> keys, const lab::BarrelGrid& grid)
    : MotionModel(curves), plates_(plates), tissue_(tissue), keys_(std::move(keys)),
      homogeneous_(std::move(curves), {area_of(plates), plates.height, plates.radius}, std::move(tissue)),
      mesh_(std::make_shared<lab::BarrelMesh>(plates.radius, plates.height, grid)) {
  for (std::size_t c = 0; c < this->curves(); ++c) {
    if (!goes_along(curve(c))) continue;
    reach(curve(c));
    require_curve(curve(c));
  }
}

/// How far a curve goes to either side.
void BarrelModel::reach(const Curve& curve) {
  const double outward = curve.measurement.outward(), more = curve.measurement.loaded() ? kBeyondCreep : 1.0;
  const bool only_presses = plates_.faces == lab::Faces::friction || curve.measurement.test == LabTest::compression;
  for (const double d : curve.measurement.loaded() ? curve.force : curve.displacement) {
    const double out = outward * more * d;
    pressed_ = std::max(pressed_, -out);
    if (!only_presses) pulled_ = std::max(pulled_, out);
  }
}

void BarrelModel::require_curve(const Curve& curve) const {
  const Measurement& m = curve.measurement;
  const auto refuse = [&](const std::string& what) {
    throw std::invalid_argument("curve \"" + curve.name + "\": " + what);
  };
  if (m.measured == Measured::cauchy)
    refuse("true stress has no one area between faces that do not slide freely; give columns.stress or columns.force");
  if (plates_.faces != lab::Faces::friction) return;
  if (m.test == LabTest::cyclic)
    refuse(
        "friction is that of a compression that goes on; crop the file to its loading and give test = "
        "\"compression\", or set faces = \"bonded\" or \"smooth\" in [specimen]");
  if (m.deforming == Deforming::tension)
    refuse("plates pull only what is glued to them; set faces = \"bonded\" in [specimen]");
}

std::vector<double> BarrelModel::of_tissue(std::span<const double> values) const {
  std::vector<double> rest;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_plate_key(keys_[i])) rest.push_back(values[i]);
  }
  return rest;
}

lab::Grip BarrelModel::grip(std::span<const double> values) const {
  lab::Grip g = plates_.grip;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (keys_[i] == kFrictionKey) g.friction = values[i];
    if (keys_[i] == kAdhesionKey) g.adhesion = values[i];
  }
  return g;
}

std::shared_ptr<BarrelModel::Known> BarrelModel::known(std::span<const double> values, double contact) const {
  const std::lock_guard lock(mutex_);
  for (const auto& k : known_) {
    if (k->contact == contact && std::equal(k->values.begin(), k->values.end(), values.begin(), values.end())) return k;
  }
  auto made = std::make_shared<Known>();
  made->values.assign(values.begin(), values.end());
  made->contact = contact;
  known_.push_back(made);
  if (known_.size() > kMostKnown) known_.pop_front();
  return made;
}

/// φ at strains from rest to one side.
std::vector<double> BarrelModel::factors_at(const std::vector<double>& strains, std::span<const double> values) const {
  Tissue tissue = tissue_(of_tissue(values));
  tissue.viscosity = 0.0, tissue.maxwell.clear();
  if (!tissue.hyperelastic)
    throw std::invalid_argument("tissue \"" + tissue.name +
                                "\" is not hyperelastic; a specimen that sticks to its plates needs "
                                "tissue.hyperelastic, or take faces = \"smooth\"");
  if (!(strains.back() > kLeast - 1.0 && strains.back() < kMost - 1.0))
    throw std::invalid_argument("a stretch of " + detail::number_text(1.0 + strains.back()) +
                                " between the plates; allowed: " + detail::number_text(kLeast) + " to " +
                                detail::number_text(kMost));
  lab::Barrel barrel(mesh_, *tissue.hyperelastic, plates_.faces, grip(values));
  UniaxialPath path(tissue);
  path.start(0.0);
  std::vector<double> factors;
  for (const double strain : strains) {
    const UniaxialState state = path.at(1.0 + strain);
    if (!state.converged || !(state.stress * strain > 0.0))
      throw std::runtime_error("the homogeneous specimen does not resist");
    const double force = barrel.press(-strain * plates_.height, std::abs(state.stress));
    factors.push_back(force / (-state.stress * area_of(plates_)));
  }
  return factors;
}

MonotoneCubic<double> BarrelModel::factor(std::span<const double> values, double contact) const {
  const double pressed = std::max(pressed_ - contact, 0.0) / plates_.height,
               pulled = std::max(pulled_ - contact, 0.0) / plates_.height;
  std::vector<double> places, factors;
  if (pressed > 0.0) {
    places = places_of_factor(-pressed);
    factors = factors_at(places, values);
    std::reverse(places.begin(), places.end()), std::reverse(factors.begin(), factors.end());
  }
  if (pulled > 0.0) {
    const std::vector<double> more = places_of_factor(pulled), of_more = factors_at(more, values);
    places.insert(places.end(), more.begin(), more.end());
    factors.insert(factors.end(), of_more.begin(), of_more.end());
  }
  if (places.empty()) throw std::invalid_argument("no curve presses or pulls the specimen; check the contact");
  return {std::move(places), std::move(factors)};
}

/// The homogeneous specimen is loaded with less, by φ at the strain that it then has.
Prediction BarrelModel::crept(std::size_t index, std::span<const double> values, double contact,
                              const MonotoneCubic<double>& factor) const {
  Curve less = curve(index);
  const double outward = less.measurement.outward();
  const std::vector<double> rest = of_tissue(values);
  std::vector<double> way = less.force;
  for (int round = 0; round < kMostRounds; ++round) {
    for (std::size_t i = 0; i < way.size(); ++i)
      less.displacement[i] = curve(index).displacement[i] / factor.at(outward * way[i] / plates_.height);
    const SpecimenModel model({less}, {area_of(plates_), plates_.height, plates_.radius}, tissue_);
    Prediction next = model.predict_from(0, rest, 0.0);
    if (next.force.empty()) return next;
    double change = 0.0;
    for (std::size_t i = 0; i < way.size(); ++i) change = std::max(change, std::abs(next.force[i] - way[i]));
    way = next.force;
    if (change > kAlike * plates_.height) continue;
    for (double& d : next.force) d += contact;
    return next;
  }
  return {{}, "curve \"" + curve(index).name + "\": no strain under its load was found between bonded faces"};
}

Prediction BarrelModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  if (!goes_along(curve(index))) return homogeneous_.predict_from(index, of_tissue(values), contact);
  const std::shared_ptr<Known> k = known(values, contact);
  std::call_once(k->once, [&] {
    try {
      k->factor = factor(values, contact);
    } catch (const std::exception& error) {
      k->failure = error.what();
    }
  });
  if (!k->factor) return {{}, k->failure};
  if (curve(index).measurement.loaded()) return crept(index, values, contact, *k->factor);
  Prediction result = homogeneous_.predict_from(index, of_tissue(values), contact);
  const double outward = curve(index).measurement.outward();
  for (std::size_t i = 0; i < result.force.size(); ++i) {
    const double strain = outward * (curve(index).displacement[i] - contact) / plates_.height;
    result.force[i] *= k->factor->at(strain);
  }
  return result;
}

}  // namespace glisson::fit
