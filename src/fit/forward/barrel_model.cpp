#include "fit/forward/barrel_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "material/uniaxial_path.h"

namespace glisson::fit {
namespace {

constexpr double kFirst = 0.005;        ///< strain of the first place of φ
constexpr double kBetween = 0.075;      ///< between the others, of ln λ
constexpr std::size_t kMostKnown = 64;  ///< functions φ that are kept

double area_of(const Plates& plates) { return std::numbers::pi * plates.radius * plates.radius; }

/// Strains up to the largest, evenly spaced in ln λ.
std::vector<double> places_of_factor(double largest) {
  std::vector<double> strains{std::min(kFirst, largest)};
  const double most = -std::log1p(-largest);
  const int count = static_cast<int>(std::ceil(most / kBetween));
  for (int k = 1; k <= count; ++k) {
    const double strain = -std::expm1(-most * k / count);
    if (strain > 2.0 * kFirst) strains.push_back(strain);
  }
  return strains;
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
                         std::vector<std::string> keys, const BarrelGrid& grid)
    : MotionModel(curves), plates_(plates), tissue_(tissue), keys_(std::move(keys)),
      homogeneous_(std::move(curves), {area_of(plates), plates.height}, std::move(tissue)),
      mesh_(std::make_shared<BarrelMesh>(plates.radius, plates.height, grid)) {
  for (std::size_t c = 0; c < this->curves(); ++c) {
    for (const double d : curve(c).displacement) farthest_ = std::max(farthest_, d);
  }
}

std::vector<double> BarrelModel::of_tissue(std::span<const double> values) const {
  std::vector<double> rest;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!is_plate_key(keys_[i])) rest.push_back(values[i]);
  }
  return rest;
}

Grip BarrelModel::grip(std::span<const double> values) const {
  Grip g = plates_.grip;
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

MonotoneCubic<double> BarrelModel::factor(std::span<const double> values, double contact) const {
  Tissue tissue = tissue_(of_tissue(values));
  tissue.viscosity = 0.0, tissue.maxwell.clear();
  if (!tissue.hyperelastic)
    throw std::invalid_argument("tissue \"" + tissue.name +
                                "\" is not hyperelastic; a specimen that sticks to its plates needs "
                                "tissue.hyperelastic, or take faces = \"smooth\"");
  Barrel barrel(mesh_, *tissue.hyperelastic, plates_.faces, grip(values));
  UniaxialPath path(tissue);
  path.start(0.0);
  const double largest = (farthest_ - contact) / plates_.height;
  if (!(largest > 0.0 && largest < 0.95))
    throw std::invalid_argument("a strain of " + std::to_string(largest) + " between the plates; allowed: 0 to 0.95");
  std::vector<double> strains = places_of_factor(largest), factors;
  for (const double strain : strains) {
    const UniaxialState state = path.at(1.0 - strain);
    if (!state.converged || !(state.stress < 0.0)) throw std::runtime_error("the homogeneous specimen does not resist");
    factors.push_back(barrel.press(strain * plates_.height, -state.stress) / (-state.stress * area_of(plates_)));
  }
  return {std::move(strains), std::move(factors)};
}

Prediction BarrelModel::predict_from(std::size_t index, std::span<const double> values, double contact) const {
  const std::shared_ptr<Known> k = known(values, contact);
  std::call_once(k->once, [&] {
    try {
      k->factor = factor(values, contact);
    } catch (const std::exception& error) {
      k->failure = error.what();
    }
  });
  if (!k->factor) return {{}, k->failure};
  Prediction result = homogeneous_.predict_from(index, of_tissue(values), contact);
  for (std::size_t i = 0; i < result.force.size(); ++i) {
    const double strain = (curve(index).displacement[i] - contact) / plates_.height;
    result.force[i] *= k->factor->at(strain);
  }
  return result;
}

}  // namespace glisson::fit
