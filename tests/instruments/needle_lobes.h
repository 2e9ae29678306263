// needle_lobes.h — lobes of tissue one behind the other, held at their sides, and a needle that goes through them.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "instruments/contact_scenes.h"
#include "instruments/needle_scenes.h"

namespace glisson::test {

/// Lobes of 24 × 24 × 8 mm from z = 0 down; a slab of 20 × 20 × 10 mm.
struct LobeScene {
  Integrator integrator = Integrator::central_difference;
  double step = 0.005;  ///< of long steps [s]; of short ones kShortStep, or else their own
  double gap = 0.006;   ///< [m]
  int number = 2;       ///< of lobes
  NeedleOptions needle{};
  std::vector<Stroke> strokes{{.to = {0, 0, -0.021}, .velocity = 0.04, .ramp = 0.0, .rest = 0.0}};
  Pose frame{};  ///< by which all of it is turned and moved

  LobeScene() {
    needle.diameter = 8e-4, needle.length = 0.08, needle.zone = 4e-3, needle.spacing = 1e-3;
    needle.rupture.force = 0.06, needle.tip.cutting = 0.03;
    needle.friction = {.static_in = 5, .static_out = 5, .dynamic_in = 4, .dynamic_out = 4};
  }
};

struct Lobes {
  Simulation simulation;
  std::shared_ptr<Needle> needle;
  double end;  ///< of the motion [s]
};

inline Lobes into(TetMesh mesh, const LobeScene& o, double half_width) {
  Tissue tissue;
  tissue.youngs_modulus = 20000.0, tissue.poisson_ratio = 0.4;
  tissue.kinematics = Kinematics::corotational;
  std::vector<std::uint32_t> held;
  for (std::uint32_t v = 0; v < mesh.vertices.size(); ++v) {
    if (std::abs(mesh.vertices[v].x) > half_width - 1e-9) held.push_back(v);
  }
  for (Vec3d& x : mesh.vertices) x = o.frame.axes * x + o.frame.position;
  SimulationOptions options = in_steps_of(o.integrator, o.step);
  options.damping_rate = 60.0;
  NeedleOptions needle = o.needle;
  needle.direction = o.frame.axes * needle.direction;
  std::vector<Stroke> strokes = o.strokes;
  for (Stroke& stroke : strokes) stroke.to = o.frame.axes * stroke.to;
  const ToolPath path = stroke_path({.start = 0.0, .strokes = strokes});
  Lobes run{Simulation(mesh, {{0, tissue}}, options), nullptr, *path.end};
  run.simulation.fix(held);
  run.needle = std::make_shared<Needle>(
      needle, std::make_shared<PathDriver>(Pose{o.frame.axes * Vec3d{0, 0, 5e-4} + o.frame.position}, path));
  run.simulation.attach(run.needle);
  return run;
}

inline TetMesh lobe_mesh(int number, double gap) {
  TetMesh all;
  for (int k = 0; k < number; ++k) {
    const double top = -(0.008 + gap) * k;
    const TetMesh one = box_mesh({.cells = {8, 8, 4},
                                  .size = {0.024, 0.024, 0.008},
                                  .origin = {-0.012, -0.012, top - 0.008},
                                  .split = BoxSplit::alternating});
    const auto first = static_cast<std::uint32_t>(all.vertices.size());
    all.vertices.insert(all.vertices.end(), one.vertices.begin(), one.vertices.end());
    for (Tet tet : one.tets) {
      for (std::uint32_t& v : tet) v += first;
      all.tets.push_back(tet);
    }
  }
  return all;
}

inline Lobes lobes(const LobeScene& o) { return into(lobe_mesh(o.number, o.gap), o, 0.012); }

inline Lobes far_slab(const LobeScene& o) {
  return into(box_mesh({.cells = {8, 8, 4},
                        .size = {0.02, 0.02, 0.01},
                        .origin = {-0.01, -0.01, -0.01},
                        .split = BoxSplit::alternating}),
              o, 0.01);
}

/// Steps to the end of the motion, or to a time [s].
template <class Look>
void run_to(Lobes& run, Look look, double end = 1e300) {
  while (run.simulation.time() < std::min(end, run.end) - 1e-9) {
    const StepResult r = run.simulation.step();
    if (!r.made()) throw std::runtime_error(std::string("a step was not made: ").append(r.message));
    look();
  }
}

inline void run_until(Lobes& run, double end = 1e300) {
  run_to(
      run, [] {}, end);
}

/// Of a needle's line up to its tip, what lies in the deformed body, by its surface alone [m].
inline double length_inside(const std::vector<Triangle>& surface, const Lobes& run) {
  const std::vector<Vec3d> x = run.simulation.positions();
  const Needle& needle = *run.needle;
  const Vec3d tip = needle.pose().position, d = needle.direction(),
              aside{1.3e-7, 2.1e-7, 0.0};  // off edges and corners
  double sum = 0.0;
  for (const Triangle& t : surface) {
    const Vec3d a = x[t[0]] - tip + aside, b = x[t[1]] - tip + aside, c = x[t[2]] - tip + aside;
    const double w0 = dot(d, cross(b, c)), w1 = dot(d, cross(c, a)), w2 = dot(d, cross(a, b)), all = w0 + w1 + w2;
    if (all == 0.0 || w0 / all < 0.0 || w1 / all < 0.0 || w2 / all < 0.0) continue;
    const double ahead = dot((a * w0 + b * w1 + c * w2) * (1.0 / all), d);  // of the tip
    if (ahead < 0.0) sum += dot(cross(b - a, c - a), d) > 0.0 ? ahead : -ahead;
  }
  return std::max(0.0, sum);
}

inline std::string words_of(const Needle& needle) {
  std::string all;
  for (const InstrumentEvent& e : needle.events()) all += (all.empty() ? "" : " ") + e.event;
  return all;
}

}  // namespace glisson::test
