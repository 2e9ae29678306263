// rules.h — the rules of advice, a function each: what it says of what it looks at, nothing where all is well.
//
// The tables in advise.cpp name them and have their order.
#pragma once

#include "glisson/scene/advice.h"
#include "glisson/scene/near_bounds.h"
#include "scene/advice/advice_text.h"

namespace glisson::advice {

// Of the mesh, a set or a region.

/// What inspection finds, but for meshes from files, whose reader has said it.
Texts mesh_warnings(const Variant& variant, const VariantAtRest& rest);

/// How far the unloaded shape of a run that starts loaded is from the mesh.
Texts loaded(const VariantAtRest& rest);

/// A set or region about whose bounds vertices or tets have been counted.
struct NearSelection {
  std::string name;
  NearBounds near;
  const char *one, *several;  ///< names of what is counted
};
/// That it has some by its tolerance alone.
Texts rounding(const NearSelection& selection);
/// That some lie so little outside that it has probably lost them.
Texts just_outside(const NearSelection& selection);

// Of a tissue.

/// That linear tets lock in it, and the key that mends it. @param table  that has its keys
Texts locking(const Tissue& tissue, const std::string& table);
/// Which tissues of all variants have forces whose closed cycles give or take work, and the way out.
Texts cycle_work(std::span<const Variant> variants);

// Of a tool or an instrument.

/// That a pad is of few or large faces, and which mesh would do.
Texts coarse_pad(const Variant& variant, const ToolSpec& tool, const TetMesh& mesh);
/// That an instrument's path passes the body by.
Texts misses(const Variant& variant, const InstrumentSpec& instrument, const TetMesh& mesh);
/// That cells are too coarse for a sharp edge, and which would do.
Texts edge(const Variant& variant, const InstrumentSpec& instrument, const TetMesh& mesh);
/// That the mesh does not resolve a needle's zone, and what would do.
Texts zone(const Variant& variant, const InstrumentSpec& instrument, const TetMesh& mesh);
/// That an instrument acts on few or large faces, and which mesh would do.
Texts coarse(const Variant& variant, const InstrumentSpec& instrument, const TetMesh& mesh);

// Of the steps.

struct StepCase {
  const Variant& variant;
  const VariantAtRest& rest;
  const MeshLoader& load;
  TrialTime& time;
};
/// branches_note.
Texts branches(const StepCase& c);
/// Where given long steps pass over corners: how many, the first, and what ends steps there.
Texts corners(const StepCase& c);
/// The mass that was added.
Texts mass(const StepCase& c);
/// Which few tets keep an explicit step short, and what mass for them alone gives.
Texts limits(const StepCase& c);
/// Where viscosity keeps an explicit step short, what makes a simulated second cheapest: stages of the viscous force, `semi_implicit` or
/// long steps.
Texts viscous(const StepCase& c);
/// Where tools move by next to nothing in a step, that mass while tissue moves evenly makes steps longer.
Texts slow(const StepCase& c);
/// Tools that are faster than the waves that take tissue out of their way.
Texts fast(const StepCase& c);
/// That ice makes explicit steps short, and the integrator whose steps it does not.
Texts freezing(const StepCase& c);
/// The tissues for which adaptive precision can do nothing.
Texts adaptive(const StepCase& c);

/// How many times as long a step is to be for a hint on it.
inline constexpr double kWorthSaying = 1.2;
/// Two digits, not rounded up: a step a little above the others' bound would give all of them mass.
double two_digits_down(double x);

}  // namespace glisson::advice
