// most_trials.h — how often a tool that a force moves is tried elsewhere within a correction of a long step (step_contact.h), and by
// its own search for where it ends (instruments/motion/end_search.h).
#pragma once

namespace glisson {

inline constexpr int kMostTrials = 40;

}  // namespace glisson
