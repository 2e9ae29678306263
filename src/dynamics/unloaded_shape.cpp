// unloaded_shape.cpp — the search for the shape at rest of a loaded body.
//
//   share of the loads 1, else up from 0 in parts
//     └▶ trial X ─▶ body on X ─▶ forces r at x ─▶ g = −F⁻¹ K⁻¹ r ─▶ Newton–Krylov on g(X) = 0 ─▶ next X
//
// K⁻¹ r is where the body would go from x, −F⁻¹ of it what would have to change at rest: near enough to the answer for slopes of g to be
// near −1 in all directions. They are taken as differences between two bodies, so that whatever acts on a body is in them.
#include "glisson/simulation/unloaded_shape.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/text.h"
#include "dynamics/schemes/implicit_scheme.h"
#include "dynamics/simulation_parts.h"
#include "dynamics/solvers/krylov.h"

namespace glisson {
namespace {

constexpr double kLeastVolume = 0.25;   ///< of a tet's: a step leaves it at least so much …
constexpr int kMostHalvings = 12;       ///< … or becomes shorter, so often
constexpr double kForcing = 0.03;       ///< accuracy of the linear solve of an iteration
constexpr int kMostSolve = 20;          ///< its iterations, of two bodies each
constexpr double kDifference = 1e-7;    ///< of the body's size: the largest shift of a vertex that slopes are taken by
constexpr double kFirstAdvance = 0.25;  ///< of the share of the loads, where all at once are too much

double volume_of(const TetMesh& mesh) {
  double sum = 0.0;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) sum += six_rest_volume(mesh, t) / 6.0;
  return sum;
}

double largest(std::span<const Vec3d> field) {
  double most = 0.0;
  for (const Vec3d& x : field) most = std::max(most, dot(x, x));
  return std::sqrt(most);
}

/// A body at rest in a trial shape, with everything that acts on it.
struct TrialBody {
  TrialBody(Simulation made) : simulation(std::make_unique<Simulation>(std::move(made))) {
    scheme = dynamic_cast<StaticScheme*>(&SimulationParts::scheme(*simulation));
    if (scheme == nullptr) {
      throw std::invalid_argument("find_unloaded_shape: the body has another integrator than quasi_static");
    }
  }
  std::unique_ptr<Simulation> simulation;
  StaticScheme* scheme;
};

class UnloadedSearch {
 public:
  UnloadedSearch(const TetMesh& loaded, const LoadedBody& body, const UnloadedOptions& options);
  UnloadedShape find();

 private:
  using Field = Eigen::VectorXd;  ///< 3 numbers per vertex
  TrialBody trial() const;
  bool find_at(double share);
  bool step_to(const std::vector<Vec3d>& next);
  bool go_along(const Field& direction, double before);
  bool measure();
  void take_pivot();
  Field direction();
  void find_in_parts();
  [[noreturn]] void fail(double share) const;
  std::vector<Vec3d> ahead(double share, double advance) const;

  const LoadedBody& body_;
  UnloadedOptions options_;
  const std::vector<Vec3d>& loaded_;
  TetMesh mesh_;                           ///< at rest in the trial shape
  std::vector<ElementRest> gradients_;     ///< of the loaded body's tets
  double size_ = 0.0, share_ = 1.0;        ///< of the body [m]; of the loads
  std::optional<TrialBody> here_, pivot_;  ///< on the trial shape; the one whose tangent serves
  std::vector<Mat3d> back_;                ///< F⁻¹ around each vertex, of the pivot
  std::vector<char> held_;                 ///< per component
  Field shift_;                            ///< g of here_ [m]
  std::vector<Vec3d> shape_, slope_;       ///< the last one found, and its change over that of the share [m]
  std::string why_;                        ///< the last search ended
  UnloadedFigures figures_;
};

UnloadedSearch::UnloadedSearch(const TetMesh& loaded, const LoadedBody& body, const UnloadedOptions& options)
    : body_(body), options_(options), loaded_(loaded.vertices), mesh_(loaded), shape_(loaded.vertices) {
  const auto [low, high] = box_of(loaded);
  size_ = norm(high - low);
  for (const Tet& t : loaded.tets) {
    gradients_.push_back(element_rest({loaded_[t[0]], loaded_[t[1]], loaded_[t[2]], loaded_[t[3]]}));
  }
}

TrialBody UnloadedSearch::trial() const { return TrialBody(body_(mesh_, share_)); }

/// F⁻¹ = ∂X/∂x around each vertex, weighted by volume.
std::vector<Mat3d> inverse_gradients(const TetMesh& rest, const std::vector<ElementRest>& loaded) {
  std::vector<Mat3d> sum(rest.vertices.size());
  std::vector<double> weight(rest.vertices.size(), 0.0);
  for (std::size_t t = 0; t < loaded.size(); ++t) {
    const Tet& corners = rest.tets[t];
    const Vec3d& x = rest.vertices[corners[0]];
    const Mat3d gradient = displacement_gradient<double>(
        loaded[t].s, {rest.vertices[corners[1]] - x, rest.vertices[corners[2]] - x, rest.vertices[corners[3]] - x});
    for (const std::uint32_t v : corners) {
      weight[v] += loaded[t].volume;
      for (std::size_t i = 0; i < 9; ++i) sum[v](i / 3, i % 3) += loaded[t].volume * gradient(i / 3, i % 3);
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) {
    if (!(weight[v] > 0.0)) sum[v] = identity<double>(), weight[v] = 1.0;
    for (std::size_t i = 0; i < 9; ++i) sum[v](i / 3, i % 3) /= weight[v];
  }
  return sum;
}

/// Takes the tangent of here_ for what follows.
void UnloadedSearch::take_pivot() {
  pivot_ = std::move(here_);
  here_.reset();
  pivot_->scheme->linearise();
  held_ = pivot_->scheme->held_components();
  back_ = inverse_gradients(mesh_, gradients_);
}

/// Builds the body on mesh_, and finds what would have to change of it. @return whether it is finite
bool UnloadedSearch::measure() {
  here_.emplace(trial());
  ++figures_.iterations;
  std::vector<Vec3d> u(loaded_.size()), moved;
  for (std::size_t v = 0; v < u.size(); ++v) u[v] = loaded_[v] - mesh_.vertices[v];
  const Imbalance out = here_->scheme->imbalance_at(u);
  if (!std::isfinite(out.residual)) return false;
  if (!pivot_) {
    if (const std::string free = here_->scheme->free_motion(); !free.empty()) {
      throw std::invalid_argument(free + ", by [[fixed]] or by springs of [[load]]");
    }
    const std::vector<Vec3d> forces(out.forces.begin(), out.forces.end());
    take_pivot();
    if (!pivot_->scheme->respond(forces, moved)) return false;
  } else if (!pivot_->scheme->respond(out.forces, moved)) {
    return false;
  }
  shift_.resize(static_cast<Eigen::Index>(3 * u.size()));
  figures_.off = largest(moved);
  for (std::size_t v = 0; v < u.size(); ++v) {
    const Vec3d back = back_[v] * moved[v];
    for (std::size_t i = 0; i < 3; ++i)
      shift_[static_cast<Eigen::Index>(3 * v + i)] = held_[3 * v + i] ? 0.0 : -back[i];
  }
  return true;
}

/// Newton's direction: the p with ∂g/∂X p = −g.
UnloadedSearch::Field UnloadedSearch::direction() {
  const std::vector<Vec3d> from = mesh_.vertices;
  const Field here = shift_;
  const double off = figures_.off;
  const auto slope = [&](const Field& p, Field& y) {
    const double length = p.lpNorm<Eigen::Infinity>(), part = length > 0.0 ? kDifference * size_ / length : 0.0;
    flat(std::span<Vec3d>(mesh_.vertices)) = flat(std::span<const Vec3d>(from)) + part * p;
    y = measure() && part > 0.0 ? Field((here - shift_) / part) : Field::Zero(p.size());
  };
  const auto as_it_is = [](const Field& r, Field& z) { z = r; };
  Field p;
  const KrylovResult solved = bicgstab(slope, as_it_is, here, kForcing, kMostSolve, p);
  mesh_.vertices = from, shift_ = here, figures_.off = off;
  return solved.iterations > 0 && p.allFinite() ? p : here;
}

/// Takes trial places at rest, as far as no tet loses too much of its volume. @return whether any of the step was left
bool UnloadedSearch::step_to(const std::vector<Vec3d>& next) {
  const std::vector<Vec3d> from = mesh_.vertices;
  std::vector<double> before(mesh_.tets.size());
  for (std::size_t t = 0; t < before.size(); ++t) before[t] = six_rest_volume(mesh_, t);
  double part = 1.0;
  for (int i = 0; i < kMostHalvings; ++i, part *= 0.5) {
    for (std::size_t v = 0; v < next.size(); ++v) mesh_.vertices[v] = from[v] + (next[v] - from[v]) * part;
    std::size_t t = 0;
    while (t < before.size() && six_rest_volume(mesh_, t) >= kLeastVolume * before[t]) ++t;
    if (t == before.size()) return true;
  }
  mesh_.vertices = from;
  return false;
}

/// Goes along a direction as far as g becomes less. @param before  its norm
bool UnloadedSearch::go_along(const Field& direction, double before) {
  const std::vector<Vec3d> from = mesh_.vertices;
  why_ = "tets of the unloaded shape turn inside out";
  double part = 1.0;
  for (int i = 0; i < kMostHalvings; ++i, part *= 0.5) {
    std::vector<Vec3d> next = from;
    flat(std::span<Vec3d>(next)) += part * direction;
    mesh_.vertices = from;
    if (!step_to(next)) continue;
    if (measure() && shift_.norm() <= (1.0 - 1e-4 * part) * before) return true;
    why_ = "the search comes no nearer";
  }
  mesh_.vertices = from;
  return false;
}

/// Searches from mesh_ on. @return whether it was found: it is in mesh_ then
bool UnloadedSearch::find_at(double share) {
  share_ = share;
  pivot_.reset();
  why_ = "a force is not finite";
  if (!measure()) return false;
  for (int i = 0; i < options_.most_iterations; ++i) {
    if (figures_.off <= options_.tolerance * size_) {
      why_ = "the equilibrium is not stable";
      return (here_ ? here_ : pivot_)->scheme->is_stable();
    }
    if (!go_along(direction(), shift_.norm())) return false;
    take_pivot();
    if (!measure()) return false;
  }
  why_ = "the search does not end within " + std::to_string(options_.most_iterations) + " iterations";
  return false;
}

/// Where the shape is to be looked for when the share goes on.
std::vector<Vec3d> UnloadedSearch::ahead(double share, double advance) const {
  std::vector<Vec3d> next = shape_;
  if (share > 0.0) {
    for (std::size_t v = 0; v < next.size(); ++v) next[v] += slope_[v] * advance;
  }
  return next;
}

void UnloadedSearch::find_in_parts() {
  double share = 0.0, advance = kFirstAdvance;
  slope_.assign(shape_.size(), Vec3d{});
  mesh_.vertices = shape_;
  if (!find_at(0.0)) fail(0.0);
  shape_ = mesh_.vertices;
  while (share < 1.0) {
    const double next = std::min(1.0, share + advance);
    mesh_.vertices = shape_;
    if (!step_to(ahead(share, next - share)) || !find_at(next)) {
      advance *= 0.5;
      if (advance < options_.least_advance) fail(share);
      continue;
    }
    for (std::size_t v = 0; v < shape_.size(); ++v) {
      slope_[v] = (mesh_.vertices[v] - shape_[v]) * (1.0 / (next - share));
    }
    shape_ = mesh_.vertices;
    share = next;
  }
}

void UnloadedSearch::fail(double share) const {
  throw NoUnloadedShape("no unloaded shape was found beyond " + detail::number_text(100.0 * share, 3) +
                            " % of gravity and loads: " + why_ +
                            ". The body is too soft, too tall or too little supported for what acts on it: it cannot "
                            "be at rest in this shape. "
                            "Ways out: stiffer tissue (youngs_modulus_Pa), more that holds it ([[fixed]], springs of "
                            "[[load]]), less load, or "
                            "start = \"rest\", which takes the shape as that without loads",
                        share);
}

UnloadedShape UnloadedSearch::find() {
  if (!find_at(1.0)) find_in_parts();
  UnloadedShape found{mesh_.vertices, figures_};
  for (std::size_t v = 0; v < loaded_.size(); ++v) {
    found.figures.largest_shift = std::max(found.figures.largest_shift, norm(loaded_[v] - mesh_.vertices[v]));
  }
  found.figures.unloaded_volume = volume_of(mesh_);
  mesh_.vertices = loaded_;
  found.figures.volume = volume_of(mesh_);
  return found;
}

}  // namespace

UnloadedShape find_unloaded_shape(const TetMesh& loaded, const LoadedBody& body, const UnloadedOptions& options) {
  if (!(options.tolerance > 0.0) || options.most_iterations < 1 || !(options.least_advance > 0.0)) {
    throw std::invalid_argument(
        "find_unloaded_shape: tolerance and least_advance have to be above 0, and most_iterations at least 1");
  }
  return UnloadedSearch(loaded, body, options).find();
}

}  // namespace glisson
