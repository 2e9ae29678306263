// element_body.h — a body that moves in double precision, element by element: the scene option, and a check.
//
// No submeshes, lanes or threads: on arrays in the mesh's order the loop of element/force_operator.h, or where a tissue
// is more than the paper's that of element/tissue_operator.h.
#pragma once

#include <memory>

#include "element/force_operator.h"
#include "element/tissue_operator.h"
#include "engine/moving_body.h"
#include "glisson/simulation/precision.h"

namespace glisson::engine {

class ElementBody final : public MovingBody {
 public:
  /// @param body  must outlive this
  /// @param nodal_damping  γ_i per vertex [kg/s]
  /// @param drag_stages  SimulationOptions::drag_stages
  ElementBody(const Body& body, std::span<const double> nodal_damping, Precision precision, int drag_stages = 1);

  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) override;
  void read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const override;
  void archive_past(Archive& ar) override;
  void archive_layout(Archive& ar, std::span<const double> nodal_damping) override;
  std::shared_ptr<const void> save_layout() const override { return {}; }
  void load_layout(const std::shared_ptr<const void>& layout, std::span<const double> nodal_damping) override;
  Vec3d displacement_of(std::uint32_t vertex) const override { return u_[vertex]; }
  Vec3d velocity_of(std::uint32_t vertex) const override { return v_[vertex]; }
  void read_velocities(std::span<const std::uint32_t> vertices, std::span<Vec3d> velocities) const override {
    for (std::size_t k = 0; k < vertices.size(); ++k) velocities[k] = v_[vertices[k]];
  }
  /// Cost: one pass over the elements.
  void apply(const BodyChange& change, const detail::VertexStars& stars,
             std::span<const double> nodal_damping) override;
  bool supports_tissues() const override;
  /// Cost: one pass over the elements.
  void tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) override;
  BranchMemory branch_memory(std::size_t block) const override;
  std::vector<Sym3<double>> branch_stresses(std::size_t block) override;
  void set_branch_stresses(std::size_t block, std::span<const Sym3<double>> stresses) override;
  void watch(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart) override;
  void watch_only(std::span<const std::uint32_t> vertices) override;
  std::span<ActiveVertex> active() override { return active_; }
  void rest(std::span<const std::uint32_t> vertices) override;
  std::span<RestingVertex> resting() override { return resting_; }
  void hold_in_stages(std::span<const char> components) override { held_.assign(components.begin(), components.end()); }
  void push_in_stages(std::span<const Vec3d> outer) override { outer_.assign(outer.begin(), outer.end()); }
  void project_stages(StageHolds* holds) override { holds_ = holds; }
  void place_active() override;
  void set_velocity(std::uint32_t vertex, const Vec3d& velocity) override { v_[vertex] = velocity; }
  void inertia_changed(std::span<const std::uint32_t>) override {}  // it asks the body
  void list_above(std::span<const double> stiffening, std::span<const StiffLimit> single) override;
  const Advance& advance(double h, const Vec3d& gravity, bool accounted) override;

 private:
  void make_operator();
  void evaluate(bool moves);
  void run_drag_stages(double h, const Vec3d& gravity);
  void hold_rows();
  void bring_memory_up_to_date(double since);
  void book(std::size_t vertex, const Vec3d& before, const Vec3d& weight);

  const Body& body_;
  Precision precision_;
  std::unique_ptr<ForceOperator> tissue_;  ///< where all tissues are tensor masses
  std::unique_ptr<TissueOperator> any_;    ///< else
  double since_memory_ = 0.0;              ///< time since the tissue's memory was brought up to date [s]
  std::vector<double> damping_, stages_;   ///< stages of drag, as shares of a step
  std::vector<LameParameters> drag_;       ///< per tissue block [Pa s]
  std::vector<Vec3d> stage_change_, stage_sum_, pull_,
      outer_;  ///< δ, A of drag_stage_records.h; C δ; on active vertices
  StageHolds* holds_ = nullptr;
  std::vector<Vec3d> held_changes_;
  std::vector<Vec3d> u_, v_, elastic_, viscous_;
  std::vector<char> is_active_, rests_, held_;
  std::vector<ActiveVertex> active_;
  std::vector<RestingVertex> resting_;
  ElementWatch watch_;
  std::span<const StiffLimit> single_limits_;
  Advance advance_;
};

}  // namespace glisson::engine
