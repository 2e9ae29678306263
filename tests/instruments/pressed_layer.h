// pressed_layer.h — a quarter of a bonded layer that a tool on its axis presses into, until it rests.
#pragma once

#include "instruments/contact_scenes.h"
#include "support/layer_mesh.h"

namespace glisson::test {

struct PressedLayer {
  Simulation body;
  std::shared_ptr<ContactTool> tool;

  /// @param depth  below the surface, reached smoothly in `ramp` [m, s]
  /// @param rate  damping [1/s] @param step  mass is added to tets that do not bear it [s]; of an integrator with no h*: its step
  PressedLayer(const LayerOptions& layer, const Tissue& tissue, const Shape& shape, double friction, double depth,
               double ramp, double rate, double step, bool bonded = false,
               Integrator integrator = Integrator::central_difference)
      : body(layer_mesh(layer), {{0, tissue}}, options(rate, step, integrator)) {
    const auto& sets = body.mesh().vertex_sets;
    std::vector<std::uint32_t> bottom = sets.at("bottom");
    body.fix(bottom);
    const auto free_of_bottom = [&](const std::string& name) {
      std::vector<std::uint32_t> v = sets.at(name);
      std::erase_if(v, [&](std::uint32_t i) { return std::binary_search(bottom.begin(), bottom.end(), i); });
      return v;
    };
    body.fix(free_of_bottom("x_plane"), {true, false, false});
    body.fix(free_of_bottom("y_plane"), {false, true, false});
    ContactOptions o;
    o.shape = shape, o.friction = friction, o.bonded = bonded;
    const double top = layer.h;
    tool = std::make_shared<ContactTool>(o, std::make_shared<GivenPath>([=](double t) {
                                           return Pose{{0.0, 0.0, top - depth_at(t, depth, ramp)}};
                                         }));
    body.attach(tool);
  }
  static double depth_at(double time, double depth, double ramp) {
    const double s = std::min(1.0, time / ramp);
    return depth * s * s * (3.0 - 2.0 * s);
  }
  /// Fixes what the planes of symmetry do not hold of vertices.
  void hold_sideways(const std::vector<std::uint32_t>& vertices) {
    const auto& sets = body.mesh().vertex_sets;
    for (const std::uint32_t v : vertices) {
      const auto on = [&](const char* plane) {
        const auto& set = sets.at(plane);
        return std::find(set.begin(), set.end(), v) != set.end();
      };
      const Axes axes{!on("x_plane"), !on("y_plane"), false};
      if (axes.x || axes.y) body.fix(std::vector{v}, axes);
    }
  }
  static SimulationOptions options(double rate, double step, Integrator integrator) {
    SimulationOptions o;
    o.integrator = integrator;
    if (capabilities(integrator).any_step_is_stable) {
      o.step = step;
      return o;
    }
    o.damping_rate = rate, o.track_energies = false;
    if (step > 0.0) o.mass_scaling_step = step;
    return o;
  }
  /// On the whole tool: a quarter was pressed [N].
  double force() const { return -4.0 * tool->forces().total().z; }
};

}  // namespace glisson::test
