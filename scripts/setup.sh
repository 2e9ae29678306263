#!/usr/bin/env bash
# setup.sh SECTION — makes sure that the packages of scripts/packages.txt are there, up to SECTION
# (run, python, plot, test or check). Installs only what is missing: as root, else through sudo; where neither is to
# be had it prints the one command for an administrator and exits 1. GLISSON_SKIP_SETUP=1 skips the packages.
#
# A virtual environment `venv` belongs to the place where it was made: in a tree that was moved or copied its pip is missing or installs
# into the old place. Such a one is removed, which is said, as configure.sh does with build folders.
set -euo pipefail

readonly here="$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)"
readonly list="$here/packages.txt"
readonly oldest_node=18

say() { printf 'setup: %s\n' "$*"; }
fail() { printf 'setup: %s\n' "$1" >&2; shift; [ $# -eq 0 ] || printf '%s\n' "$@" >&2; exit 1; }

# Which system this is: `debian` and `ubuntu` mean a release that has all packages new enough.
system() {
  local ID="" VERSION_ID="" ID_LIKE=""
  [ -r /etc/os-release ] && . /etc/os-release
  case "$ID" in
    debian) at_least "${VERSION_ID:-99}" 12 && { echo debian; return; } ;;  # testing has no VERSION_ID
    ubuntu) at_least "${VERSION_ID:-0}" 24.04 && { echo ubuntu; return; } ;;
  esac
  echo "other:${ID:-$(uname -s)} ${VERSION_ID:-}"
}

at_least() { [ "$(printf '%s\n%s\n' "$2" "$1" | sort -V | head -n 1)" = "$2" ]; }

have_node() {
  command -v node >/dev/null && command -v npm >/dev/null || return 1
  local major
  major="$(node --version | sed 's/^v\([0-9]*\).*/\1/')"
  [ "${major:-0}" -ge "$oldest_node" ]
}

# Packages of a section and of those above it, for a system, one a line.
wanted() {
  awk -v section="$1" -v here="$2" '
    /^\[/ { if (last) exit; last = ($0 == "[" section "]"); next }
    /^[ \t]*(#|$)/ { next }
    { only = ""; if (match($0, /# *(debian|ubuntu):/)) { only = substr($0, RSTART + 1, RLENGTH - 2); gsub(/ /, "", only) }
      if (only == "" || only == here) print $1 }' "$list"
}

# Those of the given packages that are not installed. A node from elsewhere (nvm, NodeSource, whose
# nodejs brings npm along and conflicts with the package npm) stands for both packages.
missing() {
  local package
  for package in "$@"; do
    case "$package" in nodejs | npm) have_node && continue ;; esac
    [ "$(dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | head -n 1)" = installed ] || echo "$package"
  done
}

# Another system: the packages go by other names there, so look for the tools and say what is needed.
check_tools() {
  local tool absent=()
  for tool in cmake ninja c++; do command -v "$tool" >/dev/null || absent+=("$tool"); done
  have_node || absent+=("node and npm ($oldest_node or newer)")
  say "this is $1: packages are installed by themselves on Debian 12+ and Ubuntu 24.04+ only."
  say "Needed, by their Debian names: $2"
  [ ${#absent[@]} -eq 0 ] || fail "not found: ${absent[*]}. Install them and try again." \
    "GLISSON_SKIP_SETUP=1 skips this look."
  say "the tools are there; going on."
}

install_packages() {
  local get=(env DEBIAN_FRONTEND=noninteractive apt-get -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 -qq)
  local as=() log
  log="$(mktemp)"
  if [ "$(id -u)" -ne 0 ]; then
    if ! command -v sudo >/dev/null || { ! sudo -n true 2>/dev/null && [ ! -t 0 ]; }; then
      fail "these packages are missing, and this needs an administrator. One command:" \
        "  apt-get update && apt-get install --no-install-recommends $*"
    fi
    as=(sudo)
  fi
  say "installing $# packages: $*"
  "${as[@]}" "${get[@]}" update || fail "apt-get update failed: is the network there?"
  "${as[@]}" "${get[@]}" install -y --no-install-recommends "$@" >"$log" 2>&1 ||
    { tail -n 20 "$log" >&2; fail "apt-get install failed; its whole output is in $log"; }
  rm -f "$log"
}

# The place that the programs of a virtual environment name in their first lines, `#!PLACE/bin/python3` or, where that is too long
# or has blanks, `'''exec' "PLACE/bin/python3" …`; empty where it has no pip.
place_of() {
  [ -r "$1/bin/pip" ] && sed -n '1,2{s,^[^/]*exec. "*\(/.*\)/bin/python.*,\1,p;t;s,^#!\(/.*\)/bin/python.*,\1,p}' "$1/bin/pip"
}

leave_moved_environment() {
  local venv="${here%/*}/venv" made_in
  [ -f "$venv/pyvenv.cfg" ] || return 0
  made_in="$(place_of "$venv")" || return 0
  [ -n "$made_in" ] || return 0
  if ! [ "$made_in" -ef "$venv" ]; then
    say "venv was made in $made_in, and this tree is in ${here%/*}: it was moved or copied. venv is removed;" \
      "make it anew: python3 -m venv venv && venv/bin/pip install '.[plot]'" >&2
    rm -rf "$venv"
  fi
}

main() {
  local section="${1:-run}" system packages absent
  case "$section" in run | python | plot | test | check) ;; *) fail "unknown section '$section': run, python, plot, test or check" ;; esac
  leave_moved_environment
  [ "${GLISSON_SKIP_SETUP:-0}" = 1 ] && return
  system="$(system)"
  mapfile -t packages < <(wanted "$section" "${system%%:*}")
  [ ${#packages[@]} -gt 0 ] || fail "no packages read from $list"
  case "$system" in other:*) check_tools "${system#other:}" "${packages[*]}"; return ;; esac
  mapfile -t absent < <(missing "${packages[@]}")
  [ ${#absent[@]} -eq 0 ] || install_packages "${absent[@]}"
  have_node || fail "the node on the PATH ($(command -v node) $(node --version 2>/dev/null)) is older than" \
    "$oldest_node, which the report page needs: remove it from the PATH or update it."
}

main "$@"
