#!/bin/sh
# Builds hompm and runs its tests:
#   tests/run.sh [default]   what judges this build
#   tests/run.sh quick       the same without what takes long
#   tests/run.sh all         every compiler and architecture, long runs, coverage, fuzzers and lint, too
#   tests/run.sh rest        what `all` adds to the default
# Further arguments go to ctest, which is then all that runs, as in: tests/run.sh -R simulation, tests/run.sh all -L reproducibility.
# PRESET names another preset of CMakePresets.json (debug, clang, sanitise). At the end: each part with its time, and a count.
set -eu
cd "$(dirname "$0")/.."
which=default
case "${1:-}" in default | quick | all | rest) which=$1 && shift ;; esac
preset=${PRESET:-release}
logs=build/$preset-tests
rm -rf "$logs"
mkdir -p "$logs"
failed=0

# part NAME COMMAND...: goes on after a failure, to say at the end what failed.
part() {
  printf '\n== %s\n' "$1"
  begin=$(date +%s)
  result=passed
  name=$1 && shift
  "$@" || { result=FAILED && failed=1; }
  echo "$result $(($(date +%s) - begin)) $name" >>"$logs/parts"
}
tests() { # NAME OPTIONS...
  junit=$PWD/$logs/$1.xml && shift
  ctest --preset "$preset" --parallel "$(nproc)" --output-junit "$junit" "$@"
}
build() { cmake --preset "$preset" >/dev/null && cmake --build --preset "$preset" "$@"; }
finish() {
  tests/summary.py "$logs"
  exit $failed
}

case $which in all | rest) packages=--all ;; *) packages=--tests ;; esac
part "packages" cli/setup.sh $packages
[ $failed = 0 ] || finish
if [ $which = rest ]; then part "build" build --target tests_of_all; else part "build" build; fi
[ $failed = 0 ] || finish

if [ $# -gt 0 ]; then
  case $which in all) everything="-C all" ;; rest) everything="-C all -L ^all$" ;; *) everything="" ;; esac
  # shellcheck disable=SC2086
  part "tests" tests tests $everything "$@"
  finish
fi
case $which in
  quick) part "tests" tests quick -LE "^(random|accuracy|docs|cost|package|python|reproducibility)$" ;;
  default) part "tests" tests default ;;
  all) part "tests" tests all -C all ;;
  rest) part "tests" tests rest -C all -L "^all$" ;;
esac
case $which in
  all | rest)
    rm -f build/coverage/tests.xml
    part "tests with clang++ and its sanitizers, and what they reach" coverage/run.sh
    cp build/coverage/tests.xml "$logs/sanitised.xml" || true
    part "mutants" coverage/mutate.py --check
    part "fuzzers" tests/fuzz/run.sh
    part "formatting and lint" tests/lint.sh
    ;;
esac
finish
