// loaded_start.h — a scene whose mesh is the body under its loads: motion.start = "loaded".
#pragma once

#include "glisson/scene/scene.h"

namespace glisson::scene {

/// What of a variant acts on it before the run: supports, loads of time 0, capsules and gravity, under `quasi_static`. Instruments,
/// containers, probes and heat are left out.
Variant still_variant(const Variant& variant);
/// Takes a share of gravity and of the loads of a still variant.
void take_share(const Variant& still, double share, Variant& out);

/// Probes of places in the loaded body as those of the same material in the unloaded one.
/// @throws std::invalid_argument for a point outside of the loaded body, naming the nearest point of it
void move_to_rest(const TetMesh& loaded, const std::vector<Vec3d>& rest, ProbeOptions& probe);

/// Why a variant cannot start loaded, and what to do; empty where it can.
std::string refuses_loaded_start(const Variant& variant);

}  // namespace glisson::scene
