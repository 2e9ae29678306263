#include "fit/forward/barrel.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace glisson::fit {
namespace {

constexpr double kSlip = 0.02;     ///< spread at which friction is 0.7 of its most, over that on smooth plates
constexpr double kSoft = 0.001;    ///< of the height: how far the side enters the plate under the mean pressure
constexpr double kSettled = 1e-8;  ///< last step of Newton's method, over the height
constexpr int kMostIterations = 15, kMostHalvings = 20;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

Barrel::Barrel(std::shared_ptr<const BarrelMesh> mesh, const HyperelasticLaw& law, Faces faces, Grip grip)
    : mesh_(std::move(mesh)), law_(law), faces_(faces), grip_(grip), pressures_(mesh_->elements.size()),
      force_(2 * mesh_->columns() * mesh_->rows()), tangent_(force_.size(), 4 * mesh_->rows() + 5) {
  state_.u.assign(force_.size(), 0.0);
  state_.pressures.assign(mesh_->elements.size(), {});
  past_ = {state_};
}

/// Along the secant of the last two states.
Barrel::State Barrel::predicted(double displacement) const {
  State next = past_.back();
  next.displacement = displacement;
  if (past_.size() < 2) return next;
  const State &last = past_.back(), &before = past_[past_.size() - 2];
  const double ahead = (displacement - last.displacement) / (last.displacement - before.displacement);
  next.spread += ahead * (last.spread - before.spread);
  for (std::size_t k = 0; k < next.u.size(); ++k) next.u[k] += ahead * (last.u[k] - before.u[k]);
  for (std::size_t e = 0; e < next.pressures.size(); ++e)
    for (std::size_t a = 0; a < 3; ++a) next.pressures[e][a] += ahead * (last.pressures[e][a] - before.pressures[e][a]);
  return next;
}

void Barrel::put_on_plates() {
  for (std::size_t c = 0; c < mesh_->columns(); ++c) {
    state_.u[2 * face_vertex(c)] = state_.spread * mesh_->radii[c];
    state_.u[2 * face_vertex(c) + 1] = -0.5 * state_.displacement;
  }
}

/// False where an element is folded.
bool Barrel::assemble() {
  std::fill(force_.begin(), force_.end(), 0.0);
  tangent_.clear();
  for (std::size_t index = 0; index < mesh_->elements.size(); ++index) {
    const BarrelElement& e = mesh_->elements[index];
    const auto dof = [&](std::size_t i) { return 2 * e.vertices[i / 2] + i % 2; };
    BarrelElement::Vector u;
    for (std::size_t i = 0; i < u.size(); ++i) u[i] = state_.u[dof(i)];
    const BarrelElement::Answer a = e.answer(law_, u, state_.pressures[index]);
    if (a.folded) return false;
    pressures_[index] = a.pressure;
    for (std::size_t i = 0; i < u.size(); ++i) {
      force_[dof(i)] += a.force[i];
      for (std::size_t k = 0; k < u.size(); ++k) tangent_(dof(i), dof(k)) += a.tangent[i][k];
    }
  }
  if (leans_) lean();
  return true;
}

/// The side on the plate: a pressure that grows with the depth, linearly after a short parabola.
void Barrel::lean() {
  const std::vector<double>& z = mesh_->heights;
  const double plate = 0.5 * (mesh_->height - state_.displacement), soft = kSoft * mesh_->height;
  const double stiffness = 2.0 * std::numbers::pi * mesh_->radii.back() * (shear_modulus(law_) + pressure_) / soft;
  side_force_ = 0.0;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    const std::size_t dof = 2 * ((mesh_->columns() - 1) * mesh_->rows() + k) + 1;
    const double depth = z[k] + state_.u[dof] - plate;
    if (!(depth > 0.0)) continue;
    const double here = stiffness * 0.5 * (z[k + 1] - (k > 0 ? z[k - 1] : z[k]));
    const double force = here * (depth < soft ? 0.5 * depth * depth / soft : depth - 0.5 * soft);
    side_force_ += force;
    force_[dof] += force;
    tangent_(dof, dof) += here * std::min(1.0, depth / soft);
  }
}

double Barrel::face_force() const {
  double total = 0.0;
  for (std::size_t c = 0; c < mesh_->columns(); ++c) total -= force_[2 * face_vertex(c) + 1];
  return total;
}

Barrel::Balance Barrel::face_balance() const {
  Balance face{.by_u = std::vector<double>(force_.size(), 0.0)};
  for (std::size_t c = 0; c < mesh_->columns(); ++c) {
    face.rest += mesh_->radii[c] * force_[2 * face_vertex(c)];
    tangent_.add_row(2 * face_vertex(c), mesh_->radii[c], face.by_u);
  }
  for (std::size_t c = 0; c < mesh_->columns(); ++c) face.by_spread += mesh_->radii[c] * face.by_u[2 * face_vertex(c)];
  return face;
}

void Barrel::add_friction(Balance& face) const {
  const double free = 1.0 / std::sqrt(1.0 - state_.displacement / mesh_->height) - 1.0, width = kSlip * free;
  const double x = state_.spread / width, root = std::sqrt(1.0 + x * x);
  const double radius = mesh_->radii.back(), arm = 2.0 / 3.0 * radius;
  const double most = arm * (grip_.adhesion * std::numbers::pi * radius * radius + grip_.friction * face_force());
  face.rest += most * x / root;
  face.by_spread += most / (root * root * root * width);
  std::vector<double> by_u(force_.size(), 0.0);
  for (std::size_t c = 0; c < mesh_->columns(); ++c)
    tangent_.add_row(2 * face_vertex(c) + 1, -arm * grip_.friction * x / root, by_u);
  for (std::size_t c = 0; c < mesh_->columns(); ++c) face.by_spread += mesh_->radii[c] * by_u[2 * face_vertex(c)];
  for (std::size_t k = 0; k < by_u.size(); ++k) face.by_u[k] += by_u[k];
}

/// The step that Newton's method takes off u and, as its result, off s: a band, bordered by the face's balance.
double Barrel::solve_step(Balance& face, std::vector<double>& step) {
  std::vector<double> lead(force_.size(), 0.0);  // ∂(∂W/∂u)/∂s
  for (std::size_t c = 0; c < mesh_->columns(); ++c)
    tangent_.add_row(2 * face_vertex(c), mesh_->radii[c], lead);  // symmetric: a row is a column
  step = force_;
  const auto hold = [&](std::size_t dof) { step[dof] = lead[dof] = face.by_u[dof] = 0.0, tangent_.fix(dof); };
  for (std::size_t k = 0; k < mesh_->rows(); ++k) hold(2 * k);  // the axis
  for (std::size_t c = 0; c < mesh_->columns(); ++c) {
    hold(2 * c * mesh_->rows() + 1);  // mid-height
    hold(2 * face_vertex(c)), hold(2 * face_vertex(c) + 1);
  }
  if (!tangent_.factor()) return std::numeric_limits<double>::quiet_NaN();
  tangent_.solve(step);
  if (faces_ == Faces::bonded) return 0.0;
  tangent_.solve(lead);
  const double less = (face.rest - dot(face.by_u, step)) / (face.by_spread - dot(face.by_u, lead));
  for (std::size_t k = 0; k < step.size(); ++k) step[k] -= less * lead[k];
  for (std::size_t c = 0; c < mesh_->columns(); ++c) step[2 * face_vertex(c)] = less * mesh_->radii[c];
  return less;
}

/// Displacements, and pressures by their derivatives.
void Barrel::take_step(const std::vector<double>& step) {
  for (std::size_t k = 0; k < step.size(); ++k) state_.u[k] -= step[k];
  for (std::size_t index = 0; index < pressures_.size(); ++index) {
    const BarrelElement& e = mesh_->elements[index];
    for (std::size_t a = 0; a < 3; ++a) {
      double& p = state_.pressures[index][a];
      p = pressures_[index].value[a];
      for (std::size_t i = 0; i < BarrelElement::kUnknowns; ++i)
        p -= pressures_[index].by_u[a][i] * step[2 * e.vertices[i / 2] + i % 2];
    }
  }
}

bool Barrel::converge() {
  for (int i = 0; i < kMostIterations; ++i) {
    put_on_plates();
    if (!assemble()) return false;
    Balance face = face_balance();
    if (faces_ == Faces::friction) add_friction(face);
    std::vector<double> step;
    state_.spread -= solve_step(face, step);
    take_step(step);
    double most = 0.0;
    for (const double x : step) most = std::max(most, std::abs(x));
    if (!(most < mesh_->height) || !std::isfinite(state_.spread)) return false;
    if (most < kSettled * mesh_->height) return assemble();
  }
  return false;
}

double Barrel::press(double displacement, double pressure) {
  pressure_ = pressure;
  double to = displacement;
  for (int halvings = 0; past_.back().displacement < displacement;) {
    const double from = past_.back().displacement;
    state_ = predicted(to);
    if (converge()) {
      past_.push_back(state_);
      if (past_.size() > 2) past_.erase(past_.begin());
      to = displacement;
    } else if (++halvings <= kMostHalvings) {
      to = 0.5 * (from + to);
    } else {
      throw std::runtime_error("no equilibrium between the plates beyond a strain of " +
                               std::to_string(from / mesh_->height));
    }
  }
  return face_force() + side_force_;
}

}  // namespace glisson::fit
