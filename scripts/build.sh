#!/usr/bin/env bash
# build.sh FOLDER JOBS [TARGET] — builds FOLDER, and says how far it is and how long it will about take from here: by the steps
# done and the time they took. On a terminal in one line that changes, elsewhere in a line every 20 s. What a step prints is
# printed whole; the exit status is that of the build.
set -euo pipefail
readonly folder="$1" jobs="$2" every=20

# Ninja's status before each step: done, of all, seconds so far.
export NINJA_STATUS='@%f/%t@%e@ '
readonly step='^@([0-9]+)/([0-9]+)@([0-9]+)[.0-9]*@ '

span() {  # seconds, as one reads them
  if [ "$1" -lt 90 ]; then echo "$1 s"; else echo "$((($1 + 30) / 60)) min"; fi
}

show() {  # done, of all, seconds
  local left="" text
  [ "$3" -lt 5 ] || [ "$1" = "$2" ] || left=", about $(span $(($3 * ($2 - $1) / $1))) left"
  text="[$1/$2] $(span "$3")$left"
  if [ -t 1 ]; then printf '\r\033[K%s' "$text"; else echo "$text"; fi
}

read_steps() {
  local line last=-1 open=""
  while IFS= read -r line; do
    if [[ $line =~ $step ]]; then
      local finished="${BASH_REMATCH[1]}" all="${BASH_REMATCH[2]}" seconds="${BASH_REMATCH[3]}"
      if [ -t 1 ] || [ $((seconds / every)) -ne "$last" ] || [ "$finished" = "$all" ]; then
        [ "$finished" = 0 ] || show "$finished" "$all" "$seconds"
        last=$((seconds / every)) open=1
      fi
    else
      [ -z "$open" ] || [ ! -t 1 ] || echo
      open=""
      printf '%s\n' "$line"
    fi
  done
  [ -z "$open" ] || [ ! -t 1 ] || echo
}

cmake --build "$folder" -j "$jobs" ${3:+--target "$3"} 2>&1 | read_steps
