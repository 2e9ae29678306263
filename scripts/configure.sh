#!/usr/bin/env bash
# configure.sh PRESET [tests] — configures build/PRESET. Without `tests` a fresh folder is set up without
# them, so that running the program needs no test library; a folder that has them keeps them.
#
# A build folder belongs to the place where it was made. In a tree that was moved or copied CMake refuses it, and what programs it made
# name the old place: it is removed, which is said, and made anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly folder="build/$1" cache="build/$1/CMakeCache.txt"
tests="${2:-}"

kept() {  # what the folder has kept of a setting
  sed -n "s/^$1:[A-Z]*=//p" "$cache"
}

if [ -f "$cache" ]; then
  made_of="$(kept CMAKE_HOME_DIRECTORY)" made_in="$(kept CMAKE_CACHEFILE_DIR)"
  if ! [ "$made_of" -ef . ] || ! [ "$made_in" -ef "$folder" ]; then
    [ "$(kept GLISSON_BUILD_TESTS)" != ON ] || tests=tests
    echo "$folder was made in $made_in, and this tree is in $PWD: it was moved or copied. $folder is removed and built anew" >&2
    rm -rf "$folder"
  fi
fi

options=()
if [ "$tests" = tests ]; then
  options+=(-DGLISSON_BUILD_TESTS=ON)
elif [ ! -f "$cache" ]; then
  options+=(-DGLISSON_BUILD_TESTS=OFF)
fi
exec cmake --preset "$1" --log-level=WARNING "${options[@]}"
