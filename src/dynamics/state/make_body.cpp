#include "dynamics/state/make_body.h"

#include <algorithm>

#include "engine/element_body.h"
#include "engine/kernels/flops.h"
#include "engine/kernels/response_kernels.h"
#include "engine/submesh_body.h"

namespace glisson {

std::unique_ptr<MovingBody> make_moving_body(const Body& body, std::span<const double> nodal_damping,
                                             const SimulationOptions& options, EngineInfo& info) {
  const bool in_lanes = std::all_of(body.blocks.begin(), body.blocks.end(),
                                    [](const TissueBlock& block) { return engine::has_lanes(block.tissue); });
  if (options.precision == Precision::double_precision || !in_lanes) {
    auto moving = std::make_unique<engine::ElementBody>(body, nodal_damping, options.precision, options.drag_stages);
    info = info_of(*moving, body);
    return moving;
  }
  const bool adaptive = options.precision == Precision::adaptive;
  const engine::SubmeshOptions submeshes{
      .threads = options.threads,
      .submesh_tets =
          adaptive ? engine::kAdaptiveSubmesh : engine::submesh_tets(body.elements.size(), options.mesh_changes),
      .drag_stages = options.drag_stages,
      .precision_error = adaptive ? options.precision_error : 0.0};
  auto moving = std::make_unique<engine::SubmeshBody>(body, nodal_damping, submeshes);
  info = info_of(*moving, body);
  return moving;
}

EngineInfo info_of(const MovingBody& moving, const Body& body) {
  const auto* parts = dynamic_cast<const engine::SubmeshBody*>(&moving);
  if (parts == nullptr) return {.instruction_set = "double, element by element", .threads = 1};
  const bool counted = !parts->in_stages();  // stages of drag are not
  return {.instruction_set = parts->kernels().instruction_set,
          .threads = parts->threads(),
          .submeshes = parts->submeshes().parts.size(),
          .flops_per_tet = counted ? engine::flops_per_tet(body, parts->submeshes()) : 0.0,
          .bytes_per_tet = counted ? engine::bytes_per_tet(parts->submeshes(), body.elements.size()) : 0.0};
}

}  // namespace glisson
