#!/usr/bin/env bash
# configure.sh PRESET [tests] — configures build/PRESET. Without `tests` a fresh folder is set up without
# them, so that running the program needs no test library; a folder that has them keeps them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

options=()
if [ "${2:-}" = tests ]; then
  options+=(-DGLISSON_BUILD_TESTS=ON)
elif [ ! -f "build/$1/CMakeCache.txt" ]; then
  options+=(-DGLISSON_BUILD_TESTS=OFF)
fi
exec cmake --preset "$1" --log-level=WARNING "${options[@]}"
