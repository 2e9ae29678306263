// sections.h — the sections of a scene.
#pragma once

#include <type_traits>

#include "glisson/scene/scene.h"
#include "scene/parse/schema.h"

namespace glisson::scene {

const SectionSpec& mesh_section();               ///< fills MeshSource
const SectionSpec& shape_section();              ///< fills NamedShape
const SectionSpec& shape_region_section();       ///< fills ShapeRegion
const SectionSpec& tube_point_section();         ///< fills TubePoint
const SectionSpec& path_point_section();         ///< fills PathPoint
const SectionSpec& mesh_size_section();          ///< fills MeshSize
SectionSpec implicit_body_kind();                ///< of [mesh]; fills ImplicitBody
const SectionSpec& box_section();                ///< fills Selection::Box
const SectionSpec& sphere_section();             ///< fills Selection::Sphere
const SectionSpec& selection_section();          ///< fills Selection
const SectionSpec& law_section();                ///< fills StiffnessLaw
const SectionSpec& hyperelastic_section();       ///< fills HyperelasticLaw
const SectionSpec& fibres_section();             ///< fills Fibres
const SectionSpec& time_law_section();           ///< fills TimeLaw
const SectionSpec& maxwell_section();            ///< fills MaxwellBranch
const SectionSpec& tissue_section();             ///< fills Tissue
const SectionSpec& region_section();             ///< fills RegionSpec
const SectionSpec& implicit_section();           ///< fills ImplicitOptions
const SectionSpec& motion_section();             ///< fills Variant
const SectionSpec& stiffness_section();          ///< fills StiffnessImage
const SectionSpec& fixed_section();              ///< fills FixedSpec
const SectionSpec& load_section();               ///< fills LoadSpec
const SectionSpec& record_section();             ///< fills RecordSpec
const SectionSpec& rotation_section();           ///< fills RotationMotion
const SectionSpec& poses_section();              ///< fills PosesSpec
const SectionSpec& tool_section();               ///< fills ToolSpec
const SectionSpec& rupture_section();            ///< fills Rupture
const SectionSpec& tip_section();                ///< fills TipResistance
const SectionSpec& inner_membrane_section();     ///< fills InnerMembrane
const SectionSpec& membrane_process_section();   ///< fills MembraneProcess
const SectionSpec& shaft_friction_section();     ///< fills ShaftFriction
const SectionSpec& stroke_section();             ///< fills StrokesSpec::One
const SectionSpec& instrument_motion_section();  ///< fills InstrumentMotion
const SectionSpec& aim_section();                ///< fills AimSpec
const SectionSpec& instrument_section();         ///< fills InstrumentSpec
const SectionSpec& container_section();          ///< fills ContainerSpec
const SectionSpec& capsule_section();            ///< fills CapsuleSpec
const SectionSpec& probe_section();              ///< fills ProbeSpec
const SectionSpec& probe_plane_section();        ///< fills ProbePlane
const SectionSpec& heat_section();               ///< fills HeatSpec
const SectionSpec& heat_tissue_section();        ///< fills HeatTissueSpec
const SectionSpec& tissue_death_section();       ///< fills TissueDeath
const SectionSpec& heat_boundary_section();      ///< fills HeatBoundarySpec
const SectionSpec& heat_probe_section();         ///< fills HeatProbeSpec
const SectionSpec& heat_power_section();         ///< fills HeatPowerSpec
const SectionSpec& heat_pattern_section();       ///< fills HeatPatternSpec
const SectionSpec& heat_vessel_section();        ///< fills VesselWall
const SectionSpec& heat_radio_section();         ///< fills HeatRadioSpec
const SectionSpec& heat_sensor_section();        ///< fills HeatSensorSpec
const SectionSpec& heat_front_section();         ///< fills HeatFrontSpec
const SectionSpec& heat_isotherm_section();      ///< fills HeatIsothermSpec
const SectionSpec& heat_plane_section();         ///< fills HeatPlaneSpec
const SectionSpec& heat_ice_section();           ///< fills HeatIceSpec
const SectionSpec& output_section();             ///< fills OutputSpec
const SectionSpec& measured_section();           ///< fills MeasuredSpec
const SectionSpec& chart_section();              ///< fills ChartSpec
const SectionSpec& check_section();              ///< fills CheckSpec
const SectionSpec& compare_section();            ///< fills CompareSpec
const SectionSpec& variant_section();            ///< one experiment, complete; fills Variant
const SectionSpec& scene_section();              ///< what a scene says once; fills Scene

/// The section of a type that fields have (glisson/field.h): what is a table in a scene.
inline const SectionSpec& section_of(std::type_identity<StiffnessLaw>) { return law_section(); }
inline const SectionSpec& section_of(std::type_identity<HyperelasticLaw>) { return hyperelastic_section(); }
inline const SectionSpec& section_of(std::type_identity<Fibres>) { return fibres_section(); }
inline const SectionSpec& section_of(std::type_identity<TimeLaw>) { return time_law_section(); }
inline const SectionSpec& section_of(std::type_identity<MaxwellBranch>) { return maxwell_section(); }
inline const SectionSpec& section_of(std::type_identity<ImplicitOptions>) { return implicit_section(); }
inline const SectionSpec& section_of(std::type_identity<NamedShape>) { return shape_section(); }
inline const SectionSpec& section_of(std::type_identity<ShapeRegion>) { return shape_region_section(); }
inline const SectionSpec& section_of(std::type_identity<TubePoint>) { return tube_point_section(); }
inline const SectionSpec& section_of(std::type_identity<PathPoint>) { return path_point_section(); }
inline const SectionSpec& section_of(std::type_identity<MeshSize>) { return mesh_size_section(); }
inline const SectionSpec& section_of(std::type_identity<Rupture>) { return rupture_section(); }
inline const SectionSpec& section_of(std::type_identity<TipResistance>) { return tip_section(); }
inline const SectionSpec& section_of(std::type_identity<InnerMembrane>) { return inner_membrane_section(); }
inline const SectionSpec& section_of(std::type_identity<MembraneProcess>) { return membrane_process_section(); }
inline const SectionSpec& section_of(std::type_identity<ShaftFriction>) { return shaft_friction_section(); }
inline const SectionSpec& section_of(std::type_identity<TissueDeath>) { return tissue_death_section(); }
inline const SectionSpec& section_of(std::type_identity<HeatPlaneSpec>) { return heat_plane_section(); }
inline const SectionSpec& section_of(std::type_identity<HeatPatternSpec>) { return heat_pattern_section(); }
inline const SectionSpec& section_of(std::type_identity<VesselWall>) { return heat_vessel_section(); }
inline const SectionSpec& section_of(std::type_identity<StrokesSpec::One>) { return stroke_section(); }

}  // namespace glisson::scene
