# Glisson's commands. `make` lists them; CONTRIBUTING.md says more.
#   setup (packages) → configure and build (CMake preset) → run or test
JOBS ?= $(shell nproc 2>/dev/null || echo 2)
BUILD := build/release
ASAN := build/asan-ubsan
CTEST := ctest --output-on-failure --no-tests=error -j $(JOBS)
PROGRAM := $(BUILD)/bin/glisson
OUT ?= out/reproduce

.DEFAULT_GOAL := help
.PHONY: help run test test-avx2 verify check setup format clean citations figures rooms pages layout lint sanitizers races fuzz fuzz-keep
.NOTPARALLEL:

help:  ## this list
	@echo "Glisson: soft tissue that is non-linear, viscoelastic and touched by instruments"
	@sed -n 's/^\([a-z-]*\):.*## \(.*\)/  make \1	\2/p' $(MAKEFILE_LIST) | expand -t 18

setup:  ## install the packages that are missing (SECTION=run, python, test or check; all of them: check)
	@scripts/setup.sh $(or $(SECTION),check)

run:  ## build the program and reproduce the paper's figures into one report
	@scripts/setup.sh run
	@echo "make run: 8 minutes on two idle cores, 20 or more on an old or busy machine; two or three once it is built"
	@scripts/configure.sh release
	@scripts/build.sh $(BUILD) $(JOBS) glisson_program
	$(PROGRAM) reproduce --out $(OUT) --threads $(JOBS)

# ISA=avx2 (or sse4) runs kernels in that instruction set; LABELS='engine|dynamics' takes the tests of some rooms.
# Ends with what was skipped, and why.
test:  ## build with tests and run them: engine, consumer package, report page
	@scripts/setup.sh test
	@scripts/configure.sh release tests
	@scripts/build.sh $(BUILD) $(JOBS)
	@status=0; (cd $(BUILD) && GLISSON_INSTRUCTION_SET=$(ISA) $(CTEST) -LE verify $(LABELS:%=-L '%')) || status=$$?; \
	scripts/skipped_tests $(BUILD); exit $$status

# Most users have AVX2: where the machine has AVX-512, the tests that see the kernels run again without it.
test-avx2:
	@if grep -qw avx512f /proc/cpuinfo; then $(MAKE) --no-print-directory test ISA=avx2 LABELS='engine|instruments|dynamics'; \
	else echo "make test-avx2: this machine has no AVX-512, make test ran the same"; fi

# Not part of test: 300 random bodies, a thousand scenes and insertions, populations of fits; `test` has the first few of each.
verify:  ## build with tests and run those of many random bodies, scenes and populations, half an hour
	@scripts/setup.sh test
	@scripts/configure.sh release tests
	@scripts/build.sh $(BUILD) $(JOBS)
	@cd $(BUILD) && $(CTEST) -L verify

check:  ## sanitizers, fuzz corpus, layout, lint, citations, figures, rooms, pages: all of them, even when one fails
	@scripts/setup.sh check
	@$(MAKE) --no-print-directory --keep-going citations figures rooms pages layout lint sanitizers

citations:
	@scripts/check_citations

figures:
	@scripts/check_figures

rooms:
	@scripts/check_rooms

# The clone compiles what this checkout has compiled, through the compiler's cache; FULL=1 does without, and runs all blocks.
pages:  ## run the blocks of README and docs as they are printed, in a fresh clone (FULL=1: the long ones too)
	@scripts/setup.sh python
	@scripts/read_pages $(if $(FULL),--full) $(PAGES)

layout:
	@scripts/check_format.sh

lint:
	@scripts/configure.sh asan-ubsan tests
	@cmake --build $(ASAN) --target glisson_build_info
	@scripts/lint $(ASAN) $(JOBS)

# Address and undefined behaviour, over every test but those of the page and of scripts and the long physical runs (`long`,
# tests/CMakeLists.txt), which were half of the time; the fuzz corpus is among them.
sanitizers:
	@scripts/configure.sh asan-ubsan tests
	@scripts/build.sh $(ASAN) $(JOBS)
	@cd $(ASAN) && $(CTEST) -LE 'web|scripts|long|verify'

# Not part of check: a third build. `races` finds what two threads touch without a word to each other.
races:  ## the engine's tests under the thread sanitizer
	@scripts/setup.sh check
	@scripts/configure.sh tsan tests
	@cmake --build build/tsan -j $(JOBS) --target engine_tests dynamics_tests change_tests
	@cd build/tsan && $(CTEST) -LE verify -R 'Threads|ConstReading|SameBytes|SubmeshBody|SideBySide|Forces|Step'

# Not part of check either: a fourth build, with clang. TARGETS="mesh run" takes some of them.
SECONDS_EACH ?= 60
fuzz:  ## every parser against made-up input (SECONDS_EACH=900 for each; JOBS at a time; TARGETS="mesh run")
	@scripts/setup.sh check
	@scripts/configure.sh fuzz tests
	@cmake --build build/fuzz -j $(JOBS) --target $(or $(TARGETS:%=fuzz_%),fuzzers)
	@scripts/fuzz build/fuzz run --seconds $(SECONDS_EACH) --jobs $(JOBS) $(TARGETS)

fuzz-keep:  ## take what `make fuzz` found into tests/fuzz/corpus, where it reaches new code
	@scripts/fuzz build/fuzz keep $(TARGETS)

format:  ## lay out the sources in place with clang-format
	@scripts/setup.sh check
	@scripts/check_format.sh --fix

clean:  ## remove what was built and written
	rm -rf build out web/node_modules web/dist
