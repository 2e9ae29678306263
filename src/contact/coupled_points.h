// coupled_points.h — points on which the rows of a long step act, which move one another.
//
//   v = v₀ + W p        v₀ without any tool, W = J P⁻¹ Jᵀ / h², P the step's matrix (step_mobility.h)
//
// A tool that a force moves adds its own compliance to W among its points: velocities are against where it ends.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "contact/step_mobility.h"
#include "contact/tool_yield.h"

namespace glisson {

inline Eigen::Vector3d eigen(const Vec3d& a) { return {a.x, a.y, a.z}; }

class CoupledPoints {
 public:
  static Eigen::Index at(std::size_t k) { return static_cast<Eigen::Index>(3 * k); }

  /// @param as_one  its column is asked for as a whole, not vertex by vertex @param yields  the tool, where a force moves it; or null
  void add(std::span<const VertexWeight> mean, bool as_one, ToolYield* yields);
  std::size_t size() const { return means_.size(); }
  /// Finds W and v₀. @param free  velocities without any tool, per place [m/s]
  void couple(StepMobility& mobility, const InteractionStep& step, std::span<const Vec3d> free);
  /// A compliance of a point beside W [1/kg].
  void add_slack(std::size_t k, double slack) { W_.diagonal().segment<3>(at(k)).array() += slack; }

  const Eigen::MatrixXd& W() const { return W_; }
  Eigen::VectorXd& velocities() { return v_; }
  Vec3d velocity(std::size_t k) const { return {v_[at(k)], v_[at(k) + 1], v_[at(k) + 2]}; }
  /// Velocity that an impulse on a point gives it.
  Vec3d own(std::size_t k, const Vec3d& impulse) const;
  /// A bound of the same per impulse, equal in all components that move; 0 in the others [1/kg].
  Vec3d most_own(std::size_t k) const;
  void push(std::size_t k, const Vec3d& impulse);
  /// Adds an impulse on a point to those on places [N s], and the force on its tool where that yields.
  void spread(std::size_t k, const Vec3d& impulse, const InteractionStep& step, std::span<Vec3d> impulses) const;

 private:
  void add_yields(double h);

  std::vector<StepMobility::Mean> means_;
  std::vector<char> as_one_;
  std::vector<ToolYield*> yields_;
  Eigen::MatrixXd W_;
  Eigen::VectorXd v_;
};

}  // namespace glisson
