// reference.cpp — docs/scene.md, written from the schema.
#include "glisson/scene/scene.h"
#include "scene/describe/reference_sections.h"
#include "scene/describe/reference_text.h"
#include "scene/parse/sections.h"

namespace glisson {
namespace {

using namespace scene;

std::string selection_parts() {
  std::string text;
  for (const KeySpec& key : selection_section().keys) {
    if (!key.section) continue;
    text += "`" + key.name + "`: " + key.section->help + "\n\n" + key_table(*key.section) + word_list(*key.section);
  }
  return text;
}

}  // namespace

std::string scene_reference_markdown() {
  std::string text(kReferenceIntroduction);
  text.append("## A complete example\n\n```toml file=scene.toml\n")
      .append(kReferenceExample)
      .append("```\n\n## Sections\n\n");
  text += "### The top of the scene\n\n" + scene_section().help + "\n\n" + key_table(scene_section());
  text += section_text(mesh_section(), "`[mesh]`");
  text += section_text(shape_section(), "`[[mesh.shape]]`");
  text += section_text(tube_point_section(), "`[[mesh.shape.points]]`");
  text += section_text(shape_region_section(), "`[[mesh.region]]`");
  text += section_text(mesh_size_section(), "`[[mesh.size]]`");
  text += section_text(path_point_section(), "`[[mesh.size.path]]`");
  text += section_text(selection_section(), "`[sets.NAME]`") + selection_parts();
  text += section_text(tissue_section(), "`[tissue]`");
  text += section_text(hyperelastic_section(), "`[tissue.hyperelastic]`");
  text += section_text(fibres_section(), "`[tissue.fibres]`");
  text += section_text(maxwell_section(), "`[[tissue.maxwell]]`");
  text += section_text(time_law_section(), "`[tissue.maxwell.time_law]`");
  text += section_text(law_section(), "`[tissue.law]`, `[tissue.lambda_law]`, `[tissue.mu_law]`");
  text += section_text(region_section(), "`[[region]]`");
  text += section_text(stiffness_section(), "`[[stiffness]]`");
  text += section_text(motion_section(), "`[motion]`");
  text += section_text(implicit_section(), "`[motion.implicit]`");
  text += section_text(fixed_section(), "`[[fixed]]`");
  text += section_text(load_section(), "`[[load]]`");
  text += section_text(tool_section(), "`[[tool]]`");
  text += section_text(record_section(), "`[tool.record]`");
  text += section_text(instrument_section(), "`[[instrument]]`");
  text += section_text(aim_section(), "`[instrument.aim]`");
  text += section_text(instrument_motion_section(), "`[instrument.motion]`");
  text += section_text(stroke_section(), "`[[instrument.motion.strokes]]`");
  text += section_text(rupture_section(), "`[instrument.rupture]`");
  text += section_text(tip_section(), "`[instrument.tip]`, `[instrument.regions.NAME]`");
  text += section_text(inner_membrane_section(), "`[[instrument.membranes]]`");
  text += section_text(membrane_process_section(), "`[instrument.drawn_membranes]`");
  text += section_text(shaft_friction_section(), "`[instrument.friction]`");
  text += section_text(container_section(), "`[container]`");
  text += section_text(capsule_section(), "`[[capsule]]`");
  text += section_text(probe_section(), "`[[probe]]`");
  text += section_text(probe_plane_section(), "`[probe.plane_m]`");
  text += section_text(heat_section(), "`[heat]`");
  text += section_text(heat_tissue_section(), "`[[heat.tissue]]`");
  text += section_text(tissue_death_section(), "`[heat.tissue.death]`");
  text += section_text(heat_boundary_section(), "`[[heat.boundary]]`");
  text += section_text(heat_probe_section(), "`[[heat.probe]]`");
  text += section_text(heat_vessel_section(), "`[heat.boundary.vessel]`");
  text += section_text(heat_power_section(), "`[[heat.power]]`");
  text += section_text(heat_pattern_section(), "`[heat.power.pattern]`");
  text += section_text(heat_radio_section(), "`[[heat.radio]]`");
  text += section_text(heat_sensor_section(), "`[[heat.sensor]]`");
  text += section_text(heat_front_section(), "`[[heat.front]]`");
  text += section_text(heat_isotherm_section(), "`[[heat.isotherm]]`");
  text += section_text(heat_plane_section(), "`[heat.isotherm.plane_m]`");
  text += section_text(heat_ice_section(), "`[heat.ice]`");
  text += section_text(output_section(), "`[output]`");
  text += section_text(chart_section(), "`[[chart]]`");
  text += section_text(measured_section(), "`[[chart.measured]]`");
  text += section_text(check_section(), "`[[check]]`");
  text += section_text(compare_section(), "`[compare]`");
  text += section_text(variant_section(), "`[[variant]]`");
  return text.append(kReferenceVariants).append(kReferenceOverrides).append(kReferenceRun);
}

}  // namespace glisson
