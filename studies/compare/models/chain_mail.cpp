// chain_mail.cpp — linked volumes: links along the edges of the tets may be stretched, squeezed and sheared by so much; a vertex that is
// moved drags its neighbours only as far as its links are taut, first moved first, then sweeps of averaging relax the links
// [Gibson1999; LiBrodlie2003]. Its two limits follow no modulus and it knows no force: what it gives is a shape.
#include <algorithm>
#include <cmath>
#include <queue>

#include "compare/models/boundary.h"
#include "compare/models/stopwatch.h"

namespace glisson::models {
namespace {

constexpr double kStretch = 0.1, kShear = 0.1;  // share of a link by which its components may change

class ChainMail {
 public:
  explicit ChainMail(const Problem& problem) : problem_(problem), boundary_(problem), u_(problem.mesh.vertices.size()) {
    link(problem.mesh);
  }

  /// The links of the tets that are left.
  void remove(const std::vector<std::uint32_t>& tets) {
    TetMesh left;
    left.vertices = problem_.mesh.vertices;
    std::vector<bool> gone(problem_.mesh.tets.size(), false);
    for (const std::uint32_t t : tets) gone[t] = true;
    for (std::size_t t = 0; t < gone.size(); ++t) {
      if (!gone[t]) left.tets.push_back(problem_.mesh.tets[t]);
    }
    link(left);
  }

  /// The prescribed vertices move, the others follow where a link is taut.
  void pull(double time) {
    boundary_.set(time, u_);
    std::queue<std::uint32_t> moved;
    std::vector<bool> done(u_.size(), false);
    for (std::uint32_t v = 0; v < u_.size(); ++v) {
      if (!held(v)) continue;
      done[v] = true;
      moved.push(v);
    }
    while (!moved.empty()) {
      const std::uint32_t from = moved.front();
      moved.pop();
      for (const std::uint32_t to : links_[from]) {
        if (done[to]) continue;
        done[to] = true;
        if (follow(from, to))
          moved.push(to);
        else
          done[to] = false;
      }
    }
  }

  void relax(int sweeps) {
    for (int k = 0; k < sweeps; ++k) {
      for (std::size_t v = 0; v < u_.size(); ++v) {
        Vec3d mean;
        for (const std::uint32_t n : links_[v]) mean += u_[n];
        if (links_[v].empty()) continue;
        mean = mean * (1.0 / static_cast<double>(links_[v].size()));
        for (std::size_t i = 0; i < 3; ++i) {
          if (!boundary_.prescribes(v, i)) u_[v][i] = mean[i];
        }
      }
    }
  }

  const std::vector<Vec3d>& displacement() const { return u_; }
  std::size_t bytes() const {
    std::size_t links = 0;
    for (const auto& l : links_) links += l.size();
    return 4 * links + u_.size() * (sizeof(Vec3d) + sizeof(std::vector<std::uint32_t>));
  }

 private:
  void link(const TetMesh& mesh) {
    links_.assign(mesh.vertices.size(), {});
    for (const auto& [a, b] : mesh_edges(mesh)) {
      links_[a].push_back(b);
      links_[b].push_back(a);
    }
  }

  bool held(std::uint32_t v) const {
    return boundary_.prescribes(v, 0) && boundary_.prescribes(v, 1) && boundary_.prescribes(v, 2);
  }

  /// Moves a vertex into what its link to another allows; false where it is there already.
  bool follow(std::uint32_t from, std::uint32_t to) {
    const Vec3d d = problem_.mesh.vertices[to] - problem_.mesh.vertices[from];
    const double sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
    bool moved = false;
    for (std::size_t i = 0; i < 3; ++i) {
      if (boundary_.prescribes(to, i)) continue;
      const double slack = kStretch * std::abs(d[i]) + kShear * (sum - std::abs(d[i]));
      const double allowed = u_[from][i] + std::clamp(u_[to][i] - u_[from][i], -slack, slack);
      moved = moved || allowed != u_[to][i];
      u_[to][i] = allowed;
    }
    return moved;
  }

  const Problem& problem_;
  Boundary boundary_;
  std::vector<std::vector<std::uint32_t>> links_;
  std::vector<Vec3d> u_;
};

}  // namespace

Answer chain_mail(const Problem& problem, const Effort& effort, const Stop& stop) {
  Answer answer;
  Stopwatch watch;
  ChainMail model(problem);
  answer.setup_s = watch.lap();
  bool whole = problem.cut.has_value();
  for (int n = 1; n <= effort.steps && !stop; ++n) {
    if (whole && problem.duration * (n - 1) / effort.steps >= problem.cut->time) {
      whole = false;
      Stopwatch knife;
      model.remove(problem.cut->tets);
      answer.cut_s = knife.lap();
    }
    model.pull(problem.duration * n / effort.steps);
    model.relax(effort.iterations);
  }
  answer.run_s = watch.lap();
  answer.displacement = model.displacement();
  answer.bytes = model.bytes();
  answer.steps = static_cast<std::size_t>(effort.steps);
  return answer;
}

}  // namespace glisson::models
