// interrupt.cpp — see interrupt.h.
#include "program/interrupt.h"

#include <csignal>

namespace glisson::app {
namespace {

std::atomic<bool> stop{false};
std::atomic<bool> signalled{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

void on_signal(int) {
  signalled = true;
  stop = true;
}

}  // namespace

void catch_interrupts() {
  struct sigaction once {};
  once.sa_handler = on_signal;
  once.sa_flags = SA_RESETHAND | SA_RESTART;
  sigaction(SIGINT, &once, nullptr);
  sigaction(SIGTERM, &once, nullptr);
  struct sigaction now {};
  if (sigaction(SIGHUP, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) {  // nohup ignores it, and so do we then
    sigaction(SIGHUP, &once, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

std::atomic<bool>& stop_flag() { return stop; }

bool interrupted() { return signalled; }

}  // namespace glisson::app
