// element_forces.h — the forces of the elements of a submesh on its local vertices, through the kernels, and what the pass found.
//
//   narrow ─▶ [ gather ─▶ measure, law ─▶ stress ─▶ push ] a block of batches at a time     tets (response_forces.cpp: beyond the paper's)
//          ─▶ edges                                                                         a linear tissue, or a submesh by its twin
//
// It reads the records of the state and writes a scratch, the findings and the submesh's own memory of branches: submeshes may be
// evaluated on any threads at the same time.
#pragma once

#include "engine/inversion_search.h"
#include "engine/linear_twin.h"
#include "engine/precision_choice.h"
#include "engine/submesh_scratch.h"
#include "engine/tissue_plan.h"

namespace glisson::engine {

/// What a pass over a submesh found.
struct ElementFindings {
  bool finite = true;  ///< whether all forces are
  StiffnessSeen seen;
  double stiffening = 0.0;              ///< bound of tangent over rest stiffness [-]
  std::vector<std::uint32_t> inverted;  ///< tets of the mesh with J ≤ 0
  std::vector<StiffElement> stiff;      ///< above the limits

  /// Forgets all; the lists keep their memory.
  void clear() {
    finite = true, seen = {}, stiffening = 0.0;
    inverted.clear(), stiff.clear();
  }
};

class ElementForces {
 public:
  /// @param body, @param submeshes, @param records, @param kernels  must outlive this
  /// @param precision_error  SimulationOptions::precision_error; 0: every submesh goes by its own law
  ElementForces(const Body& body, Submeshes& submeshes, const VertexRecords& records, const Kernels& kernels,
                double precision_error = 0.0);

  /// Plans of all tissues, and no submesh was seen yet.
  void reset();
  void take_tissue(std::size_t block);
  const TissuePlan& plan(std::size_t block) const { return plans_[block]; }
  InversionSearch& inversions() { return inversions_; }
  PrecisionChoice& precision() { return precision_; }
  const PrecisionChoice& precision() const { return precision_; }
  /// Whether the last step kept energies.
  bool accounted() const { return accounted_; }
  void set_accounted(bool accounted) { accounted_ = accounted; }
  bool has_twin(std::size_t block) const { return precision_.on() && twins_[block].has_value(); }
  /// Makes a submesh ready that has become linear. Submeshes may be made ready at the same time.
  void prepare_linear(Submesh& part) const;

  /// MovingBody::list_above
  void list_above(std::span<const double> stiffening, std::span<const StiffLimit> single);
  /// @param h  [s] @param steps  made so far @param since_memory  ResponsePlan::set_step @param accounted  whether energies are kept
  void begin_step(double h, std::uint64_t steps, double since_memory, bool accounted);

  /// Forces at the state of the records. @param split  whether viscous ones go into `scratch.viscous`; else all into `elastic`
  /// @param theta  volume changes that are shared, per local vertex; null: each tet has its own
  void evaluate(std::size_t submesh, bool split, const float* theta, SubmeshScratch& scratch, ElementFindings& found);
  /// Viscous forces into `scratch.viscous`. @param velocities  four numbers a record
  void drag(const Submesh& part, const double* velocities, SubmeshScratch& scratch) const;
  /// Sums of V ϑ around the local vertices, ϑ the volume change of a tet. @param sums  one a local vertex
  void spread_volume_changes(const Submesh& part, SubmeshScratch& scratch, float* sums) const;

 private:
  void narrow(const Submesh& part, SubmeshScratch& scratch) const;
  Elements elements_of(const Submesh& part, SubmeshScratch& scratch) const;
  void push_tets(Submesh& part, bool split, const float* theta, SubmeshScratch& scratch, ElementFindings& found) const;
  void push_elements(const Submesh& part, bool split, SubmeshScratch& scratch, ElementFindings& found) const;
  float push_edges(const EdgeBatches& batches, const TissuePlan& plan, bool split, SubmeshScratch& scratch) const;
  double power(const Submesh& part, const SubmeshScratch& scratch) const;
  void mix_in(std::size_t submesh, bool split, SubmeshScratch& scratch);
  void examine(std::size_t submesh, SubmeshScratch& scratch);
  void own_stress(const Submesh& part, std::size_t batch, const ResponseItems& items, SubmeshScratch& scratch) const;
  double energy_gap(const Submesh& part, SubmeshScratch& scratch) const;
  void examine_forces(std::size_t submesh, bool split, const SubmeshScratch& scratch);
  MaxwellStep since_last_look(const Submesh& part) const;
  void push_response(Submesh& part, bool split, const float* theta, SubmeshScratch& scratch,
                     ElementFindings& found) const;
  void push_relaxing(Submesh& part, bool split, SubmeshScratch& scratch, ElementFindings& found) const;
  void run_laws(const TissuePlan& plan, std::size_t values, Block& block) const;
  void run_paces(const LaneResponse& lanes, std::size_t values, const Block& block, ResponseBlock& out) const;
  bool watch_laws(const TissuePlan& plan, std::size_t values, float limit, Block& block, StiffnessSeen& seen) const;
  double list_limit(std::size_t block) const;
  void list(ElementFindings& found, const StiffElement& stiff) const;
  void list_by_laws(const Submesh& part, std::size_t batch, std::size_t n, const TissuePlan& plan, Block& block,
                    ElementFindings& found) const;
  void list_response(const Submesh& part, std::size_t batch, std::size_t n, const ResponseBlock& out,
                     ElementFindings& found) const;

  const Body& body_;
  Submeshes& submeshes_;
  const VertexRecords& records_;
  const Kernels& kernels_;
  InversionSearch inversions_;
  PrecisionChoice precision_;
  std::vector<TissuePlan> plans_;                 ///< per tissue block
  std::vector<std::optional<LinearTwin>> twins_;  ///< likewise; empty unless precision is adaptive
  std::vector<double> list_above_;                ///< per tissue block: stiffening; empty: no element is listed
  std::span<const StiffLimit> single_limits_;     ///< per element, beside it; empty: none
  std::uint64_t steps_ = 0;
  double last_step_ = 0.0;                  ///< h of the step before; 0: none [s]
  bool moves_ = false, accounted_ = false;  ///< whether the step has a length, and energies are kept
};

}  // namespace glisson::engine
