// sample_between.h — a sample on the line between two: what lies within a long step.
#pragma once

#include "glisson/scene/scene.h"

namespace glisson::scene {

/// Every number by its share of the time from one sample to a later one. @param time  between theirs [s]
Sample sample_between(const Sample& before, const Sample& after, double time);

}  // namespace glisson::scene
