#include "bench/isa_option.h"

#include "glisson/simulation/instruction_set.h"
#include "program/option_check.h"

namespace glisson::app {

void add_isa_option(CLI::App& command, std::string& isa, const std::string& of) {
  command.add_option("--isa", isa, "instruction set of " + of + ": avx512, avx2, sse4; default: the best")
      ->type_name("NAME")
      ->check(one_of(cpu::instruction_sets()));
}

void take_isa(const std::string& isa) {
  isa.empty() ? cpu::use_instruction_set_of_environment() : cpu::use_instruction_set(isa);
}

}  // namespace glisson::app
