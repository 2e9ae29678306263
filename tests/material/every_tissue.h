// every_tissue.h — one tissue for each law, kinematics, form, measure, viscosity and branch there is.
//
// Laws come from support/law_examples.h; where an enumerator is missing, the compiler warns of the switches below.
#pragma once

#include <Eigen/Dense>
#include <random>
#include <string>
#include <vector>

#include "glisson/material/tissue.h"
#include "material/reference/reference_stress.h"
#include "material/response.h"
#include "support/law_examples.h"

namespace glisson::test {

inline std::string name_of(Kinematics k) {
  switch (k) {
    case Kinematics::small:
      return "small";
    case Kinematics::corotational:
      return "corotational";
    case Kinematics::green:
      return "green";
  }
  return {};
}
inline std::string name_of(LawForm f) {
  switch (f) {
    case LawForm::secant:
      return "secant";
    case LawForm::energy:
      return "energy";
  }
  return {};
}
inline std::string name_of(DeformationMeasure m) {
  switch (m) {
    case DeformationMeasure::equivalent_shear_strain:
      return "equivalent_shear_strain";
    case DeformationMeasure::one_minus_q:
      return "one_minus_q";
    case DeformationMeasure::regular_mean_ratio:
      return "regular_mean_ratio";
    case DeformationMeasure::radius_ratio:
      return "radius_ratio";
    case DeformationMeasure::solid_angle:
      return "solid_angle";
  }
  return {};
}

inline std::string name_of(ViscousTensor v) {
  switch (v) {
    case ViscousTensor::shear:
      return "shear";
    case ViscousTensor::deviatoric:
      return "deviatoric";
    case ViscousTensor::proportional:
      return "proportional";
    case ViscousTensor::pioletti:
      return "pioletti";
  }
  return {};
}

/// Every enumerator that has a name.
template <class Enum>
std::vector<Enum> all_of() {
  std::vector<Enum> all;
  for (int i = 0; !name_of(static_cast<Enum>(i)).empty(); ++i) all.push_back(static_cast<Enum>(i));
  return all;
}

inline bool is_small(const Tissue& t) { return !t.hyperelastic && t.kinematics == Kinematics::small; }

/// A law that stiffens as the tetrahedron deforms; the raw mean ratio falls then.
inline StiffnessLaw stiffening_law(DeformationMeasure m) {
  if (m == DeformationMeasure::regular_mean_ratio) return LinearLaw{-2500.0};
  return ExponentialLaw{.amplitude = 800.0, .rate = 3.0};
}

inline std::vector<Tissue> tensor_mass_tissues() {
  std::vector<Tissue> all;
  const auto add = [&](Kinematics k, LawForm f, DeformationMeasure m, const StiffnessLaw& law) {
    Tissue t;
    t.youngs_modulus = kExampleModulus, t.poisson_ratio = 0.4;
    t.kinematics = k, t.law_form = f, t.measure = m, t.law = law;
    t.name = name_of(k) + " " + name_of(f) + " " + name_of(m) + " " + std::string(law_name(law));
    all.push_back(t);
  };
  for (const Kinematics k : all_of<Kinematics>()) {
    for (const LawForm f : all_of<LawForm>()) {
      for (const DeformationMeasure m : all_of<DeformationMeasure>()) add(k, f, m, stiffening_law(m));
      for (const StiffnessLaw& law : every_stiffness_law()) add(k, f, DeformationMeasure::equivalent_shear_strain, law);
      add(k, f, DeformationMeasure::equivalent_shear_strain, ConstantLaw{});
      all.back().mu_law = LinearLaw{2500.0};
      if (f == LawForm::energy) all.back().lambda_law = ExponentialLaw{500.0, 2.0};
      all.back().name += " lambda mu";
    }
  }
  return all;
}

inline std::vector<Tissue> hyperelastic_tissues() {
  std::vector<Tissue> all;
  for (const HyperelasticLaw& law : every_hyperelastic_law()) {
    Tissue t;
    t.hyperelastic = law;
    t.name = std::string(law_name(law));
    if (const auto* o = std::get_if<Ogden>(&law)) t.name += " " + std::to_string(o->mu.size());
    if (const auto* i = std::get_if<Invariants>(&law)) {
      t.name += i->a2 == 0.0 ? " polynomial" : (i->c10 == 0.0 ? " second" : " all");
    }
    all.push_back(t);
  }
  return all;
}

/// One tissue of each way to carry stress: the three kinematics and a hyperelastic law.
inline std::vector<Tissue> carriers() {
  std::vector<Tissue> all;
  for (const Kinematics k : all_of<Kinematics>()) {
    Tissue t;
    t.youngs_modulus = 3000.0, t.kinematics = k, t.law_form = LawForm::energy;
    t.law = LinearLaw{4000.0};
    t.name = name_of(k);
    all.push_back(t);
  }
  all.push_back(hyperelastic_tissues().front());
  return all;
}

inline std::vector<Tissue> fibre_tissues() {
  std::vector<Tissue> all = carriers();
  for (Tissue& t : all) t.fibres = Fibres{{1.0, 2.0, -0.5}, 5000.0}, t.name += " fibres";
  return all;
}

inline std::vector<Tissue> viscous_tissues() {
  std::vector<Tissue> all;
  for (const ViscousTensor v : all_of<ViscousTensor>()) {
    for (Tissue t : carriers()) {
      if (v == ViscousTensor::pioletti && is_small(t)) continue;  // refused
      t.viscosity = 700.0, t.viscous_tensor = v;
      t.name += " viscous " + name_of(v);
      all.push_back(t);
    }
  }
  return all;
}

inline std::vector<Tissue> maxwell_tissues() {
  std::vector<Tissue> all;
  for (const MaxwellPart part : {MaxwellPart::deviator, MaxwellPart::all}) {
    for (Tissue t : carriers()) {
      t.maxwell = {{0.45, 0.5}, {0.365, 50.0}}, t.maxwell_part = part;
      t.name += part == MaxwellPart::all ? " maxwell all" : " maxwell deviator";
      all.push_back(t);
      t.maxwell[0].time_law = ExponentialTime{.rate = -4.0, .least = 0.02};
      t.maxwell[1] = {
          .share = 0.365, .time = 0.2, .time_law = PowerTime{.exponent = 1.5, .reference = 0.3, .least = 0.01}};
      if (part == MaxwellPart::all) t.measure = DeformationMeasure::one_minus_q;
      t.name += " following";
      all.push_back(t);
    }
  }
  return all;
}

/// All of them.
inline std::vector<Tissue> every_tissue() {
  std::vector<Tissue> all = tensor_mass_tissues();
  for (const auto& more : {hyperelastic_tissues(), fibre_tissues(), viscous_tissues(), maxwell_tissues()}) {
    all.insert(all.end(), more.begin(), more.end());
  }
  return all;
}

/// Whether the measure tells directions of the tetrahedron apart.
inline bool has_directions(const Tissue& t) {
  return !t.hyperelastic && t.measure != DeformationMeasure::equivalent_shear_strain &&
         t.measure != DeformationMeasure::one_minus_q;
}
/// Whether P is the gradient of Response::energy.
/// Tissues whose volume change is shared with the neighbours.
inline std::vector<Tissue> nodal_tissues() {
  std::vector<Tissue> all = carriers();
  for (const Tissue& t : fibre_tissues()) all.push_back(t);
  for (const Tissue& t : maxwell_tissues()) all.push_back(t);
  for (Tissue& t : all) {
    t.volume_change = VolumeChange::average_nodal;
    t.law = ConstantLaw{}, t.law_form = LawForm::secant;
    t.poisson_ratio = 0.45;
    t.name += " nodal";
  }
  return all;
}
/// Those and every tissue with a volume change of its own.
inline std::vector<Tissue> all_tissues() {
  std::vector<Tissue> all = every_tissue();
  for (const Tissue& t : nodal_tissues()) all.push_back(t);
  return all;
}

inline bool is_conservative(const Tissue& t) {
  const bool constant = std::holds_alternative<ConstantLaw>(t.law) && !t.lambda_law && !t.mu_law;
  return t.hyperelastic || t.law_form == LawForm::energy || constant;
}

inline Mat3d to_double(const reference::RealTensor& a) {
  Mat3d r;
  for (std::size_t i = 0; i < 9; ++i) {
    r(i / 3, i % 3) = static_cast<double>(a(static_cast<int>(i / 3), static_cast<int>(i % 3)));
  }
  return r;
}

/// A tetrahedron of a tissue, for the response and for the oracle.
struct Specimen {
  Response response;
  reference::MaterialPoint point;
  ElementShape shape;

  /// @param corners  at rest [m]
  Specimen(const Tissue& tissue, const std::array<Vec3d, 4>& corners) : response(tissue), point{tissue, {}} {
    for (std::size_t a = 0; a < 4; ++a) point.rest[a] = reference::RealVector(corners[a].x, corners[a].y, corners[a].z);
    EdgeMetric<double>& G = shape.metric;
    for (std::size_t a = 0; a < 4; ++a) {
      for (std::size_t b = a + 1; b < 4; ++b) {
        const Vec3d l = corners[a] - corners[b];
        G.xx += l.x * l.x, G.yy += l.y * l.y, G.zz += l.z * l.z;
        G.xy += l.x * l.y, G.yz += l.y * l.z, G.zx += l.z * l.x;
      }
    }
    shape.volume = dot(corners[1] - corners[0], cross(corners[2] - corners[0], corners[3] - corners[0])) / 6.0;
    shape.turn = to_double(reference::regular_turn(point));
    if (!tissue.fibres) return;
    shape.fibre = tissue.fibres->direction * (1.0 / norm(tissue.fibres->direction));
    point.fibre = reference::RealVector(shape.fibre.x, shape.fibre.y, shape.fibre.z).normalized();
  }
  /// A tetrahedron of no particular shape, 1 cm wide.
  explicit Specimen(const Tissue& tissue)
      : Specimen(tissue, {{{0.0, 0.0, 0.0}, {0.011, 0.001, -0.001}, {0.002, 0.009, 0.001}, {0.001, -0.002, 0.012}}}) {}

  Mat3d P(const Mat3d& H) const { return response.elastic(H, shape); }
};

inline reference::RealTensor to_real(const Mat3d& a) {
  reference::RealTensor r;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) r(i, j) = a(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }
  return r;
}
inline reference::RealTensor real_gradient(const Mat3d& H) { return to_real(H) + reference::RealTensor::Identity(); }
inline Mat3d difference(const Mat3d& a, const Mat3d& b) { return sum(a, scaled(b, -1.0)); }
inline double size_of(const Mat3d& a) { return std::sqrt(squared_norm(a)); }
/// ‖a − b‖ / ‖b‖; ‖a‖ where b is 0.
inline double apart(const Mat3d& a, const Mat3d& b) {
  const double size = size_of(b);
  return size_of(difference(a, b)) / (size > 0.0 ? size : 1.0);
}
inline double inner(const Mat3d& a, const Mat3d& b) { return trace(transposed_product(a, b)); }
inline Mat3d transposed(const Mat3d& a) { return transposed_product(a, identity<double>()); }

/// Random tensors with fixed seeds.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  /// Numbers of the normal distribution.
  Mat3d tensor(double amount) {
    Mat3d a;
    for (std::size_t i = 0; i < 9; ++i) a(i / 3, i % 3) = amount * normal_(random_);
    return a;
  }
  Mat3d rotation() {
    Eigen::Quaterniond q(normal_(random_), normal_(random_), normal_(random_), normal_(random_));
    const Eigen::Matrix3d R = q.normalized().toRotationMatrix();
    return to_double(R.cast<reference::Real>());
  }
  /// H of F = Q V with stretches from `least` to `most`.
  Mat3d stretched(double least, double most) {
    const auto l = [&] { return least * std::pow(most / least, std::uniform_real_distribution<double>()(random_)); };
    const Mat3d Q = rotation(), N = rotation();
    Mat3d D = scaled(N, 1.0);
    for (std::size_t j = 0; j < 3; ++j) {
      const double stretch = l();
      for (std::size_t i = 0; i < 3; ++i) D(i, j) *= stretch;
    }
    const Mat3d F = product(Q, product(D, transposed(N)));
    return difference(F, identity<double>());
  }

 private:
  std::mt19937 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace glisson::test
