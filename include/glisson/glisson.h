// glisson.h — everything that the library `Glisson::glisson` offers.
//
// Scenes (glisson/scene/scene.h, Glisson::scene), mesh files (glisson/io.h, Glisson::io) and fits (glisson/fit.h,
// Glisson::fit) are libraries of their own.
#pragma once

#include "glisson/implicit.h"
#include "glisson/instruments/blade.h"
#include "glisson/instruments/capsule.h"
#include "glisson/instruments/contact.h"
#include "glisson/instruments/container.h"
#include "glisson/instruments/cutting.h"
#include "glisson/instruments/driven_set.h"
#include "glisson/instruments/motion.h"
#include "glisson/instruments/needle.h"
#include "glisson/instruments/rigid_motion.h"
#include "glisson/instruments/tool_motion.h"
#include "glisson/liver.h"
#include "glisson/material/linear_law.h"
#include "glisson/material/locking.h"
#include "glisson/material_point.h"
#include "glisson/math.h"
#include "glisson/mesh.h"
#include "glisson/mesh_refinement.h"
#include "glisson/oscillation.h"
#include "glisson/region_mesh.h"
#include "glisson/simulation/energy_watch.h"
#include "glisson/simulation/instruction_set.h"
#include "glisson/simulation/probe.h"
#include "glisson/simulation/simulation.h"
#include "glisson/simulation/tet_fields.h"
#include "glisson/surface_region.h"
#include "glisson/torsion.h"
#include "glisson/version.h"
