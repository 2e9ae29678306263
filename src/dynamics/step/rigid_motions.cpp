#include "dynamics/step/rigid_motions.h"

#include <Eigen/Core>
#include <map>
#include <numeric>
#include <sstream>
#include <vector>

#include "base/symmetric_eigen.h"

namespace glisson {
namespace {

constexpr double kFree = 1e-8;  ///< of the largest eigenvalue, below which a motion counts as free

/// For each vertex the smallest vertex that is joined to it by elements.
std::vector<std::uint32_t> pieces(const Body& body) {
  std::vector<std::uint32_t> parent(body.vertex_count);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (std::size_t e = 0; e < body.elements.size(); ++e) {
    if (body.rest[e].volume == 0.0) continue;
    const std::uint32_t first = root(body.elements[e][0]);
    for (const std::uint32_t v : body.elements[e]) {
      const std::uint32_t a = root(first), b = root(v);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::uint32_t v = 0; v < parent.size(); ++v) parent[v] = root(v);
  return parent;
}

struct Piece {
  Vec3d centre{};
  double size = 0.0;
  std::size_t vertices = 0;
  Eigen::Matrix<double, 6, 6> resistance = Eigen::Matrix<double, 6, 6>::Zero();
};

std::string describe(const Piece& piece, const Eigen::Matrix<double, 6, 1>& motion) {
  Eigen::Index worst = 0;
  motion.cwiseAbs().maxCoeff(&worst);
  std::ostringstream text;
  text << "a piece of " << piece.vertices << " vertices around (" << piece.centre.x << ", " << piece.centre.y << ", "
       << piece.centre.z << ") m can " << (worst < 3 ? "move along " : "turn around ") << "xyz"[worst % 3]
       << " as a rigid body, so that it has no equilibrium. Hold at least three vertices of it that are not on a line";
  return text.str();
}

}  // namespace

std::string free_rigid_motion(const Body& body, std::span<const char> held) {
  const std::vector<std::uint32_t> piece_of = pieces(body);
  std::map<std::uint32_t, Piece> all;
  for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
    if (!(body.masses[v] > 0.0)) continue;
    Piece& piece = all[piece_of[v]];
    piece.centre += body.rest_positions[v];
    ++piece.vertices;
  }
  for (auto& [root, piece] : all) piece.centre = piece.centre * (1.0 / static_cast<double>(piece.vertices));
  for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
    if (!(body.masses[v] > 0.0)) continue;
    Piece& piece = all[piece_of[v]];
    piece.size = std::max(piece.size, norm(body.rest_positions[v] - piece.centre));
  }
  for (std::uint32_t v = 0; v < body.vertex_count; ++v) {
    if (!(body.masses[v] > 0.0)) continue;
    Piece& piece = all[piece_of[v]];
    const Vec3d x = (body.rest_positions[v] - piece.centre) * (1.0 / piece.size);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (held[3 * v + axis] == 0) continue;
      Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
      row[static_cast<Eigen::Index>(axis)] = 1.0;
      for (std::size_t turn = 0; turn < 3; ++turn) {  // e_turn × x along this axis
        Vec3d unit{};
        unit[turn] = 1.0;
        row[static_cast<Eigen::Index>(3 + turn)] = cross(unit, x)[axis];
      }
      piece.resistance += row * row.transpose();
    }
  }
  for (const auto& [root, piece] : all) {
    const SymmetricEigen eigen = symmetric_eigen(piece.resistance);
    if (eigen.values[0] <= kFree * std::max(1.0, eigen.values[5])) return describe(piece, eigen.vectors.col(0));
  }
  return {};
}

}  // namespace glisson
