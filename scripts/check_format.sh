#!/usr/bin/env bash
# check_format.sh [--fix] — holds the C++ sources against .clang-format, or lays them out so.
# Newer releases of clang-format differ in details; release 14 decides, others only report.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly deciding=14
tool="$(command -v clang-format-$deciding || command -v clang-format)" ||
  { echo "format: clang-format not found (make setup)" >&2; exit 1; }
mapfile -t sources < <(git ls-files --cached --others --exclude-standard '*.h' '*.cpp' | sort -u | xargs -d '\n' ls -d 2>/dev/null)

if [ "${1:-}" = --fix ]; then
  exec "$tool" -i "${sources[@]}"
fi

release="$("$tool" --version | sed 's/.*version \([0-9]*\).*/\1/')"
faults="$("$tool" --dry-run -Werror "${sources[@]}" 2>&1 | grep -E 'error: ' | sed 's/: error: .*//' | sort -u -t: -k1,1 || true)"
if [ -n "$faults" ]; then
  echo "$faults"
  if [ "$release" = "$deciding" ]; then
    echo "format: the files above (first line of each) differ from .clang-format; \`make format\` lays them out" >&2
    exit 1
  fi
  echo "format: clang-format $release differs in the files above; release $deciding decides, so this is only told"
fi
echo "format: ${#sources[@]} files looked at"
