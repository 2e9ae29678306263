// live_simulation.h — a simulation as Python holds it: its own, or the body of a scene's variant.
//
//   step(n) ── GIL released ──▶ step … step ── every 20 ms, and some times a second within long steps: has Ctrl-C been pressed?
//                 │ a motion written in Python takes the GIL; what it raises is kept and raised when the step is done,
//                 ▼ because a step never throws
//
// One thread at a time: while one steps, the others' calls are refused, not answered with half a state. What its own functions may
// not call is refused by Simulation itself.
#pragma once

#include <atomic>
#include <optional>
#include <thread>

#include "bind.h"
#include "by_region.h"
#include "glisson/scene/scene.h"

namespace glisson::python {

/// What a Python function raised while the engine was calling it.
struct Fault {
  std::exception_ptr raised;
  /// Raises it, once. Needs the GIL.
  void rethrow() {
    if (raised) std::rethrow_exception(std::exchange(raised, nullptr));
  }
  /// Of the simulation that steps or changes in this thread; null: none does.
  static Fault*& current() {
    thread_local Fault* fault = nullptr;
    return fault;
  }
  /// While it lives, what is raised in this thread is kept in a fault.
  class Scope {
   public:
    explicit Scope(Fault& fault) : before_(std::exchange(current(), &fault)) {}
    ~Scope() { current() = before_; }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Fault* before_;
  };
};

/// What a function of time is to return.
template <class Value>
inline constexpr const char* kExpected = nullptr;
template <>
inline constexpr const char* kExpected<double> = "a number";
template <>
inline constexpr const char* kExpected<Vec3d> = "three numbers, a displacement [m]";
template <>
inline constexpr const char* kExpected<Pose> = "a Pose";

/// A Python function that the engine may call; after it has raised, its last value stands until the step is done.
template <class Value>
class Callback {
 public:
  /// Keeps the function. @param name  of the argument that it was given for @throws nb::type_error where it is no function
  Callback(const char* name, nb::object function) : name_(name), function_(callable(name, function)) {
    keeper_ = std::shared_ptr<nb::object>(new nb::object(std::move(function)), [](nb::object* f) {
      const nb::gil_scoped_acquire gil;
      delete f;
    });
  }
  /// The function is kept by `keeper`, where the garbage collector sees it: it may refer to what calls it.
  Callback(const char* name, nb::object function, std::vector<nb::object>& keeper)
      : name_(name), function_(callable(name, function)) {
    keeper.push_back(std::move(function));
  }
  Value operator()(double time) {
    Fault* fault = Fault::current();
    if (fault && fault->raised) return last_;
    const nb::gil_scoped_acquire gil;
    try {
      last_ = returned<Value>(name_, function_(time), kExpected<Value>);
    } catch (...) {
      if (!fault) throw;
      fault->raised = std::current_exception();
    }
    return last_;
  }

 private:
  static nb::handle callable(const char* name, const nb::object& given) {
    if (PyCallable_Check(given.ptr()) != 0) return given;
    throw nb::type_error((std::string(name) + " = " + nb::cast<std::string>(nb::repr(given)) +
                          " is no function of time [s] that returns " + kExpected<Value>)
                             .c_str());
  }

  const char* name_;
  nb::handle function_;
  std::shared_ptr<nb::object> keeper_;
  Value last_{};
};

/// Raised where a step was not made.
class StepError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @param busy  the thread that steps a simulation, if any does @throws std::runtime_error where that is another one
void require_no_other_steps(std::thread::id busy);

/// Adds what calls a function of the caller's; that of something refused is not kept.
template <class Live, class Add>
auto keeping_functions(Live& live, const Add& add) {
  live.get();
  const auto before = static_cast<std::ptrdiff_t>(live.functions.size());
  try {
    return add();
  } catch (...) {
    live.functions.erase(live.functions.begin() + before, live.functions.end());
    throw;
  }
}

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
  /// Changes the body by `act(simulation)`; what Python functions raise meanwhile is raised when all has followed the change.
  template <class Act>
  auto change(const Act& act) {
    Simulation& simulation = get();
    const Fault::Scope scope(fault_);
    if constexpr (std::is_void_v<decltype(act(simulation))>) {
      act(simulation);
      fault_.rethrow();
    } else {
      auto result = act(simulation);
      fault_.rethrow();
      return result;
    }
  }
  /// The arrays of the state are copies from then on where it changes the body.
  void attach(const std::shared_ptr<Interaction>& interaction);

  /// Functions that it calls.
  std::vector<nb::object> functions;
  /// Views that Python holds on the state.
  std::atomic<int> views{0};

 private:
  class Stepping;
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
