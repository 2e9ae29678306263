// blade_long.cpp — a blade in a long step: what its edge exerts at the end of it.
//
//   each piece   |J| ≤ G l h across the edge; within it the tissue ends the step on the edge, at it the edge slips along J
//
// Pieces move one another by W, the velocities that unit impulses give to their points within the step. The edge passes through
// many tets that share vertices, so that what vertices do to one another is asked for, and kept as long as the tangent's factor:
// pieces change with every step of a blade in motion, their vertices do not.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/two_across.h"
#include "glisson/instruments/blade.h"
#include "instruments/cutting/disc_impulses.h"

namespace glisson {
namespace {

/// Compliance of a piece over the mean of W, for the change of its force since the last step: without it pieces that nearly coincide
/// pull at each other with all that their limits allow. Where nothing moves it is without effect: tissue does not creep.
constexpr double kBond = 1e-4;

}  // namespace

/// The pieces of a long step.
struct Blade::LongPieces {
  struct Piece {
    std::size_t number = 0;                ///< among all pieces
    std::array<std::size_t, 4> corners{};  ///< in `vertices`
    std::array<double, 4> weights{};
    double most = 0.0;  ///< G l h [N s]
    Vec3d edge;         ///< velocity that would keep the point on the edge [m/s]
  };
  std::vector<Piece> pieces{};
  std::vector<std::uint32_t> vertices{};           ///< ascending
  std::vector<std::vector<VertexWeight>> means{};  ///< each vertex by itself
  std::array<Vec3d, 2> e{};                        ///< across the edge

  Eigen::Index size() const { return static_cast<Eigen::Index>(2 * pieces.size()); }
  Eigen::MatrixXd couple(StepCompliance& compliance) const;
  /// Of the point of a piece.
  template <class At>
  Vec3d mean(const InteractionStep& step, const Piece& piece, const At& at) const {
    Vec3d sum{};
    for (std::size_t c = 0; c < 4; ++c) sum += at(step.place_of[vertices[piece.corners[c]]]) * piece.weights[c];
    return sum;
  }
};

Blade::LongPieces Blade::long_pieces(const InteractionStep& step, const BladeEdge& before,
                                     const BladeEdge& after) const {
  LongPieces r;
  const Vec3d was = before.to - before.from, is = after.to - after.from;
  const Vec3d from = (after.from - before.from) * (1.0 / step.h), to = (after.to - before.to) * (1.0 / step.h);
  r.e = two_across(unit(is));
  const auto is_active = [&](std::uint32_t v) { return step.place_of[v] != InteractionStep::kNowhere; };
  for (std::size_t k = 0; k < pieces_.size(); ++k) {
    const Tet& t = vertices_of(pieces_[k]);
    if (!std::all_of(t.begin(), t.end(), is_active)) continue;
    r.pieces.push_back({.number = k,
                        .corners = {},
                        .weights = pieces_[k].weights,
                        .most = options_.toughness * pieces_[k].length * step.h,
                        .edge = {}});
    r.vertices.insert(r.vertices.end(), t.begin(), t.end());
  }
  std::sort(r.vertices.begin(), r.vertices.end());
  r.vertices.erase(std::unique(r.vertices.begin(), r.vertices.end()), r.vertices.end());
  for (const std::uint32_t v : r.vertices) r.means.push_back({{v, 1.0}});
  for (LongPieces::Piece& p : r.pieces) {
    for (std::size_t c = 0; c < 4; ++c) {
      const auto at = std::lower_bound(r.vertices.begin(), r.vertices.end(), vertices_of(pieces_[p.number])[c]);
      p.corners[c] = static_cast<std::size_t>(at - r.vertices.begin());
    }
    const Vec3d x = r.mean(step, p, [&](std::uint32_t place) { return step.position(place); });
    const double share = std::clamp(dot(x - before.from, was) / dot(was, was), 0.0, 1.0);
    p.edge = from * (1.0 - share) + to * share;
  }
  return r;
}

/// W of the pieces across the edge: what vertices do to one another, by the weights of the pieces at them.
Eigen::MatrixXd Blade::LongPieces::couple(StepCompliance& compliance) const {
  const std::vector<Mat3d> blocks = compliance.couple(means);
  const std::size_t m = vertices.size();
  Eigen::MatrixXd of_vertices(2 * m, 2 * m), weights = Eigen::MatrixXd::Zero(of_vertices.rows(), size());
  const auto at = [](std::size_t i) { return static_cast<Eigen::Index>(2 * i); };
  for (std::size_t j = 0; j < m; ++j) {
    for (std::size_t k = 0; k < m; ++k) {
      for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t b = 0; b < 2; ++b) {
          of_vertices(at(j) + static_cast<Eigen::Index>(a), at(k) + static_cast<Eigen::Index>(b)) =
              dot(e[a], blocks[j * m + k] * e[b]);
        }
      }
    }
  }
  for (std::size_t j = 0; j < pieces.size(); ++j) {
    for (std::size_t c = 0; c < 4; ++c) {
      weights.block<2, 2>(at(pieces[j].corners[c]), at(j)).diagonal().setConstant(pieces[j].weights[c]);
    }
  }
  const Eigen::MatrixXd W = weights.transpose() * of_vertices * weights;
  return 0.5 * (W + W.transpose());
}

/// Impulses on all pieces, 0 on those whose tissue is not at hand.
void Blade::solve_long(const InteractionStep& step, const LongPieces& r) {
  Eigen::MatrixXd W = r.couple(*step.compliance);
  const double bond = kBond * W.trace() / static_cast<double>(r.size());
  Eigen::VectorXd slip(r.size()), J(r.size());
  std::vector<double> most;
  const bool is_first = trial_.empty();
  trial_.resize(pieces_.size());
  for (std::size_t j = 0; j < r.pieces.size(); ++j) {
    const LongPieces::Piece& piece = r.pieces[j];
    const Vec3d tissue = r.mean(step, piece, [&](std::uint32_t place) { return step.vertices[place].velocity; }),
                last = last_force(pieces_[piece.number]) * step.h;
    for (std::size_t a = 0; a < 2; ++a) {
      const auto at = static_cast<Eigen::Index>(2 * j + a);
      slip[at] = dot(piece.edge - tissue, r.e[a]);
      J[at] = dot(is_first ? last : trial_[piece.number], r.e[a]);
      if (!(W(at, at) > 0.0)) continue;  // held: it bears what it can get
      W(at, at) += bond, slip[at] += bond * dot(last, r.e[a]);
    }
    most.push_back(piece.most);
  }
  solve_within_discs(W, slip, most, J);
  std::fill(trial_.begin(), trial_.end(), Vec3d{});
  for (std::size_t j = 0; j < r.pieces.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(2 * j);
    trial_[r.pieces[j].number] = r.e[0] * J[at] + r.e[1] * J[at + 1];
  }
}

/// Force on the same piece in the step before [N].
Vec3d Blade::last_force(const EdgePiece& piece) const {
  const auto at =
      std::lower_bound(last_.begin(), last_.end(), piece.tet, [](const auto& a, auto t) { return a.first < t; });
  return at != last_.end() && at->first == piece.tet ? at->second : Vec3d{};
}

void Blade::moved(const InteractionStep& step) {
  if (!forces_at_end()) return;
  last_.clear();
  for (std::size_t k = 0; k < trial_.size(); ++k) last_.emplace_back(pieces_[k].tet, trial_[k] * (1.0 / step.h));
  std::sort(last_.begin(), last_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
}

void Blade::resist_long(const InteractionStep& step, const BladeEdge& before, const BladeEdge& after) {
  const LongPieces r = long_pieces(step, before, after);
  if (r.pieces.empty()) return;
  solve_long(step, r);
  std::vector<Vec3d> on_vertices(r.vertices.size());
  for (const LongPieces::Piece& piece : r.pieces) {
    for (std::size_t c = 0; c < 4; ++c) on_vertices[piece.corners[c]] += trial_[piece.number] * piece.weights[c];
  }
  step.compliance->spread_means(r.means, on_vertices, step.vertices);
  for (std::size_t k = 0; k < r.vertices.size(); ++k) step.impulses[step.place_of[r.vertices[k]]] += on_vertices[k];
  const auto at_end = [&](std::uint32_t place) {
    return step.position(place) + step.vertices[place].velocity * step.h;
  };
  for (const LongPieces::Piece& piece : r.pieces) {
    const Vec3d &J = trial_[piece.number], x = r.mean(step, piece, at_end);
    const ToolVelocity tool = velocity_at(x);
    for (std::size_t c = 0; c < 4; ++c) {
      step.book(WorkSink::fracture, step.place_of[r.vertices[piece.corners[c]]], J * piece.weights[c], tool);
    }
    forces_.cutting += J * (1.0 / step.h);
    forces_.torque += cross(x - pose_.position, J) * (1.0 / step.h);
  }
}

std::string Blade::refuses_long_steps() const { return driver_refuses_long_steps(); }

}  // namespace glisson
