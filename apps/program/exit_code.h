// exit_code.h — what the program's exit status says.
#pragma once

namespace glisson::app {

enum ExitCode : int {
  kDone = 0,
  kFailed = 1,     ///< a disk that refuses, memory, a fault of ours
  kUserError = 2,  ///< a scene, mesh, option or folder that cannot be used as it is
  kNumericalEnd =
      3,  ///< a run that its numbers ended: unstable, not finite, stopped on inversion; a fit that identifies nothing
  kUnfinished = 4,  ///< a check that ran out of time before it had looked at every variant: neither a pass nor a fault
  kInterrupted = 130  ///< Ctrl-C, SIGTERM or SIGHUP; everything written so far is kept
};

}  // namespace glisson::app
