#!/usr/bin/env bash
# run_tests.sh wheel|tests SOURCE WORK PROGRAM — what ctest runs of the Python package.
#
#   wheel   WORK/wheels: third-party packages, fetched once · WORK/dist: our wheel, by pip from the sources
#           built in <build folder>-wheel
#           WORK/clean: a virtual environment with the wheel and NumPy alone, in which it is imported
#   tests   WORK/venv: the same with everything optional; mypy, pytest and the doctests
#
# The compiler's cache serves what the C++ build has compiled already. Fails with a word where Python or its packages are
# not to be had; nothing is skipped.
set -euo pipefail
readonly goal="$1" source="$2" work="$3" program="$4"
readonly built="$(dirname "$work")-wheel"  # beside the C++ build: ccache knows sources by their path from the build folder
readonly python="${GLISSON_PYTHON:-python3}"

fail() { printf 'python: %s\n' "$1" >&2; exit 1; }
quiet() { "$@" >"$work/log" 2>&1 || { tail -n 40 "$work/log" >&2; return 1; }; }

# What pyproject.toml asks for: to build, to run, to test; one a line.
wanted() {
  "$python" - "$source/pyproject.toml" <<'PY'
import sys, tomllib
project = tomllib.load(open(sys.argv[1], "rb"))
extras = project["project"]["optional-dependencies"]
names = ("plot", "meshes", "workbooks", "cluster")
rows = project["build-system"]["requires"] + project["project"]["dependencies"] + [r for n in names for r in extras[n]]
print(*dict.fromkeys(rows + [r for r in extras["test"] if not r.startswith("glisson")]), sep="\n")
PY
}

fetch() {
  "$python" -c 'import sys; sys.exit(sys.version_info < (3, 11))' || fail "$python is older than 3.11"
  "$python" -c 'import ensurepip' 2>/dev/null || fail "$python has no venv: install python3-venv (make setup)"
  mkdir -p "$work"
  wanted >"$work/wanted"
  [ -x "$work/venv/bin/python" ] || "$python" -m venv "$work/venv"
  if cmp -s "$work/wanted" "$work/fetched"; then return; fi
  quiet "$work/venv/bin/pip" wheel --prefer-binary -w "$work/wheels" -r "$work/wanted" ||
    fail "the packages of pyproject.toml cannot be fetched (the lines above): is the network there?"
  quiet "$work/venv/bin/pip" install --no-index --find-links "$work/wheels" -r "$work/wanted"
  cp "$work/wanted" "$work/fetched"
}

build_wheel() {
  rm -rf "$work/dist"
  quiet "$work/venv/bin/pip" wheel "$source" --no-deps --no-build-isolation -w "$work/dist" --config-settings "build-dir=$built" ||
    fail "the wheel cannot be built (the lines above)"
  ls -l "$work/dist"
}

import_in_clean() {
  rm -rf "$work/clean"
  "$python" -m venv "$work/clean"
  quiet "$work/clean/bin/pip" install --no-index --find-links "$work/wheels" "$work"/dist/glisson-*.whl
  cd "$work" && "$work/clean/bin/python" -I "$source/tests/python/clean_import.py"
}

run_tests() {
  quiet "$work/venv/bin/pip" install --no-index --no-deps --force-reinstall "$work"/dist/glisson-*.whl
  cd "$work"
  "$work/venv/bin/mypy" --config-file "$source/pyproject.toml" -p glisson
  export GLISSON_PROGRAM="$program" MPLBACKEND=Agg
  "$work/venv/bin/python" -m pytest -q -rs -p no:cacheprovider --rootdir "$source/tests/python" --durations=5 \
    "$source/tests/python"
  "$work/venv/bin/python" -m pytest -q -rs -p no:cacheprovider --doctest-modules --doctest-glob='*.none' \
    -o doctest_optionflags='ELLIPSIS IGNORE_EXCEPTION_DETAIL' --pyargs glisson
}

case "$goal" in
  wheel)
    fetch
    build_wheel
    import_in_clean
    ;;
  tests) run_tests ;;
  *) fail "unknown goal '$goal': wheel or tests" ;;
esac
