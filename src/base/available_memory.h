// available_memory.h — how much memory this process may still take.
#pragma once

#include <optional>

namespace glisson::detail {

/// Bytes that the machine has available and the process's limit of address space leaves; none where neither is known.
std::optional<double> available_memory();

}  // namespace glisson::detail
