// bind_own.cpp — drivers and interactions written in Python.
//
//   Simulation::step ──▶ OwnDriver::advance ──▶ takes the GIL ──▶ def advance(self, time, h, on_tool)
//
// A step never throws: what a method raises is kept, the tool stays where it is and the interaction does nothing until the
// step is done, and then it comes out of step() or advance() as it is. A call into Python takes some microseconds, as long
// as a step of a small body.
#include "glisson/archive.h"
#include "glisson/instruments/instrument.h"
#include "live_simulation.h"

namespace glisson::python {
namespace {

/// Calls `method` of a Python object unless something was raised before in this step; keeps what it raises.
/// @return none where it was not called or has raised
std::optional<nb::object> call_kept(nb::handle self, const char* method, const auto&... arguments) {
  Fault* fault = Fault::current();
  if (fault && fault->raised) return {};
  try {
    return nb::object(self.attr(method)(arguments...));
  } catch (...) {
    if (!fault) throw;
    fault->raised = std::current_exception();
    return {};
  }
}

/// What past() of a Python object gives, or restore() takes.
void archive_own(Archive& ar, nb::handle self) {
  std::vector<double> numbers;
  if (!ar.reads()) numbers = returned<std::vector<double>>("past", self.attr("past")(), "a list of numbers");
  ar(numbers);
  ar.check(!ar.reads() ||
           returned<bool>("restore", self.attr("restore")(numbers), "True, or False where they do not fit"));
}

/// Leads a tool by a method of a subclass, or by a function.
class OwnDriver : public ToolDriver {
 public:
  OwnDriver(const Pose& start, std::optional<double> end) : start_(start), last_(start), end_(end) {}

  Pose start() const override { return start_; }
  std::optional<double> end() const override { return end_; }
  void set_bounds(const PoseBounds& bounds) override { bounds_ = bounds; }
  /// A pose that makes no sense is handed on, for the tool to count it, but not kept.
  Pose advance(double time, double h, const Wrench& on_tool) override {
    const nb::gil_scoped_acquire gil;
    try {
      const std::optional<nb::object> given = call_kept(nb::find(*this), "advance", time, h, on_tool);
      if (!given) return last_;
      const Pose pose = pose_of(*given);
      if (bounds_.holds(pose)) last_ = pose;
      return pose;
    } catch (...) {
      if (!Fault::current()) throw;
      Fault::current()->raised = std::current_exception();
    }
    return last_;
  }
  void archive(Archive& ar) override {
    const nb::gil_scoped_acquire gil;
    ar(last_);
    archive_own(ar, nb::find(*this));
  }

 private:
  /// A Pose, or its position alone.
  Pose pose_of(const nb::object& given) const {
    Pose pose = last_;
    if (nb::try_cast<Vec3d>(given, pose.position)) return pose;
    return returned<Pose>("advance", given, "a Pose, or three numbers for its position");
  }

  Pose start_, last_;  ///< the last good one
  std::optional<double> end_;
  PoseBounds bounds_;
};

/// A step as an interaction in Python sees it; only while it is called.
class OwnStep {
 public:
  explicit OwnStep(const InteractionStep& step) : step_(&step) {}
  void close() { step_ = nullptr; }

  const InteractionStep& get() const {
    if (step_ != nullptr) return *step_;
    throw std::runtime_error("the step is over: read it in add_forces, declare, solved or moved, and keep copies");
  }
  template <class Read>
  Doubles each(const Read& read) const {
    std::vector<Vec3d> values;
    for (std::size_t k = 0; k < get().vertices.size(); ++k) values.push_back(read(k));
    return vectors(std::move(values));
  }
  Numbers numbers() const {
    std::vector<std::uint32_t> numbers;
    for (const ActiveVertex& w : get().vertices) numbers.push_back(w.vertex);
    return indices(std::move(numbers));
  }
  /// Places of vertices.
  std::vector<std::uint32_t> places(nb::handle which) const {
    std::vector<std::uint32_t> places = to_indices(which, 1, "vertices");
    for (std::uint32_t& v : places) {
      const std::uint32_t place = v < get().place_of.size() ? get().place_of[v] : InteractionStep::kNowhere;
      if (place == InteractionStep::kNowhere) {
        throw nb::value_error(("vertex " + std::to_string(v) + " is not active; name it in reach()").c_str());
      }
      v = place;
    }
    return places;
  }
  /// Places of vertices, and as many vectors.
  std::pair<std::vector<std::uint32_t>, std::vector<Vec3d>> placed(nb::handle which, const ArrayLike& given,
                                                                   const char* name) const {
    std::vector<std::uint32_t> where = places(which);
    std::vector<Vec3d> values = to_vectors(given, name);
    if (where.size() != values.size()) {
      throw nb::value_error(
          (std::to_string(where.size()) + " vertices, but " + std::to_string(values.size()) + " " + name).c_str());
    }
    return {std::move(where), std::move(values)};
  }
  void add_force(nb::handle which, const ArrayLike& forces, bool viscous) const {
    const auto [places, values] = placed(which, forces, "forces");
    for (std::size_t k = 0; k < places.size(); ++k) {
      ActiveVertex& w = get().vertices[places[k]];
      (viscous ? w.viscous : w.elastic) += values[k];
    }
  }

 private:
  const InteractionStep* step_;
};

/// The rows of an interaction in Python; only while it is called.
class OwnRows {
 public:
  OwnRows(const OwnStep& step, StepRows& rows) : step_(&step), rows_(&rows) {}
  void close() { step_ = nullptr, rows_ = nullptr; }

  void hold(nb::handle which, const ArrayLike& velocities) const {
    const auto [places, values] = step().placed(which, velocities, "velocities");
    for (std::size_t k = 0; k < places.size(); ++k) rows().hold(places[k], values[k]);
  }
  void push(nb::handle which, const ArrayLike& impulses) const {
    const auto [places, values] = step().placed(which, impulses, "impulses");
    for (std::size_t k = 0; k < places.size(); ++k) rows().push(places[k], values[k]);
  }
  void press(nb::handle which, const Vec3d& point, const Vec3d& normal, const Vec3d& velocity, double friction) const {
    if (!(norm(normal) > 0.0)) throw nb::value_error("normal is zero; give the direction that leads out of the wall");
    if (!(friction >= 0.0)) throw nb::value_error("friction must be 0 or more");
    for (const std::uint32_t place : step().places(which)) {
      rows().press(step().get(), place, {.point = point, .normal = normal, .velocity = velocity, .friction = friction});
    }
  }
  Doubles held() const {
    return each(rows().hold_count(), [&](std::size_t k) { return rows().holding_impulse(k); });
  }
  Doubles pressed() const {
    return each(rows().press_count(), [&](std::size_t k) { return rows().pressing_impulse(k); });
  }

 private:
  template <class Read>
  Doubles each(std::size_t count, const Read& read) const {
    std::vector<Vec3d> values;
    for (std::size_t k = 0; k < count; ++k) values.push_back(read(k));
    return vectors(std::move(values));
  }
  const OwnStep& step() const {
    if (step_ == nullptr) throw std::runtime_error("the step is over: use rows in declare and solved, and keep copies");
    return *step_;
  }
  StepRows& rows() const {
    step();
    return *rows_;
  }

  const OwnStep* step_;
  StepRows* rows_;
};

/// An interaction whose members are methods of a subclass in Python.
class OwnInteraction : public Interaction {
 public:
  void attached(const BodyView& body, double time) override {
    const nb::gil_scoped_acquire gil;
    vertex_count_ = body.mesh.vertices.size();
    nb::find(*this).attr("attached")(body.mesh, time);
    squared_frequency_ = returned<double>("squared_frequency", nb::find(*this).attr("squared_frequency")(), "a number");
  }
  void body_changed(const BodyView& body, std::span<const std::uint32_t> origins) override {
    const nb::gil_scoped_acquire gil;
    vertex_count_ = body.mesh.vertices.size();
    keeping([&] { call_kept(nb::find(*this), "body_changed", body.mesh, indices({origins.begin(), origins.end()})); });
  }
  std::span<const std::uint32_t> reach(double time, double h) override {
    const nb::gil_scoped_acquire gil;
    reached_.clear();
    keeping([&] {
      const std::optional<nb::object> named = call_kept(nb::find(*this), "reach", time, h);
      if (named) reached_ = to_indices(*named, 1, "what reach() returned");
      for (const std::uint32_t v : reached_) {
        if (v < vertex_count_) continue;
        reached_.clear();
        throw nb::value_error(
            ("reach() names vertex " + std::to_string(v) + " of " + std::to_string(vertex_count_)).c_str());
      }
    });
    return reached_;
  }
  void add_forces(const InteractionStep& step) override { hand("add_forces", step); }
  void declare(const InteractionStep& step, StepRows& rows, int round) override {
    if (round == 0) hand("declare", step, rows);
  }
  /// Reading changes no row.
  void solved(const InteractionStep& step, const StepRows& rows) override {
    hand("solved", step, const_cast<StepRows&>(rows));
  }
  void moved(const InteractionStep& step) override {
    hand("moved", step);
    const nb::gil_scoped_acquire gil;
    keeping([&] {
      const std::optional<nb::object> w = call_kept(nb::find(*this), "squared_frequency");
      if (w) squared_frequency_ = returned<double>("squared_frequency", *w, "a number");
    });
  }
  double squared_frequency() const override { return squared_frequency_; }
  void archive(Archive& ar) override {
    const nb::gil_scoped_acquire gil;
    archive_own(ar, nb::find(*this));
  }

 private:
  /// Within a step what goes wrong is kept.
  static void keeping(const auto& act) {
    try {
      act();
    } catch (...) {
      if (!Fault::current()) throw;
      if (!Fault::current()->raised) Fault::current()->raised = std::current_exception();
    }
  }
  void hand(const char* method, const InteractionStep& step) {
    const nb::gil_scoped_acquire gil;
    keeping([&] {
      const nb::object seen = nb::cast(OwnStep(step), nb::rv_policy::move);
      call_kept(nb::find(*this), method, seen);
      nb::cast<OwnStep&>(seen).close();
    });
  }

  void hand(const char* method, const InteractionStep& step, StepRows& rows) {
    const nb::gil_scoped_acquire gil;
    keeping([&] {
      const nb::object seen = nb::cast(OwnStep(step), nb::rv_policy::move);
      const nb::object wanted = nb::cast(OwnRows(nb::cast<OwnStep&>(seen), rows), nb::rv_policy::move);
      call_kept(nb::find(*this), method, seen, wanted);
      nb::cast<OwnStep&>(seen).close(), nb::cast<OwnRows&>(wanted).close();
    });
  }

  std::size_t vertex_count_ = 0;
  std::vector<std::uint32_t> reached_;
  double squared_frequency_ = 0.0;
};

void bind_step(nb::module_& m) {
  const auto of = [](const char* member) { return doc(std::string("InteractionStep::") + member); };
  const auto watched = [](const char* member) { return doc(std::string("ActiveVertex::") + member); };
  nb::class_<OwnStep>(m, "InteractionStep",
                      "The active vertices in a step, for an Interaction: arrays in the order of `vertices`, copies. "
                      "Valid only in the call that receives it.")
      .def_prop_ro(
          "time", [](const OwnStep& s) { return s.get().time; }, of("time"))
      .def_prop_ro(
          "h", [](const OwnStep& s) { return s.get().h; }, of("h"))
      .def_prop_ro("vertices", &OwnStep::numbers, "Numbers of the active vertices, ascending")
      .def_prop_ro(
          "positions", [](const OwnStep& s) { return s.each([&](std::size_t k) { return s.get().position(k); }); },
          of("position"))
      .def_prop_ro(
          "displacement",
          [](const OwnStep& s) { return s.each([&](std::size_t k) { return s.get().vertices[k].displacement; }); },
          watched("displacement"))
      .def_prop_ro(
          "velocity",
          [](const OwnStep& s) { return s.each([&](std::size_t k) { return s.get().vertices[k].velocity; }); },
          of("vertices"))
      .def_prop_ro(
          "elastic",
          [](const OwnStep& s) { return s.each([&](std::size_t k) { return s.get().vertices[k].elastic; }); },
          watched("elastic"))
      .def_prop_ro(
          "viscous",
          [](const OwnStep& s) { return s.each([&](std::size_t k) { return s.get().vertices[k].viscous; }); },
          watched("viscous"))
      .def_prop_ro(
          "mobility",
          [](const OwnStep& s) {
            return s.each([&](std::size_t k) { return s.get().mobility.empty() ? Vec3d{} : s.get().mobility[k]; });
          },
          of("mobility"))
      .def("add_force", &OwnStep::add_force, "vertices"_a, "forces"_a, "viscous"_a = false,
           "In add_forces: forces [N], (n, 3), on active vertices. They count as elastic or as viscous forces in the "
           "energy balance.");
  nb::class_<OwnRows>(
      m, "StepRows",
      "What an Interaction wants of the body at the end of a step; one solver meets the rows of all tools "
      "together. Valid only in the call that receives it.")
      .def(
          "hold", &OwnRows::hold, "vertices"_a, "velocities"_a,
          "In declare: active vertices end the step with these velocities [m/s], (n, 3), whatever impulses that takes; "
          "what a support holds stays. A vertex that several tools hold gets the mean of what they want.")
      .def("push", &OwnRows::push, "vertices"_a, "impulses"_a,
           "In declare: impulses [N s], (n, 3), on active vertices; held components do not move.")
      .def("press", &OwnRows::press, "vertices"_a, "point"_a, "normal"_a, "velocity"_a = Vec3d{}, "friction"_a = 0.0,
           "In declare: active vertices end the step outside a wall, with Coulomb's friction.\n\n"
           ":param point: on the wall at the start of the step [m]\n:param normal: outward, of any length\n"
           ":param velocity: of the wall [m/s]")
      .def_prop_ro(
          "held", &OwnRows::held,
          "In solved: impulses on the vertices that were held, (n, 3), in the order in which they were declared [N s]")
      .def_prop_ro(
          "pressed", &OwnRows::pressed,
          "In solved: impulses of walls, (n, 3), in the order in which vertices were declared; 0 for those that "
          "did not come near [N s]");
}

constexpr const char* kInteraction =
    "Base of your own interaction with a body: subclass it, override the methods you need, and attach it.\n\n"
    "    class Spring(glisson.OwnInteraction):\n"
    "        def reach(self, time, h):\n"
    "            return [212]                                       # active vertices\n"
    "        def add_forces(self, step):\n"
    "            step.add_force([212], -200.0 * step.displacement[step.vertices == 212])\n"
    "        def squared_frequency(self):\n"
    "            return 200.0 / 1e-4                                # upper bound of stiffness over mass [1/s^2]\n\n"
    "Each method that is overridden is called in every step and takes some microseconds there, as long as a step of a "
    "small "
    "body: for prototypes. An exception in a method ends the stepping and is raised unchanged.";

}  // namespace

void bind_own_driver(nb::module_& m) {
  Results<Wrench>(m, "Wrench").read("force", &Wrench::force).read("torque", &Wrench::torque);
  nb::class_<OwnDriver, ToolDriver>(
      m, "OwnDriver",
      "Moves a tool by your own code: subclass it and override advance(); for a function use FunctionDriver.\n\n"
      "advance is called once a step, which takes some microseconds; an exception ends the stepping and is raised "
      "unchanged. It must not hold the Simulation: the reference cycle would never be freed.")
      .def(nb::init<const Pose&, std::optional<double>>(), "start"_a, "end"_a = nb::none(),
           ":param start: where the tool starts\n:param end: time at which the motion has ended [s]; none: it does not "
           "end by "
           "itself")
      .def(
          "advance",
          [](nb::handle, double, double, const Wrench&) -> nb::object {
            throw nb::type_error("OwnDriver.advance(self, time, h, on_tool) is to be overridden by a subclass");
          },
          "time"_a, "h"_a, "on_tool"_a, doc("ToolDriver::advance"),
          nb::sig("def advance(self, time: float, h: float, on_tool: Wrench) -> Pose | "
                  "collections.abc.Sequence[float] | numpy.typing.NDArray[typing.Any]"))
      .def(
          "past", [](const OwnDriver&) { return std::vector<double>{}; },
          "Numbers that a checkpoint is to have besides the pose; to be overridden with restore()",
          nb::sig("def past(self) -> collections.abc.Sequence[float]"))
      .def(
          "restore", [](OwnDriver&, const std::vector<double>& past) { return past.empty(); }, "past"_a,
          "Takes them back. :return: False where they are not those of such a driver");
}

void bind_own_interaction(nb::module_& m) {
  bind_step(m);
  const auto of = [](const char* member) { return doc(std::string("Interaction::") + member); };
  nb::class_<OwnInteraction, Interaction>(m, "OwnInteraction", kInteraction)
      .def(nb::init<>())
      .def(
          "attached", [](OwnInteraction&, const TetMesh&, double) {}, "mesh"_a, "time"_a, of("attached"))
      .def(
          "body_changed", [](OwnInteraction&, const TetMesh&, const ArrayLike&) {}, "mesh"_a, "origins"_a,
          of("body_changed"))
      .def(
          "reach", [](OwnInteraction&, double, double) { return nb::list(); }, "time"_a, "h"_a, of("reach"),
          nb::sig("def reach(self, time: float, h: float) -> numpy.typing.ArrayLike"))
      .def(
          "add_forces", [](OwnInteraction&, const OwnStep&) {}, "step"_a, of("add_forces"))
      .def(
          "declare", [](OwnInteraction&, const OwnStep&, const OwnRows&) {}, "step"_a, "rows"_a,
          "Declares what is to hold at the end of the step; velocities are those without any tool.")
      .def(
          "solved", [](OwnInteraction&, const OwnStep&, const OwnRows&) {}, "step"_a, "rows"_a, of("solved"))
      .def(
          "moved", [](OwnInteraction&, const OwnStep&) {}, "step"_a, of("moved"))
      .def(
          "squared_frequency", [](const OwnInteraction&) { return 0.0; }, of("squared_frequency"))
      .def(
          "past", [](const OwnInteraction&) { return std::vector<double>{}; },
          "Its history, as numbers for a checkpoint; to be overridden with restore()",
          nb::sig("def past(self) -> collections.abc.Sequence[float]"))
      .def(
          "restore", [](OwnInteraction&, const std::vector<double>& past) { return past.empty(); }, "past"_a,
          "Takes them back to the last bit. :return: False where they are not those of such an interaction");
}

}  // namespace glisson::python
