// interrupt.h — Ctrl-C, SIGTERM and SIGHUP (a terminal that closes) ask the run to end; what is written so far stays and a report is made of it.
#pragma once

#include <atomic>

namespace glisson::app {

/// From here on the first SIGINT, SIGTERM or SIGHUP sets stop_flag(); a second one ends the program at once.
/// A reader of our output that goes away (`| head`) no longer ends the run.
void catch_interrupts();

/// Ends all runs when set; by a signal, or by a run that cannot go on.
std::atomic<bool>& stop_flag();

/// Whether a signal has come.
bool interrupted();

}  // namespace glisson::app
