#!/usr/bin/env bash
# lint.sh BUILD JOBS — clang-tidy over src/, models/ and apps/ with the compile commands of BUILD (.clang-tidy
# says which checks). Every source is looked at; the findings of all are printed before it fails.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
readonly build="$1" jobs="$2"

command -v clang-tidy >/dev/null || { echo "lint: clang-tidy not found (make setup)" >&2; exit 1; }
[ -f "$build/compile_commands.json" ] || { echo "lint: $build is not configured" >&2; exit 1; }

# Only what this build compiles: a folder can hold sources of an option that is off. Rooms that are compiled as one unit are
# looked at as one, each header once.
mapfile -t sources < <(sed -n 's|^ *"file": "\(.*\)",\{0,1\}$|\1|p' "$build/compile_commands.json" |
  grep -E "^$PWD/($build/)?(src|models|apps)/.*\.c(pp|xx)$" | sort -u)
[ ${#sources[@]} -gt 0 ] || { echo "lint: no sources of src/, models/ or apps/ in $build" >&2; exit 1; }

# Flags of g++ that clang does not know are no finding.
printf '%s\0' "${sources[@]}" | xargs -0 -n 1 -P "$jobs" clang-tidy -p "$build" --quiet \
  --extra-arg=-Wno-unknown-warning-option 2> >(grep -vE '^[0-9]+ warnings? |^Suppressed|^Use -' >&2) ||
  { echo "lint: clang-tidy has findings" >&2; exit 1; }
echo "lint: ${#sources[@]} units, no findings"
