// words.h — the words that stand for enumerators: those of scenes. Every file that binds one of them has to see this.
#pragma once

#include "bind.h"
#include "glisson/instruments/contact.h"
#include "glisson/instruments/needle.h"
#include "glisson/material/tissue.h"
#include "glisson/mesh.h"
#include "glisson/scene/scene.h"
#include "glisson/simulation/simulation.h"

GLISSON_WORDS(glisson::BoxSplit, "'kuhn', 'alternating'")
GLISSON_WORDS(glisson::DeformationMeasure,
              "'intensity', 'one_minus_q', 'regular_mean_ratio', 'radius_ratio', 'solid_angle'")
GLISSON_WORDS(glisson::ViscousTensor, "'shear', 'deviatoric', 'proportional', 'pioletti'")
GLISSON_WORDS(glisson::Kinematics, "'small', 'corotational', 'green'")
GLISSON_WORDS(glisson::LawForm, "'secant', 'energy'")
GLISSON_WORDS(glisson::MaxwellPart, "'deviator', 'all'")
GLISSON_WORDS(glisson::VolumeChange, "'own', 'nodal'")
GLISSON_WORDS(glisson::Integrator, "'explicit', 'semi_implicit', 'implicit', 'static'")
GLISSON_WORDS(glisson::TimeScheme, "'backward_euler', 'newmark', 'generalised_alpha'")
GLISSON_WORDS(glisson::Preconditioner, "'auto', 'factorised', 'block_diagonal'")
GLISSON_WORDS(glisson::Precision, "'single', 'double'")
GLISSON_WORDS(glisson::OnInversion, "'go_on', 'stop'")
GLISSON_WORDS(glisson::StepStatus, "'ok', 'inverted', 'step_too_large', 'not_finite', 'not_converged', 'not_held'")
GLISSON_WORDS(glisson::TipForm, "'conical', 'bevelled', 'blunt'")
GLISSON_WORDS(glisson::NeedleStage, "'outside', 'pressing', 'inside'")
