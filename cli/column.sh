#!/bin/sh
# Builds hompm and runs the column under self-weight: against the exact solution, and against the golden data.
# Draws the run where gnuplot is installed. Extra arguments go to hompm-run.
set -eu
cd "$(dirname "$0")/.."
cli/setup.sh
cmake --preset release -DHOMPM_TESTS=OFF -B build/column >build-column.log 2>&1 && cmake --build build/column >>build-column.log 2>&1 || {
  tail -n 30 build-column.log >&2
  exit 1
}
rm build-column.log
if [ $# -eq 0 ] && command -v gnuplot >/dev/null; then set -- --picture build/column/column.svg; fi
exec build/column/bin/hompm-run --case column --check golden/column-large-tielen2017 "$@"
