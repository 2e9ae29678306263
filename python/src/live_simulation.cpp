// live_simulation.cpp — see live_simulation.h.
#include "live_simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "glisson/simulation/simulation.h"

namespace glisson::python {
namespace {

using Clock = std::chrono::steady_clock;

bool cuts(const BuiltVariant& built) {
  return std::any_of(built.instruments.begin(), built.instruments.end(),
                     [](const auto& x) { return x->changes_body(); });
}

/// Lets a simulation ask within long steps, while it lives.
class Asking {
 public:
  Asking(Simulation& simulation, std::function<bool(const StepProgress&)> asks) : simulation_(simulation) {
    simulation_.set_interrupt(std::move(asks));
  }
  ~Asking() { simulation_.set_interrupt({}); }
  Asking(const Asking&) = delete;
  Asking& operator=(const Asking&) = delete;

 private:
  Simulation& simulation_;
};

/// Whether the state moves in memory: with changes of the mesh, and in steps that are solved for, which may be taken back.
bool moves(const SimulationOptions& options) {
  return options.mesh_changes || capabilities(options.integrator).any_step_is_stable;
}

}  // namespace

void require_no_other_steps(std::thread::id busy) {
  if (busy == std::thread::id{} || busy == std::this_thread::get_id()) return;
  throw std::runtime_error("the simulation is stepping in another thread; wait for it, or read it from an observer");
}

LiveSimulation::LiveSimulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options)
    : own_(std::in_place, std::move(mesh), std::move(tissues), options), may_change_(moves(options)),
      first_vertices_(own_->mesh().vertices.size()) {}

LiveSimulation::LiveSimulation(const Variant& variant, const MeshLoader& load)
    : variant_(variant), built_(std::make_unique<BuiltVariant>(*variant_, load)),
      may_change_(moves(variant.simulation) || cuts(*built_)),
      first_vertices_(built_->simulation.mesh().vertices.size()) {}

Simulation& LiveSimulation::get() {
  require_no_other_steps(stepping_);
  return own_ ? *own_ : built_->simulation;
}

void LiveSimulation::refuse_views() const {
  if (views == 0 || may_change_) return;
  throw nb::buffer_error(
      "views of the state are held, and the body is about to move in memory: copy() and release them, or build the "
      "simulation with SimulationOptions(mesh_changes=True), which returns copies");
}

void LiveSimulation::attach(const std::shared_ptr<Interaction>& interaction) {
  Simulation& simulation = get();
  const bool changes = interaction && interaction->changes_body();
  if (changes) refuse_views();
  simulation.attach(interaction);
  may_change_ = may_change_ || changes;
}

/// While it lives, this thread steps; a step within a step ends with what was before.
class LiveSimulation::Stepping {
 public:
  explicit Stepping(LiveSimulation& live)
      : live_(live), thread_(live.stepping_.exchange(std::this_thread::get_id())), scope_(live.fault_) {}
  ~Stepping() { live_.stepping_ = thread_; }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

 private:
  LiveSimulation& live_;
  std::thread::id thread_;
  Fault::Scope scope_;
};

/// @return false where the step was not made or a callback has raised
bool LiveSimulation::one_step(StepStatus& worst) {
  const StepResult result = (own_ ? *own_ : built_->simulation).step();
  inverted_.assign(result.inverted_tets.begin(), result.inverted_tets.end());
  if (!result.made()) trouble_ = result.message;
  if (result.status != StepStatus::ok) worst = result.status;
  return result.made() && !fault_.raised;
}

/// Steps while `going()`, without the GIL.
template <class Going>
StepStatus LiveSimulation::loop(Going going) {
  get();
  fault_.raised = nullptr;  // of a step that itself has thrown
  StepStatus worst = StepStatus::ok;
  bool interrupted = false;
  const auto look = [&interrupted](const StepProgress&) {
    const nb::gil_scoped_acquire gil;
    return interrupted = interrupted || PyErr_CheckSignals() != 0;
  };
  std::optional<Asking> asking;  // not from inside a step, which step() refuses
  if (stepping_.load() == std::thread::id{}) asking.emplace(own_ ? *own_ : built_->simulation, look);
  {
    const Stepping stepping(*this);
    const nb::gil_scoped_release free;
    Clock::time_point looked = Clock::now();
    while (!interrupted && going() && one_step(worst)) {
      if (Clock::now() - looked < std::chrono::milliseconds(20)) continue;
      looked = Clock::now();
      look({});
    }
  }
  if (interrupted) throw nb::python_error();
  fault_.rethrow();
  if (worst != StepStatus::ok && worst != StepStatus::inverted) {
    throw StepError(trouble_);
  }
  if (views > 0) get().displacement();  // brings what the views show up to date
  return worst;
}

StepStatus LiveSimulation::step(std::uint64_t n) {
  return loop([&n] { return n-- > 0; });
}

StepStatus LiveSimulation::advance(double until, const std::optional<std::function<void()>>& observer,
                                   std::optional<double> every) {
  if (!std::isfinite(until)) {
    throw nb::value_error(("advance: until = " + std::to_string(until) + " is not finite; give a time [s]").c_str());
  }
  if (every && !(*every > 0.0)) {
    throw nb::value_error(("advance: every = " + std::to_string(*every) + " is not positive; give a time [s]").c_str());
  }
  get().advance_to(get().time());  // makes no step; throws where it was called from inside one
  StepStatus worst = StepStatus::ok;
  const auto before = [this](double time) {
    Simulation& s = own_ ? *own_ : built_->simulation;
    s.set_step_end(time);
    return time - s.time() > 0.5 * s.step_size();
  };
  const double start = get().time();
  for (std::uint64_t k = 1; before(until); ++k) {
    const double next = observer && every ? std::min(until, start + static_cast<double>(k) * *every) : until;
    const StepStatus status = loop([&] { return before(next); });
    if (status != StepStatus::ok) worst = status;
    if (observer) (*observer)();
  }
  return worst;
}

MeshLoader mesh_loader(std::optional<TetMesh> given) {
  return [given = std::move(given)](const MeshFile& file) {
    if (given) return *given;
    const nb::gil_scoped_acquire gil;
    return nb::cast<TetMesh>(nb::module_::import_("glisson").attr("read_mesh")(file.path, file.scale));
  };
}

}  // namespace glisson::python
