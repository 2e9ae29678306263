// instruction_set.h — the instruction set that kernels and peaks run in: the best of this machine, or one asked for.
//
// One choice for the whole process, before anything is dispatched: the kernels of a body stay those it was built with.
#pragma once

#include <string>
#include <vector>

namespace glisson::cpu {

/// "avx512", "avx2", "sse4", "neon": those that this machine has and this program was compiled for, the best first.
std::vector<std::string> instruction_sets();

/// Leaves no better one than `name` to choose from.
/// @throws std::invalid_argument for one that is not among instruction_sets(), naming them
void use_instruction_set(const std::string& name);

/// Uses the set that the environment variable GLISSON_INSTRUCTION_SET names, unless use_instruction_set() was called or the
/// variable is empty or unset. Read once a process; what
/// dispatches kernels calls it first.
/// @throws std::invalid_argument as use_instruction_set(), naming the variable
void use_instruction_set_of_environment();

}  // namespace glisson::cpu
