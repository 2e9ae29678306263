#include "program/standard_streams.h"

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "program/exit_code.h"

namespace glisson::app {
namespace {

std::atomic<int> first_error{0};  ///< of standard output

bool reader_is_gone() {
  pollfd out{STDOUT_FILENO, POLLOUT, 0};
  return poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0;
}

}  // namespace

void open_standard_streams() {
  for (int descriptor = 0; descriptor <= 2; ++descriptor) {
    if (fcntl(descriptor, F_GETFD) != -1 || errno != EBADF) continue;
    // the lowest free number is the one that is given
    if (open("/dev/null", O_RDWR) != descriptor) std::_Exit(kFailed);
  }
}

void put(std::string_view text, std::FILE* stream) {
  int none = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stream) == text.size();
  if (!written && stream == stdout) first_error.compare_exchange_strong(none, errno);
}

int end_output(int code) {
  const bool flushed = std::fflush(stdout) == 0;
  const int reason = first_error != 0 ? first_error.load() : flushed ? 0 : errno;
  if ((flushed && std::ferror(stdout) == 0) || reader_is_gone()) return code;
  tell("glisson: standard output cannot be written{}{}; what was printed is not complete\n", reason != 0 ? ": " : "",
       reason != 0 ? std::strerror(reason) : "");
  return code == kDone ? static_cast<int>(kFailed) : code;
}

}  // namespace glisson::app
