// standard_streams.h — standard input, output and error: there from the start, and asked at the end whether all was written.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace glisson::app {

/// Opens /dev/null for those of the descriptors 0 to 2 that are closed. Comes before any file is opened: the first one
/// would take the free number, and what is printed would land in it.
void open_standard_streams();

/// Writes to standard output or error; what standard output does not take is told at the end, by end_output.
void put(std::string_view text, std::FILE* stream);

/// Prints to standard output. A write that fails does not throw: a run is not lost because nobody can read how far it is.
template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  put(fmt::format(format, std::forward<Values>(values)...), stdout);
}

/// The same to standard error.
template <class... Values>
void tell(fmt::format_string<Values...> format, Values&&... values) {
  put(fmt::format(format, std::forward<Values>(values)...), stderr);
}

/// A warning, to standard error.
inline void tell_warning(const std::string& text) { tell("glisson: warning: {}\n", text); }

/// The exit code of the program: `code`, or kFailed and a message where standard output took not all that was printed.
/// A reader that went away (`| head`) has what it wanted.
int end_output(int code);

}  // namespace glisson::app
