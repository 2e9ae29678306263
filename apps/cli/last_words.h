// last_words.h — what is said where the program ends by no fault of its input: memory or threads that the system refuses, a
// file above its limit.
#pragma once

#include <string>
#include <system_error>

namespace glisson::app {

/// From here on a file that grows above the system's limit is an error of that file and no silent end, and an exception that
/// nobody catches ends the program with a sentence and kFailed.
void promise_last_words();

/// Why the program cannot run within the limit that the system sets its stack; empty where it can.
std::string stack_too_small();

/// Memory is used up: which limit it may be, and what needs less.
extern const char* const kOutOfMemory;

/// The sentence for an error of the system; where it refuses a thread, with the way out.
std::string system_text(const std::system_error& error);

}  // namespace glisson::app
