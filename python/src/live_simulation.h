// live_simulation.h — a simulation as Python holds it: its own, or the body of a scene's variant.
//
//   step(n) ── GIL released ──▶ step … step ── every 20 ms, and some times a second within long steps: has Ctrl-C been pressed?
//                 │ a motion written in Python takes the GIL; what it raises is kept and raised when the step is done,
//                 ▼ because a step never throws
//
// One thread at a time: while one steps, the others' calls are refused, not answered with half a state.
#pragma once

#include <atomic>
#include <optional>
#include <thread>

#include "bind.h"
#include "glisson/scene/scene.h"

namespace glisson::python {

/// What a Python function raised while the engine was calling it.
struct Fault {
  std::exception_ptr raised;
  /// Raises it, once. Needs the GIL.
  void rethrow() {
    if (raised) std::rethrow_exception(std::exchange(raised, nullptr));
  }
  /// Of the simulation that steps in this thread; null: none does.
  static Fault*& current() {
    thread_local Fault* fault = nullptr;
    return fault;
  }
};

/// A Python function that the engine may call; after it has raised, its last value stands until the step is done.
template <class Value>
class Callback {
 public:
  /// Keeps the function.
  explicit Callback(nb::object function) : function_(function) {
    keeper_ = std::shared_ptr<nb::object>(new nb::object(std::move(function)), [](nb::object* f) {
      const nb::gil_scoped_acquire gil;
      delete f;
    });
  }
  /// The function is kept by `keeper`, where the garbage collector sees it: it may refer to what calls it.
  Callback(nb::object function, std::vector<nb::object>& keeper) : function_(function) {
    keeper.push_back(std::move(function));
  }
  Value operator()(double time) {
    Fault* fault = Fault::current();
    if (fault && fault->raised) return last_;
    const nb::gil_scoped_acquire gil;
    try {
      last_ = nb::cast<Value>(function_(time));
    } catch (...) {
      if (!fault) throw;
      fault->raised = std::current_exception();
    }
    return last_;
  }

 private:
  nb::handle function_;
  std::shared_ptr<nb::object> keeper_;
  Value last_{};
};

/// Raised where a step was not made.
class StepError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

class LiveSimulation {
 public:
  LiveSimulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options);
  LiveSimulation(const Variant& variant, const MeshLoader& load);

  /// The simulation, for one thread at a time. @throws std::runtime_error while another steps
  Simulation& get();
  const Simulation& get() const { return const_cast<LiveSimulation*>(this)->get(); }
  /// Of a scene's variant; null: built by hand.
  const BuiltVariant* built() const { return built_.get(); }
  Probes* probes() { return built_ ? &built_->probes : nullptr; }
  const std::optional<Variant>& variant() const { return variant_; }
  bool may_change() const { return may_change_; }
  /// Of the body when it was made.
  std::size_t first_vertices() const { return first_vertices_; }

  /// Makes steps. @return the worst of their statuses: ok or inverted @throws StepError, and what callbacks raised
  StepStatus step(std::uint64_t n);
  /// Steps until the time is reached to half a step. `observer` is called every so often, and at the end.
  StepStatus advance(double until, const std::optional<std::function<void()>>& observer, std::optional<double> every);

  std::vector<std::uint32_t> inverted() const { return inverted_; }

  /// @throws nb::buffer_error where views are held on a body that is about to move in memory
  void refuse_views() const;
  /// The arrays of the state are copies from then on where it changes the body.
  void attach(const std::shared_ptr<Interaction>& interaction);

  /// Functions that it calls.
  std::vector<nb::object> functions;
  /// Views that Python holds on the state.
  std::atomic<int> views{0};

 private:
  template <class Going>
  StepStatus loop(Going going);
  bool one_step(StepStatus& worst);

  std::optional<Simulation> own_;
  std::optional<Variant> variant_;
  std::unique_ptr<BuiltVariant> built_;
  Fault fault_;
  std::vector<std::uint32_t> inverted_;
  std::string trouble_;
  bool may_change_ = false;
  std::size_t first_vertices_ = 0;
  std::atomic<std::thread::id> stepping_{};
};

/// Reads the mesh files of scenes through Python's read_mesh, which knows all formats; or hands out a mesh that is given.
MeshLoader mesh_loader(std::optional<TetMesh> given = {});

}  // namespace glisson::python
