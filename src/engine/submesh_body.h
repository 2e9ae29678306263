// submesh_body.h — a body that moves by submeshes: in lanes, on threads, with the same bytes on any number.
//
//   advance      ┌─ task per submesh ────────────────────────────────┐   ┌─ task per chunk of interface ┐
//                │ narrow → [gather measure law push]… → integrate   │ ∥ │ sum slots in order           │
//                │ forces on interface vertices → own slots          │   │ → integrate                  │
//                └───────────────────────────────────────────────────┘   └──────────────────────────────┘
//
// A task reads the state and writes what no other task of its phase touches: its interior records, its slots,
// its own findings. Which thread runs it, and when, cannot be seen in the result.
//
// The body itself holds the tasks and the slots. What they work on, and how, is in the classes that it has as members:
//
//   VertexRecords      state, mass and coefficients of each vertex      ElementForces      forces of a submesh in a scratch
//   ActiveVertices     those driven from outside, by task               SharedVolumes      average_nodal, before the forces
//   SubmeshChanger     cuts and other tissues in the layout             DragStageRecords   stages of the viscous force, after them
//   MaxwellMemory      the branches' past, as seen from outside
//
// With adaptive precision a submesh may go by its tissue's linear law: PrecisionChoice, in ElementForces, says which.
#pragma once

#include "base/task_pool.h"
#include "engine/active_vertices.h"
#include "engine/drag_stage_records.h"
#include "engine/element_forces.h"
#include "engine/maxwell_memory.h"
#include "engine/moving_body.h"
#include "engine/shared_volumes.h"
#include "engine/update/submesh_changer.h"

namespace glisson::engine {

struct SubmeshOptions {
  int threads = 0;                   ///< 0: as many as pay for this size of body
  const Kernels* kernels = nullptr;  ///< none: those of the best instruction set
  std::size_t submesh_tets = kLeastSubmesh;
  int drag_stages = 1;           ///< SimulationOptions::drag_stages
  double precision_error = 0.0;  ///< SimulationOptions::precision_error where precision is adaptive; else 0
};

class SubmeshBody final : public MovingBody {
 public:
  /// @param body  must outlive this
  /// @param nodal_damping  γ_i per vertex [kg/s]
  SubmeshBody(const Body& body, std::span<const double> nodal_damping, const SubmeshOptions& options = {});
  ~SubmeshBody() override;

  void set_state(std::span<const Vec3d> displacement, std::span<const Vec3d> velocity) override;
  void read_state(std::span<Vec3d> displacement, std::span<Vec3d> velocity) const override;
  void archive_past(Archive& ar) override;
  void archive_layout(Archive& ar, std::span<const double> nodal_damping) override;
  std::shared_ptr<const void> save_layout() const override;
  void load_layout(const std::shared_ptr<const void>& layout, std::span<const double> nodal_damping) override;
  Vec3d displacement_of(std::uint32_t vertex) const override { return records_.displacement(record_of(vertex)); }
  Vec3d velocity_of(std::uint32_t vertex) const override { return records_.velocity(record_of(vertex)); }
  void read_velocities(std::span<const std::uint32_t> vertices, std::span<Vec3d> velocities) const override;
  void apply(const BodyChange& change, const detail::VertexStars& stars,
             std::span<const double> nodal_damping) override;
  bool supports_tissues() const override;
  void tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) override;
  BranchMemory branch_memory(std::size_t block) const override { return memory_.of_block(block); }
  double linear_share() const override { return forces_.precision().share_of_tets(); }
  std::vector<Sym3<double>> branch_stresses(std::size_t block) override { return memory_.stresses(block); }
  void set_branch_stresses(std::size_t block, std::span<const Sym3<double>> stresses) override {
    memory_.set_stresses(block, stresses);
  }
  void watch(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart) override {
    active_.add(vertices, apart);
  }
  void watch_only(std::span<const std::uint32_t> vertices) override { active_.keep(vertices); }
  std::span<ActiveVertex> active() override { return active_.active(); }
  void rest(std::span<const std::uint32_t> vertices) override;
  std::span<RestingVertex> resting() override { return active_.resting(); }
  void hold_in_stages(std::span<const char> components) override { stages_.hold(components); }
  void push_in_stages(std::span<const Vec3d> outer) override { stages_.push(outer); }
  void project_stages(StageHolds* holds) override { stages_.project(holds); }
  void place_active() override;
  void set_velocity(std::uint32_t vertex, const Vec3d& velocity) override {
    records_.set_velocity(record_of(vertex), velocity);
  }
  void inertia_changed(std::span<const std::uint32_t> vertices) override;
  void list_above(std::span<const double> stiffening, std::span<const StiffLimit> single) override {
    forces_.list_above(stiffening, single);
  }
  const Advance& advance(double h, const Vec3d& gravity, bool accounted) override;

  const Submeshes& submeshes() const { return submeshes_; }
  const Kernels& kernels() const { return kernels_; }
  int threads() const { return pool_.threads(); }
  /// Whether the viscous force is taken in several stages a step.
  bool in_stages() const { return stages_.in_use(); }

 private:
  struct Step {
    Kick kick;
    bool accounted;
  };

  /// Of a checkpoint, per element.
  struct LinearElements {
    std::span<const double> share;
    std::span<const std::uint8_t> wanted;
    double since;
  };

  void follow_layout(std::span<const double> nodal_damping);
  void make_room();
  void make_room_for_stages();
  void take_masses(std::span<const double> nodal_damping);
  void take_mass(std::uint32_t vertex);
  void take_states(std::span<const MovedVertex> moved);
  bool splits(std::size_t s, bool accounted) const;
  void spread_volume(std::size_t s, SubmeshScratch& scratch);
  void run_submesh(std::size_t s, const Step& step, SubmeshScratch& scratch);
  void fill_slots(const Submesh& part, bool split, const SubmeshScratch& scratch);
  void run_interface(std::size_t chunk, const Step& step, SubmeshScratch& scratch);
  void integrate(const RecordRun& run, const float* elastic, const float* viscous, const Step& step, VertexWork& work);
  void run_drag_stages(const Step& step);
  void end_stages(const RecordRun& run, bool split, const Step& step, VertexWork& work);
  void gather_findings(bool accounted);
  void change_laws(double h);
  void prepare_linear();
  void leave_linear(std::size_t submesh);
  void archive_precision(Archive& ar);
  void take_linear(const LinearElements& read, Submesh& part, const Archive& ar);
  std::uint32_t record_of(std::uint32_t vertex) const { return submeshes_.record_of_vertex[vertex]; }
  VertexWork& work_of_chunk(std::size_t chunk) { return work_[submeshes_.parts.size() + chunk]; }

  const Body& body_;
  const Kernels& kernels_;
  Submeshes submeshes_;
  VertexRecords records_;
  ActiveVertices active_;
  SubmeshChanger changer_;
  ElementForces forces_;
  SharedVolumes volumes_;
  MaxwellMemory memory_;
  DragStageRecords stages_;
  detail::TaskPool pool_;
  std::vector<std::unique_ptr<SubmeshScratch>> scratch_;  ///< per thread

  LaneVector<float> slots_elastic_, slots_viscous_;  ///< force records
  bool any_split_ = false;                           ///< whether some submesh keeps viscous forces apart in this step
  std::uint64_t steps_ = 0;
  std::vector<ElementFindings> found_;  ///< per submesh
  std::vector<VertexWork> work_;        ///< per submesh, then per chunk of the interface
  double brought_in_ = 0.0;             ///< energy of submeshes that left their linear law between steps [J]
  Advance advance_;
  bool as_built_ = true;  ///< whether build_submeshes would lay the body out as it is
};

}  // namespace glisson::engine
