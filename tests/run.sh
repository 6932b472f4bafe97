#!/bin/sh
# Builds hompm and runs all its tests. Extra arguments go to ctest, as in: tests/run.sh -R simulation
# PRESET names another preset of CMakePresets.json (debug, clang, sanitise).
set -eu
cd "$(dirname "$0")/.."
cli/setup.sh --tests
preset=${PRESET:-release}
cmake --preset "$preset" >/dev/null
cmake --build --preset "$preset"
ctest --preset "$preset" --parallel "$(nproc)" "$@"
