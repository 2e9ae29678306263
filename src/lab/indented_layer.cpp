#include "lab/indented_layer.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "base/text.h"

namespace glisson::lab {
namespace {

constexpr double kStiff = 2000.0;  ///< of the contact, over μ and the mean pressure and the contact's radius
constexpr double kStill = 1e-5;    ///< last step of Newton's method, over the depth: the next would be its square
constexpr double kFirstStride = 1.0 / 32;  ///< step of depth, over the deepest
constexpr double kSlides = 0.05;           ///< of a punch's radius: how far its edge may slide
constexpr int kMostTries = 12;             ///< of Newton's method, and of steps
constexpr int kQuick = 6;

std::string millimetres(double metres) { return detail::number_text(1e3 * metres) + " mm"; }

void require_room(const Layer& layer, const Indenter& indenter, double deepest) {
  if (!(deepest < layer.thickness))
    throw std::invalid_argument("a depth of " + millimetres(deepest) + " in a layer of " +
                                millimetres(layer.thickness) +
                                "; give the thickness of the specimen, or crop the depth");
  if (indenter.shape != IndenterShape::cone && indenter.radius > layer.radius)
    throw std::invalid_argument(words_of(indenter) + " is wider than the specimen of " + millimetres(layer.radius) +
                                " radius; plates press a [specimen] of kind = \"cylinder\"");
}

}  // namespace

IndentedLayer::IndentedLayer(const Layer& layer, const Indenter& indenter, const HyperelasticLaw& law, double deepest,
                             double fineness)
    : layer_(layer), indenter_(indenter),
      solid_((require_room(layer, indenter, deepest), layer_mesh(layer, indenter, deepest, fineness)), law),
      stride_(kFirstStride * deepest) {
  state_.body = solid_.at_rest();
  past_ = {state_};
  place_surface();
}

void IndentedLayer::place_surface() {
  constexpr std::array<double, 4> kAt{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526},
      kWeight{0.3478548451374538, 0.6521451548625461, 0.6521451548625461, 0.3478548451374538};
  const std::vector<double>& radii = solid_.mesh().radii;
  if (indenter_.sharp()) {
    const auto beyond = [&](double r) { return r > indenter_.radius * (1.0 + 1e-9); };
    under_punch_ = static_cast<std::size_t>(std::find_if(radii.begin(), radii.end(), beyond) - radii.begin());
    return;
  }
  for (std::size_t c = 0; c + 2 < radii.size(); c += 2) {
    const double from = radii[c], size = radii[c + 2] - from;
    for (std::size_t q = 0; q < kAt.size(); ++q) {
      SurfacePoint p;
      const double x = kAt[q];
      p.share = {0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)};
      for (std::size_t n = 0; n < 3; ++n) p.vertices[n] = surface_vertex(c + n);
      p.radius = from + 0.5 * (1.0 + x) * size;
      p.weight = 2.0 * std::numbers::pi * p.radius * 0.5 * size * kWeight[q];
      surface_.push_back(p);
    }
  }
}

IndentedLayer::Place IndentedLayer::place_of(const SurfacePoint& p) const {
  Place at{p.radius, solid_.mesh().heights.back()};
  for (std::size_t n = 0; n < 3; ++n) {
    at.r += p.share[n] * state_.body.u[2 * p.vertices[n]];
    at.z += p.share[n] * state_.body.u[2 * p.vertices[n] + 1];
  }
  return at;
}

/// The pressure on a point of the surface, where it has entered the indenter.
void IndentedLayer::add_contact(const SurfacePoint& p) {
  const Place at = place_of(p);
  const Entry e = entry_of(indenter_, tip(), at.r, at.z);
  if (!(e.depth > 0.0)) return;
  const double k = stiffness_ * p.weight, n = k * e.depth, side = p.sticks ? k : 0.0;
  const double fr = n * e.by_r + side * (at.r - p.radius - p.stuck), fz = n * e.by_z;
  const double rr = k * e.by_r * e.by_r + n * e.rr + side, rz = k * e.by_r * e.by_z + n * e.rz,
               zz = k * e.by_z * e.by_z + n * e.zz;
  force_ += fz;
  for (std::size_t a = 0; a < 3; ++a) {
    const std::size_t i = 2 * p.vertices[a];
    solid_.force[i] += p.share[a] * fr, solid_.force[i + 1] += p.share[a] * fz;
    for (std::size_t b = 0; b < 3; ++b) {
      const std::size_t j = 2 * p.vertices[b];
      const double both = p.share[a] * p.share[b];
      solid_.tangent(i, j) += both * rr, solid_.tangent(i, j + 1) += both * rz;
      solid_.tangent(i + 1, j) += both * rz, solid_.tangent(i + 1, j + 1) += both * zz;
    }
  }
}

/// What lies under a flat punch goes with it.
void IndentedLayer::press_down() {
  for (std::size_t c = 0; c < under_punch_; ++c) state_.body.u[2 * surface_vertex(c) + 1] = -state_.depth;
}

void IndentedLayer::touch() {
  force_ = 0.0;
  for (std::size_t c = 0; c < under_punch_; ++c) force_ -= solid_.force[2 * surface_vertex(c) + 1];
  for (const SurfacePoint& p : surface_) add_contact(p);
}

void IndentedLayer::hold_vertices() {
  const auto hold = [&](std::size_t dof) { solid_.force[dof] = 0.0, solid_.tangent.fix(dof); };
  const std::size_t rows = solid_.mesh().rows(), columns = solid_.mesh().columns();
  for (std::size_t k = 0; k < rows; ++k) hold(2 * k);  // the axis
  for (std::size_t c = 0; c < columns; ++c) {
    hold(2 * c * rows + 1);
    if (layer_.bonded_floor) hold(2 * c * rows);
  }
  for (std::size_t c = 0; c < under_punch_; ++c) {
    hold(2 * surface_vertex(c) + 1);
    if (indenter_.bonded()) hold(2 * surface_vertex(c));
  }
  for (std::size_t k = 0; layer_.wide() && k < rows; ++k) {
    hold(2 * ((columns - 1) * rows + k));
    if (layer_.thick()) hold(2 * ((columns - 1) * rows + k) + 1);
  }
}

/// Points that a bonded indenter has come to touch stay where they are.
void IndentedLayer::stick() {
  if (!indenter_.bonded()) return;
  for (SurfacePoint& p : surface_) {
    const Place at = place_of(p);
    const bool touches = entry_of(indenter_, tip(), at.r, at.z).depth > 0.0;
    if (touches && !p.sticks) p.stuck = at.r - p.radius;
    p.sticks = touches;
  }
}

bool IndentedLayer::converge() {
  for (iterations_ = 1; iterations_ <= kMostTries; ++iterations_) {
    press_down();
    if (!solid_.assemble(state_.body)) return false;
    touch();
    hold_vertices();
    std::vector<double> step = solid_.force;
    if (!solid_.tangent.factor()) return false;
    solid_.tangent.solve(step);
    solid_.take(step, state_.body);
    double most = 0.0;
    for (const double x : step) most = std::max(most, std::abs(x));
    if (!(most < solid_.mesh().radii.back())) return false;
    if (most < kStill * state_.depth) return true;
  }
  return false;
}

/// One step of depth. @return whether there is equilibrium
bool IndentedLayer::advance(double to) {
  const State& last = past_.back();
  state_ = last;
  state_.depth = to;
  if (past_.size() > 1) {
    const State& before = past_[past_.size() - 2];
    state_.body.extrapolate(last.body, before.body, (to - last.depth) / (last.depth - before.depth));
  }
  const double radius = contact_radius(indenter_, to);
  stiffness_ = kStiff * (shear_modulus(solid_.law()) + pressure_) / radius;
  if (!converge()) return false;
  pressure_ = force_ / (std::numbers::pi * radius * radius);
  stick();
  past_.push_back(state_);
  if (past_.size() > 2) past_.erase(past_.begin());
  return true;
}

void IndentedLayer::require_edge() const {
  if (under_punch_ == 0 || indenter_.bonded()) return;
  if (std::abs(state_.body.u[2 * surface_vertex(under_punch_ - 1)]) < kSlides * indenter_.radius) return;
  throw std::runtime_error("at a depth of " + millimetres(state_.depth) +
                           " tissue slides past the sharp edge of the flat punch, where strain has no bound; give "
                           "the edge_radius_mm that a real punch has, or contact = \"bonded\", in `indenter`, or crop "
                           "the depth");
}

double IndentedLayer::press(double depth) {
  for (int failures = 0; past_.back().depth < depth;) {
    const double from = past_.back().depth, left = depth - from;
    const double to = stride_ < 0.7 * left ? from + stride_ : depth;
    if (advance(to)) {
      require_edge();
      failures = 0;
      if (iterations_ <= kQuick) stride_ = 1.7 * std::max(stride_, to - from);
    } else if (++failures <= kMostTries) {
      stride_ = 0.4 * (to - from);
    } else {
      throw std::runtime_error("no equilibrium under " + words_of(indenter_) + " beyond a depth of " +
                               millimetres(from));
    }
  }
  return force_;
}

}  // namespace glisson::lab
