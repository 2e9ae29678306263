// hybrid.cpp — the hybrid of a part that stays whole and one that may be cut [Cotin2000]: the half of the body that is farther from the tool
// is condensed onto the vertices where it meets the other, which is a linear tensor-mass body in explicit steps. The condensed half has no
// inertia and costs one product with a dense matrix a step.
//
//   S = K_cc − K_ci K_ii⁻¹ K_ic        c: where the halves meet, and vertices of tools; i: the rest of the condensed half
#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <cmath>
#include <limits>
#include <string>

#include "compare/models/linear_stiffness.h"
#include "compare/models/stepping.h"

namespace glisson::models {
namespace {

enum class Kind { stepped, meets, inside, held };  // of a component

Vec3d mean_of(const TetMesh& mesh, std::span<const std::uint32_t> vertices) {
  Vec3d sum;
  for (const std::uint32_t v : vertices) sum += mesh.vertices[v];
  return sum * (1.0 / static_cast<double>(vertices.size()));
}

/// Tets whose middle is nearer to the first support than to the first tool.
std::vector<bool> condensed_tets(const Problem& problem) {
  const Vec3d tool = mean_of(problem.mesh, problem.tools.front().vertices);
  const Vec3d support = mean_of(problem.mesh, problem.supports.front().vertices);
  std::vector<bool> condensed;
  for (const Tet& tet : problem.mesh.tets) {
    const Vec3d middle = mean_of(problem.mesh, tet);
    condensed.push_back(norm(middle - support) < norm(middle - tool));
  }
  return condensed;
}

class Hybrid {
 public:
  explicit Hybrid(const Problem& problem)
      : problem_(problem), boundary_(problem), condensed_(condensed_tets(problem)), masses_(lumped_masses(problem)) {
    name_components();
    stepped_ = stiffness_matrix(problem, [&](std::size_t t) { return !condensed_[t]; });
    condense();
  }

  bool sound() const { return factor_.info() == Eigen::Success; }

  /// 0.9 of the longest step of central differences, by power iteration on M⁻¹ K.
  double step() const {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(stepped_.rows());
    for (Eigen::Index i = 0; i < x.size(); ++i)
      x[i] = moves(i) ? std::sin(1.0 + 1.7 * static_cast<double>(i * i % 1009)) : 0.0;
    double most = 0.0;
    for (int k = 0; k < 100; ++k) {
      x /= x.norm();
      Eigen::VectorXd y = -elastic(x);
      for (Eigen::Index i = 0; i < y.size(); ++i) y[i] = moves(i) ? y[i] / mass(i) : 0.0;
      most = y.norm();
      x = y;
    }
    return 0.9 * 2.0 / std::sqrt(1.05 * most);
  }

  void advance(double time, double h) {
    const Eigen::VectorXd force = elastic(u_) + loads(time);
    for (Eigen::Index i = 0; i < u_.size(); ++i) {
      if (!moves(i)) continue;
      v_[i] = (v_[i] + h * force[i] / mass(i)) / (1.0 + problem_.motion.damping_rate * h);
      u_[i] += h * v_[i];
    }
    std::vector<Vec3d> now = vectors_of(u_);
    boundary_.set(time + h, now);
    u_ = flat(now);
  }

  /// Of the part that is not condensed; the other is one matrix, which no tet can be taken out of. Their mass stays.
  std::string remove(std::span<const std::uint32_t> tets) {
    std::vector<bool> stays(condensed_.size());
    for (std::size_t t = 0; t < stays.size(); ++t) stays[t] = !condensed_[t];
    for (const std::uint32_t t : tets) {
      if (condensed_[t]) return "the cut reaches into the condensed half";
      stays[t] = false;
    }
    stepped_ = stiffness_matrix(problem_, [&](std::size_t t) { return stays[t]; });
    return {};
  }

  Vec3d force(double time) const { return boundary_.force(vectors_of(elastic(u_) + loads(time)), vectors_of(u_)); }

  /// The vertices inside the condensed half follow from those where it meets the other.
  std::vector<Vec3d> displacement() const {
    Eigen::VectorXd right = inside_loads(problem_.duration) - coupling_ * meeting(u_);
    const Eigen::VectorXd inside = factor_.solve(right);
    Eigen::VectorXd all = u_;
    for (std::size_t k = 0; k < inside_.size(); ++k) all[inside_[k]] = inside[static_cast<Eigen::Index>(k)];
    return vectors_of(all);
  }

  std::size_t bytes() const {
    return 12 * static_cast<std::size_t>(stepped_.nonZeros()) + 8 * static_cast<std::size_t>(schur_.size()) +
           2 * 8 * static_cast<std::size_t>(u_.size());
  }

 private:
  bool prescribed(Eigen::Index i) const {
    return boundary_.prescribes(static_cast<std::size_t>(i / 3), static_cast<std::size_t>(i % 3));
  }
  bool moves(Eigen::Index i) const {
    const Kind kind = kinds_[static_cast<std::size_t>(i)];
    return !prescribed(i) && (kind == Kind::stepped || kind == Kind::meets);
  }
  double mass(Eigen::Index i) const { return masses_[static_cast<std::size_t>(i / 3)]; }

  void name_components() {
    const std::size_t n = problem_.mesh.vertices.size();
    std::vector<bool> in_stepped(n, false), in_condensed(n, false), of_tool(n, false);
    for (std::size_t t = 0; t < condensed_.size(); ++t) {
      for (const std::uint32_t v : problem_.mesh.tets[t]) (condensed_[t] ? in_condensed : in_stepped)[v] = true;
    }
    for (const Tool& tool : problem_.tools) {
      for (const std::uint32_t v : tool.vertices) of_tool[v] = true;
    }
    kinds_.assign(3 * n, Kind::stepped);
    for (std::size_t i = 0; i < 3 * n; ++i) {
      const std::size_t v = i / 3;
      if (!in_condensed[v]) continue;
      const bool meets = in_stepped[v] || of_tool[v];
      kinds_[i] = meets ? Kind::meets : boundary_.prescribes(v, i % 3) ? Kind::held : Kind::inside;
      if (kinds_[i] == Kind::meets) meets_.push_back(static_cast<Eigen::Index>(i));
      if (kinds_[i] == Kind::inside) inside_.push_back(static_cast<Eigen::Index>(i));
    }
    u_ = v_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(3 * n));
  }

  void condense() {
    const Sparse whole = stiffness_matrix(problem_, [&](std::size_t t) { return condensed_[t]; });
    std::vector<Eigen::Index> place(kinds_.size(), -1);
    for (std::size_t k = 0; k < meets_.size(); ++k)
      place[static_cast<std::size_t>(meets_[k])] = static_cast<Eigen::Index>(k);
    for (std::size_t k = 0; k < inside_.size(); ++k)
      place[static_cast<std::size_t>(inside_[k])] = static_cast<Eigen::Index>(k);
    const auto n = static_cast<Eigen::Index>(inside_.size()), m = static_cast<Eigen::Index>(meets_.size());
    std::vector<Eigen::Triplet<double>> inner, outer;
    schur_ = Eigen::MatrixXd::Zero(m, m);
    for (Eigen::Index column = 0; column < whole.outerSize(); ++column) {
      const Kind of = kinds_[static_cast<std::size_t>(column)];
      const auto to = static_cast<int>(place[static_cast<std::size_t>(column)]);
      for (Sparse::InnerIterator it(whole, column); it; ++it) {
        const Kind row = kinds_[static_cast<std::size_t>(it.row())];
        const auto from = static_cast<int>(place[static_cast<std::size_t>(it.row())]);
        if (row == Kind::inside && of == Kind::inside) inner.emplace_back(from, to, it.value());
        if (row == Kind::inside && of == Kind::meets) outer.emplace_back(from, to, it.value());
        if (row == Kind::meets && of == Kind::meets) schur_(from, to) += it.value();
      }
    }
    Sparse matrix(n, n);
    matrix.setFromTriplets(inner.begin(), inner.end());
    coupling_.resize(n, m);
    coupling_.setFromTriplets(outer.begin(), outer.end());
    factor_.compute(matrix);
    if (!sound()) return;
    schur_ -= coupling_.transpose() * factor_.solve(Eigen::MatrixXd(coupling_));
  }

  Eigen::VectorXd meeting(const Eigen::VectorXd& u) const {
    Eigen::VectorXd out(static_cast<Eigen::Index>(meets_.size()));
    for (std::size_t k = 0; k < meets_.size(); ++k) out[static_cast<Eigen::Index>(k)] = u[meets_[k]];
    return out;
  }

  Eigen::VectorXd elastic(const Eigen::VectorXd& u) const {
    Eigen::VectorXd force = -(stepped_ * u);
    const Eigen::VectorXd condensed = schur_ * meeting(u);
    for (std::size_t k = 0; k < meets_.size(); ++k) force[meets_[k]] -= condensed[static_cast<Eigen::Index>(k)];
    return force;
  }

  Eigen::VectorXd weight(double time) const {
    const Vec3d gravity = problem_.gravity_at(time);
    Eigen::VectorXd out(u_.size());
    for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = mass(i) * gravity[static_cast<std::size_t>(i % 3)];
    return out;
  }
  Eigen::VectorXd inside_loads(double time) const {
    const Eigen::VectorXd all = weight(time);
    Eigen::VectorXd out(static_cast<Eigen::Index>(inside_.size()));
    for (std::size_t k = 0; k < inside_.size(); ++k) out[static_cast<Eigen::Index>(k)] = all[inside_[k]];
    return out;
  }
  /// The weight, that of the inside as the vertices feel it where the halves meet.
  Eigen::VectorXd loads(double time) const {
    Eigen::VectorXd out = weight(time);
    if (problem_.motion.gravity == Vec3d{}) return out;
    const Eigen::VectorXd condensed = coupling_.transpose() * factor_.solve(inside_loads(time));
    for (std::size_t k = 0; k < meets_.size(); ++k) out[meets_[k]] -= condensed[static_cast<Eigen::Index>(k)];
    return out;
  }

  const Problem& problem_;
  Boundary boundary_;
  std::vector<bool> condensed_;
  std::vector<double> masses_;
  std::vector<Kind> kinds_;  // per component
  std::vector<Eigen::Index> meets_, inside_;
  Sparse stepped_, coupling_;
  Eigen::SimplicialLDLT<Sparse> factor_;
  Eigen::MatrixXd schur_;
  Eigen::VectorXd u_, v_;
};

}  // namespace

Answer hybrid(const Problem& problem, const Effort&, const Stop& stop) {
  Answer answer;
  if (problem.tools.empty() || problem.supports.empty()) {
    answer.trouble =
        "the half that is condensed is the one away from the tool, at the support; there is not one of each";
    return answer;
  }
  Stopwatch watch;
  Hybrid model(problem);
  if (!model.sound()) {
    answer.trouble = "the condensed half is not held by its support";
    return answer;
  }
  const auto steps = static_cast<std::size_t>(std::ceil(problem.duration / model.step()));
  return run_in_steps(problem, stop, model, steps, watch);
}

}  // namespace glisson::models
