// needle_scenes.h — a cylinder of soft tissue held at its bottom and wall, and a needle over it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "glisson/instruments/needle.h"
#include "glisson/instruments/tool_motion.h"
#include "glisson/simulation/simulation.h"

namespace glisson::test {

struct Insertion {
  CylinderOptions mesh{.radius = 0.03, .height = 0.04, .radial_cells = 6, .axial_cells = 8, .grading = 3.0};
  double youngs_modulus = 5000.0;
  double viscosity = 0.0;
  std::vector<MaxwellBranch> maxwell{};
  NeedleOptions needle{};
  std::vector<Stroke> strokes{{.to = {0, 0, -0.02}, .velocity = 0.01, .ramp = 0.0, .rest = 0.0}};
  std::optional<PushMotion> push{};  ///< in the place of the strokes
  Vec3d start{0.0, 0.0, 0.0405};
  double inner_boundary = -1.0;  ///< height below which the tissue is of region 1 [m]; −1: none
  SimulationOptions options{};
  Pose frame{};  ///< by which all of it is turned and moved

  Insertion() {
    needle.rupture.force = 0.3;
    needle.tip.cutting = 0.1;
    needle.friction = {.static_in = 20,
                       .static_out = 20,
                       .dynamic_in = 10,
                       .dynamic_out = 12,
                       .viscous_in = 200,
                       .viscous_out = 200,
                       .stick_speed = 1e-4};
    options.damping_rate = 20.0;
  }
};

struct Inserted {
  Simulation simulation;
  std::shared_ptr<Needle> needle;
  ConstraintId held;
  double end;  ///< of the motion [s]
};

inline TetMesh mesh_of(const Insertion& o) {
  TetMesh mesh = cylinder_mesh(o.mesh);
  if (o.inner_boundary < 0.0) return mesh;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    double z = 0.0;
    for (const std::uint32_t v : mesh.tets[t]) z += 0.25 * mesh.vertices[v].z;
    mesh.regions.push_back(z < o.inner_boundary ? 1 : 0);
  }
  return mesh;
}

inline Inserted insert(const Insertion& o) {
  TetMesh mesh = mesh_of(o);
  Tissue tissue;
  tissue.youngs_modulus = o.youngs_modulus;
  tissue.poisson_ratio = 0.45;
  tissue.viscosity = o.viscosity;
  tissue.maxwell = o.maxwell;
  tissue.maxwell_part = MaxwellPart::all;
  std::vector<std::uint32_t> held = mesh.vertex_sets.at("bottom");
  for (const std::uint32_t v : mesh.vertex_sets.at("wall")) {
    if (mesh.vertices[v].z > 1e-9) held.push_back(v);
  }
  const auto turned = [&o](const Vec3d& x) { return o.frame.axes * x; };
  for (Vec3d& x : mesh.vertices) x = turned(x) + o.frame.position;
  std::vector<Stroke> strokes = o.strokes;
  for (Stroke& stroke : strokes) stroke.to = turned(stroke.to);
  NeedleOptions options = o.needle;
  options.direction = turned(options.direction);
  options.bevel_side = turned(options.bevel_side);
  Simulation simulation(mesh, {{0, tissue}, {1, tissue}}, o.options);
  const ConstraintId support = simulation.fix(held);
  const ToolPath path = stroke_path({.start = 0.0, .strokes = strokes});
  const Pose start{turned(o.start) + o.frame.position};
  std::shared_ptr<ToolDriver> driver = std::make_shared<PathDriver>(start, path);
  if (o.push) driver = std::make_shared<PushDriver>(start, *o.push);
  auto needle = std::make_shared<Needle>(options, driver);
  simulation.attach(needle);
  return {std::move(simulation), std::move(needle), support, *path.end};
}

/// Steps until a time [s]; what each step was like is handed to `look`.
template <class Look>
void run_to(Inserted& run, double time, Look look) {
  while (run.simulation.time() < time) {
    const StepStatus status = run.simulation.step().status;
    if (status != StepStatus::ok && status != StepStatus::inverted) throw std::runtime_error("a step was not made");
    look();
  }
}
inline void run_to(Inserted& run, double time) {
  run_to(run, time, [] {});
}

/// Force along the needle on the tissue [N].
inline double pushed(const Needle& needle) { return dot(needle.forces().total(), needle.direction()); }

inline const InstrumentEvent* event(const Needle& needle, const std::string& name) {
  for (const InstrumentEvent& e : needle.events()) {
    if (e.event == name) return &e;
  }
  return nullptr;
}

}  // namespace glisson::test
