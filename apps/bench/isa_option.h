// isa_option.h — `--isa NAME`, the instruction set of kernels for the whole process.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace glisson::app {

/// Adds the option; one that this machine does not have is an error of the command line. @param isa  empty: the best
void add_isa_option(CLI::App& command, std::string& isa, const std::string& of);

/// Takes it up, before anything is built.
void take_isa(const std::string& isa);

}  // namespace glisson::app
