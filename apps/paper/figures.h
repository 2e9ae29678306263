// figures.h — the paper's figures held against our runs of them: fits, tables and checks, all computed from the data.
//
// A check compares with what the paper or a closed form says and passes or fails; a figure for which neither gives a
// bound (speed on another machine) goes into a table without a verdict.
#pragma once

#include <map>
#include <stdexcept>
#include <string>

#include "report/report_page.h"
#include "report/scene_checks.h"
#include "report/variant_recorder.h"

namespace glisson::app {

inline constexpr double kMilli = 1e-3;

/// The recorded variants of one scene by name; only those whose run has finished.
using Finished = std::map<std::string, const VariantRecorder*>;

/// The paper's scenes make their meshes themselves.
inline TetMesh no_file(const MeshFile& file) {
  throw std::logic_error("a paper scene reads no file, got " + file.path.string());
}

/// Figure 2: tissue 2 against line and quadratic, the force steps of tissue 1 against tetrahedra that cross the
/// threshold, the slow stiffness of the linear tissue.
SceneExtras figure2_extras(const Scene& scene, const Finished& runs);

/// Figure 3a: the overhead at the start against the velocity.
SceneExtras figure3a_extras(const Finished& runs);

/// Figure 3b: the overhead at the start against the viscosity.
SceneExtras figure3b_extras(const Finished& runs);

/// Section 2.4: runs every variant of the speed scene many times over, one after the other, and reports the medians.
/// Takes about a second.
SceneExtras speed_extras(const Scene& scene);

}  // namespace glisson::app
