// live_simulation.cpp — see live_simulation.h.
#include "live_simulation.h"

#include <chrono>

namespace glisson::python {
namespace {

using Clock = std::chrono::steady_clock;

bool has_blade(const Variant& variant) {
  for (const InstrumentSpec& x : variant.instruments) {
    if (std::holds_alternative<BladeSpec>(x.what)) return true;
  }
  return false;
}

}  // namespace

LiveSimulation::LiveSimulation(TetMesh mesh, std::map<int, Tissue> tissues, const SimulationOptions& options)
    : own_(std::in_place, std::move(mesh), std::move(tissues), options), may_change_(options.mesh_changes) {}

LiveSimulation::LiveSimulation(const Variant& variant, const MeshLoader& load)
    : variant_(variant), built_(std::make_unique<BuiltVariant>(*variant_, load)),
      may_change_(variant.simulation.mesh_changes || has_blade(variant)) {}

Simulation& LiveSimulation::get() {
  const std::thread::id busy = stepping_;
  if (busy != std::thread::id{} && busy != std::this_thread::get_id()) {
    throw std::runtime_error("the simulation is stepping in another thread; wait for it, or read it from an observer");
  }
  return own_ ? *own_ : built_->simulation;
}

void LiveSimulation::refuse_views() const {
  if (views == 0 || may_change_) return;
  throw nb::buffer_error(
      "views of the state are held, and the body is about to move in memory: copy() and release them, or build the "
      "simulation with SimulationOptions(mesh_changes=True), which returns copies");
}

std::shared_ptr<Blade> LiveSimulation::attach_blade(const std::string& name, std::shared_ptr<ToolDriver> driver,
                                                    const Vec3d& direction, const BladeOptions& options, double every) {
  if (!(every >= 0.0)) {
    throw std::invalid_argument("attach_blade: cut_every = " + std::to_string(every) +
                                " s is outside the allowed range, >= 0");
  }
  refuse_views();
  Simulation& simulation = get();
  auto blade = std::make_shared<Blade>(simulation, name, std::move(driver), direction, options);
  simulation.attach(blade);
  may_change_ = true;
  blades_.push_back({blade, every, 0.0});
  return blade;
}

/// What blades of one's own have passed; those of scenes cut by themselves.
void LiveSimulation::cut() {
  try {
    for (Cutting& x : blades_) {
      const double time = (own_ ? *own_ : built_->simulation).time();
      if (time < x.next) continue;
      x.blade->cut();
      x.next = time + x.every;
    }
  } catch (...) {
    if (!fault_.raised) fault_.raised = std::current_exception();
  }
}

/// @return false where the step was not made or a callback has raised
bool LiveSimulation::one_step(StepStatus& worst) {
  const StepResult result = own_ ? own_->step() : built_->step();
  inverted_.assign(result.inverted_tets.begin(), result.inverted_tets.end());
  if (result.made()) cut();
  if (!result.made()) trouble_ = result.message;
  if (result.status != StepStatus::ok) worst = result.status;
  return result.made() && !fault_.raised;
}

/// Steps while `going()`, without the GIL.
template <class Going>
StepStatus LiveSimulation::loop(Going going) {
  get();
  if (stepping_.load() != std::thread::id{})
    throw std::runtime_error("a callback must not step the simulation that calls it");
  StepStatus worst = StepStatus::ok;
  bool interrupted = false;
  stepping_ = std::this_thread::get_id();
  Fault* outer = std::exchange(Fault::current(), &fault_);
  {
    const nb::gil_scoped_release free;
    Clock::time_point looked = Clock::now();
    while (!interrupted && going() && one_step(worst)) {
      if (Clock::now() - looked < std::chrono::milliseconds(20)) continue;
      looked = Clock::now();
      const nb::gil_scoped_acquire gil;
      interrupted = PyErr_CheckSignals() != 0;
    }
  }
  Fault::current() = outer;
  stepping_ = std::thread::id{};
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
  StepStatus worst = StepStatus::ok;
  const auto before = [this](double time) {
    const Simulation& s = own_ ? *own_ : built_->simulation;
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
