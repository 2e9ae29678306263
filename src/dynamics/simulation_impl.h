// simulation_impl.h — what a Simulation holds: the mesh that it shows, the scheme that moves its body, and what guards both.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dynamics/schemes/scheme.h"
#include "glisson/archive.h"
#include "glisson/simulation/simulation.h"

namespace glisson {

/// One version of the body, as it is between two changes of mesh or tissues. Filled when the body is about to change, for the
/// states that were saved of it.
struct SavedVersion {
  bool is_filled = false;
  TetMesh mesh;
  std::vector<char> removed;
  std::uint64_t told = 0;
  std::optional<BodyVersion> body;
  std::shared_ptr<const void> layout;
};

struct State::Contents {
  std::weak_ptr<const Scheme> scheme;  ///< of the simulation
  std::shared_ptr<SavedVersion> version;
  double time = 0.0;
  std::size_t constraints = 0, loads = 0;
  std::vector<std::shared_ptr<const void>> interactions;  ///< Interaction::save_state of each
  std::string motion;                                     ///< Scheme::archive_motion
  std::shared_ptr<const void> factor;
};

struct Simulation::Impl {
  TetMesh mesh;
  std::shared_ptr<Scheme> scheme;  ///< driven sets read it while it lives
  std::uint32_t kind;              ///< integrator, time scheme and precision
  std::uint64_t fingerprint;       ///< of mesh and tissues at the start
  std::vector<char> removed{};     ///< per tet; empty: none
  std::uint64_t told = 0;          ///< changes that interactions have been told of, or would have been
  std::shared_ptr<SavedVersion> version = std::make_shared<SavedVersion>();  ///< of the present body
  State start{};                                                             ///< in which the first step was made

  /// What calls out to functions of a program's own at present.
  enum class Busy { no, between_steps, yes };
  Busy busy = Busy::no;
  /// @param name  of the member that would change something @param most  the busiest in which it may
  /// @throws std::logic_error where the simulation is busier, or a const member asks such functions on this thread
  void refuse_while_busy(const std::string& name, Busy most = Busy::no) const;
  /// While it lives, what a program's own functions call is refused where it would change something.
  class Guard {
   public:
    /// @throws std::logic_error as refuse_while_busy
    Guard(Impl& inside, const char* name, Busy most = Busy::no);
    ~Guard() { inside_.busy = before_; }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;

   private:
    Impl& inside_;
    Busy before_;
  };
  /// The same around what a const member asks of such functions. Several threads may: each knows what it asks itself.
  class Asking {
   public:
    explicit Asking(const Impl& inside) : inside_(inside), outer_(innermost) { innermost = this; }
    ~Asking() { innermost = outer_; }
    Asking(const Asking&) = delete;
    Asking& operator=(const Asking&) = delete;
    /// Whether this thread asks functions for a const member of that simulation.
    static bool is_going_on(const Impl& inside);

   private:
    static thread_local const Asking* innermost;
    const Impl& inside_;
    const Asking* outer_;
  };

  /// Block of a region. @throws std::invalid_argument where it has none
  std::size_t block_of(int region) const;
  BodyView view() const { return {mesh, removed, scheme->body().masses, scheme->displacement()}; }
  void tell_change(std::span<const std::uint32_t> origins) {
    ++told;
    if (!scheme->interactions().empty()) scheme->tell_change(view(), origins);
  }
  ConstraintId add(const char* name, Constraint constraint);
  SplitReport split_faces(std::span<const Triangle> faces, std::span<const VertexMove> moves);
  void add_copies(std::span<const std::uint32_t> origins);

  // simulation_state.cpp
  std::span<const std::uint32_t> follow_body();
  void archive(Archive& ar);
  State save();
  void begin_run();
  void load(const State::Contents& state);
  /// Why a state is not one of this simulation as it is now; empty where it is.
  std::string refuses(const State& state) const;
  /// To be called before the body changes, and after it has changed.
  void keep_version();
  /// Supports or loads become others: states that are saved from now on do not share a version that was kept before.
  void begin_setup() {
    if (version->is_filled) begin_version();
  }
  void begin_version() { version = std::make_shared<SavedVersion>(); }
};

}  // namespace glisson
