#include "cli/last_words.h"

#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <string>

#include "program/exit_code.h"

namespace glisson::app {

const char* const kOutOfMemory =
    "the system refused more memory; give it more (ulimit -v, the container's limit), or take a coarser mesh, fewer "
    "frames, or one variant at a time (--threads 1)";

namespace {

/// To standard error without a byte of memory.
void put(const char* text) { [[maybe_unused]] const auto written = write(STDERR_FILENO, text, std::strlen(text)); }

[[noreturn]] void end_with_a_sentence() {
  put("glisson: ");
  try {
    if (const std::exception_ptr error = std::current_exception()) std::rethrow_exception(error);
    put("ended by an internal error; please report it");
  } catch (const std::bad_alloc&) {
    put(kOutOfMemory);
  } catch (const std::exception& error) {
    put("ended by an unexpected error: ");
    put(error.what());
  } catch (...) {
    put("ended by an internal error; please report it");
  }
  put("\n");
  std::_Exit(kFailed);
}

}  // namespace

void promise_last_words() {
  std::signal(SIGXFSZ, SIG_IGN);
  std::set_terminate(end_with_a_sentence);
}

/// With less, a run ends at a fault of memory somewhere, in which nothing can be said any more; threads get as much each.
std::string stack_too_small() {
  constexpr rlim_t kLeast = 512;  // [KB]; figure 2 runs in 128
  struct rlimit limit {};
  if (getrlimit(RLIMIT_STACK, &limit) != 0 || limit.rlim_cur >= 1024 * kLeast) return {};
  return "the limit of the stack is " + std::to_string(limit.rlim_cur / 1024) + " KB, where runs need " +
         std::to_string(kLeast) + " KB or more; raise it: ulimit -s 8192";
}

std::string system_text(const std::system_error& error) {
  if (error.code() != std::errc::resource_unavailable_try_again) return error.what();
  return std::string("the system refused another thread (") + error.what() +
         "); give it more memory or threads (ulimit -v, ulimit -u), or take fewer: --threads 1";
}

}  // namespace glisson::app
