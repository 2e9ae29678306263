// submesh_body.h — a body that moves by submeshes: in lanes, on threads, with the same bytes on any number.
//
//   advance      ┌─ task per submesh ────────────────────────────────┐   ┌─ task per run of interface ─┐
//                │ narrow → [gather measure law push]… → integrate   │ ∥ │ sum slots in order          │
//                │ forces on interface vertices → own slots          │   │ → integrate                 │
//                └───────────────────────────────────────────────────┘   └─────────────────────────────┘
//
// A task reads the state and writes what no other task of its phase touches: its interior records, its slots,
// its own findings. Which thread runs it, and when, cannot be seen in the result.
#pragma once

#include <memory>

#include "engine/active_vertices.h"
#include "engine/kernels/kernels.h"
#include "engine/kernels/response_kernels.h"
#include "engine/layout/submesh.h"
#include "engine/moving_body.h"
#include "engine/task_pool.h"
#include "engine/update/submesh_changer.h"
#include "engine/vertex_records.h"

namespace glisson::engine {

struct SubmeshOptions {
  int threads = 0;                   ///< 0: as many as pay for this size of body
  const Kernels* kernels = nullptr;  ///< none: those of the best instruction set
  std::size_t submesh_tets = kLeastSubmesh;
  int drag_stages = 1;  ///< SimulationOptions::drag_stages
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
  Vec3d displacement_of(std::uint32_t vertex) const override { return records_.displacement(record_of(vertex)); }
  Vec3d velocity_of(std::uint32_t vertex) const override { return records_.velocity(record_of(vertex)); }
  void apply(const BodyChange& change, const detail::VertexStars& stars,
             std::span<const double> nodal_damping) override;
  bool supports_tissues() const override;
  void tissues_changed(std::span<const std::size_t> blocks, std::span<const double> nodal_damping) override;
  BranchMemory branch_memory(std::size_t block) const override;
  std::vector<Sym3<double>> branch_stresses(std::size_t block) override;
  void set_branch_stresses(std::size_t block, std::span<const Sym3<double>> stresses) override;
  void watch(std::span<const std::uint32_t> vertices, std::span<const std::uint32_t> apart) override {
    active_.add(vertices, apart);
  }
  void watch_only(std::span<const std::uint32_t> vertices) override { active_.keep(vertices); }
  std::span<ActiveVertex> active() override { return active_.active(); }
  void rest(std::span<const std::uint32_t> vertices) override;
  std::span<RestingVertex> resting() override { return active_.resting(); }
  void hold_in_stages(std::span<const char> components) override;
  void push_in_stages(std::span<const Vec3d> outer) override { outer_.assign(outer.begin(), outer.end()); }
  void project_stages(StageHolds* holds) override { holds_ = holds; }
  void place_active() override;
  void set_velocity(std::uint32_t vertex, const Vec3d& velocity) override {
    records_.set_velocity(record_of(vertex), velocity);
  }
  void inertia_changed(std::span<const std::uint32_t> vertices) override;
  void list_above(std::span<const double> stiffening, std::span<const StiffLimit> single) override {
    list_above_.assign(stiffening.begin(), stiffening.end());
    single_limits_ = single;
  }
  const Advance& advance(double h, const Vec3d& gravity, bool accounted) override;

  const Submeshes& submeshes() const { return submeshes_; }
  const Kernels& kernels() const { return kernels_; }
  int threads() const { return pool_.threads(); }
  /// Whether the viscous force is taken in several stages a step.
  bool in_stages() const { return !stage_sums_.empty(); }

 private:
  /// How a tissue block is evaluated.
  struct Plan {
    LaneTissue tissue;
    std::array<LaneLaw, 2> law;
    std::size_t laws = 1;  ///< 2: apart on λ and μ
    std::size_t measure = 0;
    bool viscous = false, drags = false;  ///< drags: it has a Kelvin–Voigt viscosity
  };
  /// A record of which stages of drag leave components as they are.
  struct HeldRecord {
    std::uint32_t record;
    std::array<bool, 3> axes;
  };
  /// What a task found.
  struct Findings {
    bool finite = true;
    StiffnessSeen seen;
    double stiffening = 0.0;
    float longest_edge_squared = 0.0F;
    std::vector<std::uint32_t> inverted;  ///< tets of the mesh with J ≤ 0
    std::vector<StiffElement> stiff;
    VertexWork work;

    /// Forgets all; the lists keep their memory.
    void clear() {
      std::vector<std::uint32_t> none_inverted = std::move(inverted);
      std::vector<StiffElement> none_stiff = std::move(stiff);
      none_inverted.clear(), none_stiff.clear();
      *this = {};
      inverted = std::move(none_inverted), stiff = std::move(none_stiff);
    }
  };
  /// What the last look at a linear submesh for inverted tets told: gradients below 1, above, or J ≤ 0.
  enum class Looked : char { small, large, inverted };
  /// A tissue beyond the paper's.
  struct LargePlan {
    Response response;
    LaneResponse lanes;
    RespondStage respond;
    MaxwellStep maxwell;
    bool one_pass = false, measured = false;  ///< in_one_pass(); whether a law or a branch's time reads the measure
  };
  /// Of a submesh whose tets share their volume change: one over the volume around each local vertex, and ϑ_a.
  struct SharedVolume {
    std::vector<float> per_volume, theta;
  };
  struct Scratch;
  struct Step {
    Kick kick;
    bool accounted;
  };

  void follow_layout(std::span<const double> nodal_damping);
  void take_masses(std::span<const double> nodal_damping);
  void take_mass(std::uint32_t vertex);
  static Plan plan_of(const TissueBlock& block);
  std::unique_ptr<LargePlan> large_plan_of(const TissueBlock& block, const Plan& plan) const;
  void set_maxwell_step(double h);
  void make_room();
  void take_states(std::span<const MovedVertex> moved);
  std::vector<Sym3<double>> relaxing_stresses(std::size_t block) const;
  std::vector<double> measures(std::size_t block) const;
  void follow_branches(std::size_t block, BranchMemory& memory) const;
  void make_memory_explicit();
  void make_room_for_stages();
  void run_drag_stages(const Step& step);
  void hold_rows();
  void drag_submesh(const Submesh& part, Scratch& scratch);
  void drag_elements(const Submesh& part, Scratch& scratch) const;
  void begin_stages(const RecordRun& run, const float* elastic, const float* viscous, const Step& step);
  void run_stage(const RecordRun& run, std::size_t stage, const Step& step, const float* force);
  void end_stages(const RecordRun& run, bool split, const Step& step, VertexWork& work);
  void run_submesh(std::size_t s, const Step& step, Scratch& scratch);
  void narrow(const Submesh& part, Scratch& scratch) const;
  void push_elements(const Submesh& part, bool split, Scratch& scratch, Findings& found) const;
  void push_response(std::size_t s, bool split, Scratch& scratch, Findings& found);
  void push_relaxing(std::size_t s, bool split, Scratch& scratch, Findings& found);
  bool shares_volume(const Submesh& part) const;
  void weigh_vertices();
  void spread_volume(std::size_t s, Scratch& scratch);
  void join_volume(std::size_t s);
  Elements elements_of(const Submesh& part, Scratch& scratch) const;
  void run_paces(const LaneResponse& lanes, std::size_t values, const Block& block, ResponseBlock& out) const;
  void run_laws(const Plan& plan, std::size_t values, Block& block) const;
  bool watch_laws(const Plan& plan, std::size_t values, float limit, Block& block, StiffnessSeen& seen) const;
  double list_limit(std::size_t block) const;
  void list(Findings& found, const StiffElement& stiff) const;
  void list_by_laws(const Submesh& part, std::size_t batch, std::size_t n, const Plan& plan, Block& block,
                    Findings& found) const;
  void list_response(const Submesh& part, std::size_t batch, std::size_t n, const ResponseBlock& out,
                     Findings& found) const;
  void push_edges(const Submesh& part, bool split, Scratch& scratch, Findings& found) const;
  bool must_look(std::size_t s, float longest_edge_squared, bool moves);
  void list_inverted(std::span<const std::uint32_t> elements, Findings& found) const;
  void list_inverted(const Submesh& part, std::size_t batch, std::size_t n, const Block& block, Findings& found) const;
  void fill_slots(const Submesh& part, bool split, const Scratch& scratch);
  void integrate(const RecordRun& run, float* elastic, float* viscous, const Step& step, VertexWork& work);
  void run_interface(std::size_t chunk, const Step& step, Scratch& scratch);
  void gather_findings(bool accounted);
  bool splits(std::size_t s, bool accounted) const;
  std::uint32_t record_of(std::uint32_t vertex) const { return submeshes_.record_of_vertex[vertex]; }

  const Body& body_;
  const Kernels& kernels_;
  Submeshes submeshes_;
  SubmeshChanger changer_;
  std::vector<Plan> plans_;
  std::vector<std::unique_ptr<LargePlan>> large_plans_;  ///< per tissue block; none where it is the paper's
  bool any_shared_ = false;                              ///< whether some tissue's tets share their volume change
  std::vector<SharedVolume> shared_volumes_;             ///< per submesh
  std::vector<float> slots_volume_;                      ///< per slot
  std::vector<std::uint32_t> part_of_slot_;
  double since_memory_ = 0.0;  ///< time since the branches' memory was kept [s]
  TaskPool pool_;
  std::vector<std::unique_ptr<Scratch>> scratch_;  ///< per thread

  VertexRecords records_;
  ActiveVertices active_;
  bool any_split_ = false;                ///< whether some submesh keeps viscous forces apart in this step
  std::uint64_t steps_ = 0;

  LaneVector<float> slots_elastic_, slots_viscous_;  ///< force records
  std::vector<double> stages_;                       ///< of drag, as shares of a step
  std::vector<HeldRecord> held_;                     ///< ascending: what stages leave as it is
  LaneVector<double> stage_changes_;                 ///< of the velocities in the last stage, four numbers a record
  LaneVector<float> stage_elastic_, stage_viscous_;  ///< E and V of DragStage, a force record for each of the state
  LaneVector<float> stage_sums_;                     ///< A; empty: there is one stage
  std::vector<Vec3d> outer_;                         ///< on each active vertex, in the last step [N]
  StageHolds* holds_ = nullptr;
  std::vector<Vec3d> held_changes_;
  std::vector<Looked> looked_;        ///< per submesh
  std::vector<Findings> found_, interface_found_;
  Advance advance_;
  std::vector<double> list_above_;              ///< per tissue block: stiffening; empty: no element is listed
  std::span<const StiffLimit> single_limits_;   ///< per element, beside it; empty: none
  bool as_built_ = true;                        ///< whether build_submeshes would lay the body out as it is
};

}  // namespace glisson::engine
