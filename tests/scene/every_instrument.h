// every_instrument.h — a scene with every key of instruments, containers and capsules away from its default.
#pragma once

#include <string>

namespace glisson::test {

inline const std::string kEveryInstrument = R"([mesh]
kind = "box"
cells = [4, 4, 4]
size_m = [0.04, 0.04, 0.04]

[sets.top]
side = { axis = "z", end = "upper", depth_m = 0 }

[[region]]
name = "vessel"
box_m = { min = [0, 0, 0], max = [1, 1, 0.02] }

[[fixed]]
set = "z_min"

[[instrument]]
kind = "needle"
name = "18 G"
tip_m = [0.02, 0.021, 0.041]
direction = [0, 0, -3]
side = [0, 2, 1]
diameter_mm = 1.2
length_mm = 90
zone_mm = 4
spacing_mm = 1.5
rupture = { toughness_J_m2 = 120, membrane_thickness_mm = 0.2 }
tip = { cutting_N = 0.25, puncture_N = 0.5 }
regions.vessel = { cutting_N = 0.5, puncture_N = 1.25 }
membranes = [{ depth_mm = 4, puncture_N = 0.75, cutting_N = 0.375 }, { depth_mm = 6.5, puncture_N = 1.5 }]
drawn_membranes = { spacing_mm = 7, puncture_N = 2, spread = 0.25, seed = 9 }
friction = { static_in_N_m = 18, static_out_N_m = 17, dynamic_in_N_m = 10, dynamic_out_N_m = 11, viscous_in_N_s_m2 = 212, viscous_out_N_s_m2 = 239, stick_speed_mm_s = 0.25 }
youngs_modulus_Pa = 2e11
inner_diameter_mm = 0.8
bevel_share = 0.3
[instrument.motion]
kind = "strokes"
velocity_mm_s = 5
start_s = 0.125
direction = [0, 0, -2]
strokes = [{ depth_mm = 30, ramp_s = 0.1, rest_s = 2 }, { depth_mm = 30, aside_mm = [1, 2, 0], velocity_mm_s = 1 }, { depth_mm = 0 }]

[[instrument]]
kind = "punch"
name = "punch"
tip_m = [0, 0, 0.05]
radius_mm = 3
edge_radius_mm = 0.5
length_mm = 20
friction = 0.4
bonded = true
push_out_speed_mm_s = 12
motion = { kind = "sine", amplitude_mm = 2, frequency_hz = 3, mean_mm = 1, start_s = 0.5, ramp_s = 0.25, duration_s = 4 }

[[instrument]]
kind = "ball"
name = "ball"
tip_m = [0, 0, 0.05]
radius_mm = 7
motion = { kind = "push", force_N = 2, swing_N = 0.5, frequency_hz = 4, start_s = 0.1, ramp_s = 0.2, duration_s = 3, mass_kg = 0.1, damping_N_s_m = 6, guided = false, stop_mm = 8 }

[[instrument]]
kind = "probe"
name = "probe"
tip_m = [0, 0, 0.05]
diameter_mm = 2
length_mm = 50
tip = "bevelled"
tip_angle_rad = 0.5
motion = { kind = "press", velocity_mm_s = 3, depth_mm = 4, start_s = 0.5, ramp_s = 0.1, hold_s = 0.2, returns = true }

[[instrument]]
kind = "plate"
name = "plate"
tip_m = [0, 0, 0.05]
motion = { kind = "press" }

[[instrument]]
kind = "block"
name = "block"
tip_m = [0, 0, 0.05]
size_mm = [4, 5, 6]
edge_radius_mm = 1
motion = { kind = "press" }

[[instrument]]
kind = "blade"
name = "scalpel"
tip_m = [0, 0, 0.05]
edge_from_mm = [0, -3, 1]
edge_to_mm = [0, 4, 2]
toughness_J_m2 = 150
cut_every_s = 0.004
snap = false
least_quality = 0.2
least_step = 0.5
motion = { kind = "press" }

[container]
kind = "box"
width_mm = 40
length_mm = 41
height_mm = 42
floor_m = [0.02, 0.02, 0]
hold = "wet"
friction = 0.2
push_out_speed_mm_s = 8

[[capsule]]
name = "skin"
set = "top"
thickness_mm = 0.15
youngs_modulus_Pa = 5e6
poisson_ratio = 0.3
prestretch = 1.02
stiffening = 4
strength_N_m = 90
averaging_length_mm = 3
)";

}  // namespace glisson::test
