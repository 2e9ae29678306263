#include "lab/barrel.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace glisson::lab {
namespace {

constexpr double kSlip = 0.02;     ///< spread at which friction is 0.7 of its most, over that on smooth plates
constexpr double kSoft = 0.001;    ///< of the height: how far the side enters the plate under the mean pressure
constexpr double kSettled = 1e-8;  ///< last step of Newton's method, over the height
constexpr int kMostIterations = 15, kMostHalvings = 20;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

/// Sizes of elements, each `grading` times the one before it.
std::vector<double> falling(std::size_t count, double grading) {
  std::vector<double> sizes(count, 1.0);
  for (std::size_t i = 1; i < count; ++i) sizes[i] = sizes[i - 1] * grading;
  return sizes;
}

}  // namespace

BarrelMesh::BarrelMesh(double radius, double whole_height, const BarrelGrid& grid)
    : MeridianMesh(ends_and_middles(falling(grid.radial, grid.grading), radius),
                   ends_and_middles(falling(grid.axial, grid.grading), 0.5 * whole_height)),
      height(whole_height) {}

Barrel::Barrel(std::shared_ptr<const BarrelMesh> mesh, const HyperelasticLaw& law, Faces faces, Grip grip)
    : mesh_(std::move(mesh)), solid_(mesh_, law), faces_(faces), grip_(grip) {
  state_.body = solid_.at_rest();
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
  next.body.extrapolate(last.body, before.body, ahead);
  return next;
}

void Barrel::put_on_plates() {
  for (std::size_t c = 0; c < mesh_->columns(); ++c) {
    state_.body.u[2 * face_vertex(c)] = state_.spread * mesh_->radii[c];
    state_.body.u[2 * face_vertex(c) + 1] = -0.5 * state_.displacement;
  }
}

/// False where an element is folded.
bool Barrel::assemble() {
  if (!solid_.assemble(state_.body)) return false;
  if (state_.displacement > 0.0) lean();
  return true;
}

/// The side on the plate: a pressure that grows with the depth, linearly after a short parabola.
void Barrel::lean() {
  const std::vector<double>& z = mesh_->heights;
  const double plate = 0.5 * (mesh_->height - state_.displacement), soft = kSoft * mesh_->height;
  const double stiffness =
      2.0 * std::numbers::pi * mesh_->radii.back() * (shear_modulus(solid_.law()) + pressure_) / soft;
  side_force_ = 0.0;
  for (std::size_t k = 0; k + 1 < z.size(); ++k) {
    const std::size_t dof = 2 * ((mesh_->columns() - 1) * mesh_->rows() + k) + 1;
    const double depth = z[k] + state_.body.u[dof] - plate;
    if (!(depth > 0.0)) continue;
    const double here = stiffness * 0.5 * (z[k + 1] - (k > 0 ? z[k - 1] : z[k]));
    const double force = here * (depth < soft ? 0.5 * depth * depth / soft : depth - 0.5 * soft);
    side_force_ += force;
    solid_.force[dof] += force;
    solid_.tangent(dof, dof) += here * std::min(1.0, depth / soft);
  }
}

double Barrel::face_force() const {
  double total = 0.0;
  for (std::size_t c = 0; c < mesh_->columns(); ++c) total -= solid_.force[2 * face_vertex(c) + 1];
  return total;
}

Barrel::Balance Barrel::face_balance() const {
  Balance face{.by_u = std::vector<double>(solid_.unknowns(), 0.0)};
  for (std::size_t c = 0; c < mesh_->columns(); ++c) {
    face.rest += mesh_->radii[c] * solid_.force[2 * face_vertex(c)];
    solid_.tangent.add_row(2 * face_vertex(c), mesh_->radii[c], face.by_u);
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
  std::vector<double> by_u(solid_.unknowns(), 0.0);
  for (std::size_t c = 0; c < mesh_->columns(); ++c)
    solid_.tangent.add_row(2 * face_vertex(c) + 1, -arm * grip_.friction * x / root, by_u);
  for (std::size_t c = 0; c < mesh_->columns(); ++c) face.by_spread += mesh_->radii[c] * by_u[2 * face_vertex(c)];
  for (std::size_t k = 0; k < by_u.size(); ++k) face.by_u[k] += by_u[k];
}

/// The step that Newton's method takes off u and, as its result, off s: the tangent, bordered by the face's balance.
double Barrel::solve_step(Balance& face, std::vector<double>& step) {
  std::vector<double> lead(solid_.unknowns(), 0.0);  // ∂(∂W/∂u)/∂s
  for (std::size_t c = 0; c < mesh_->columns(); ++c)
    solid_.tangent.add_row(2 * face_vertex(c), mesh_->radii[c], lead);  // symmetric: a row is a column
  step = solid_.force;
  const auto hold = [&](std::size_t dof) { step[dof] = lead[dof] = face.by_u[dof] = 0.0, solid_.tangent.fix(dof); };
  for (std::size_t k = 0; k < mesh_->rows(); ++k) hold(2 * k);  // the axis
  for (std::size_t c = 0; c < mesh_->columns(); ++c) {
    hold(2 * c * mesh_->rows() + 1);  // mid-height
    hold(2 * face_vertex(c)), hold(2 * face_vertex(c) + 1);
  }
  if (!solid_.tangent.factor()) return std::numeric_limits<double>::quiet_NaN();
  solid_.tangent.solve(step);
  if (faces_ == Faces::bonded) return 0.0;
  solid_.tangent.solve(lead);
  const double less = (face.rest - dot(face.by_u, step)) / (face.by_spread - dot(face.by_u, lead));
  for (std::size_t k = 0; k < step.size(); ++k) step[k] -= less * lead[k];
  for (std::size_t c = 0; c < mesh_->columns(); ++c) step[2 * face_vertex(c)] = less * mesh_->radii[c];
  return less;
}

bool Barrel::converge() {
  for (int i = 0; i < kMostIterations; ++i) {
    put_on_plates();
    if (!assemble()) return false;
    Balance face = face_balance();
    if (faces_ == Faces::friction) add_friction(face);
    std::vector<double> step;
    state_.spread -= solve_step(face, step);
    solid_.take(step, state_.body);
    double most = 0.0;
    for (const double x : step) most = std::max(most, std::abs(x));
    if (!(most < mesh_->height) || !std::isfinite(state_.spread)) return false;
    if (most < kSettled * mesh_->height) return assemble();
  }
  return false;
}

double Barrel::press(double displacement, double pressure) {
  if (displacement < 0.0 && faces_ == Faces::friction)
    throw std::invalid_argument("plates pull only what is bonded to them; faces of friction let go");
  pressure_ = pressure;
  double to = displacement;
  for (int halvings = 0; past_.back().displacement != displacement;) {
    const double from = past_.back().displacement;
    state_ = predicted(to);
    if (converge()) {
      past_.push_back(state_);
      if (past_.size() > 2) past_.erase(past_.begin());
      to = displacement;
    } else if (++halvings <= kMostHalvings) {
      to = 0.5 * (from + to);
    } else {
      throw std::runtime_error("no equilibrium between the plates beyond a stretch of " +
                               std::to_string(1.0 - from / mesh_->height));
    }
  }
  return face_force() + side_force_;
}

}  // namespace glisson::lab
