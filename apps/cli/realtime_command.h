// realtime_command.h — glisson bench realtime.
#pragma once

#include "cli/commands.h"

namespace glisson::app {

/// Adds `realtime` to `bench`; when it is the one chosen it sets `action`. @return the subcommand
CLI::App* add_realtime(CLI::App& bench, Action& action);

}  // namespace glisson::app
