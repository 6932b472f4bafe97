#!/bin/sh
# Runs the tests under the address and undefined-behaviour sanitizers, measures which lines, functions and branches of lib/
# they reach, writes build/coverage/report, and fails below the thresholds of measure.py.
set -eu
cd "$(dirname "$0")/.."

cli/setup.sh --all
cmake --preset coverage >/dev/null
cmake --build --preset coverage --target test_unit test_cli test_faults random_scenes hompm-run hompm-diff hompm-study
rm -rf build/coverage/profiles
# Limits on the size of files and on memory stop profile and sanitizer, too; callgrind cannot read clang's debug information.
unfit="no room for checkpoints|does not fit in memory|instructions repeat|counted steps|one worker, with two|NOT_BUILT"
# The others run the same code, only longer. Programs that run at the same time share four files of counts.
LLVM_PROFILE_FILE="$PWD/build/coverage/profiles/%4m.profraw" \
  ctest --preset coverage --parallel "$(nproc)" --output-on-failure --output-junit "$PWD/build/coverage/tests.xml" -LE "verification|stability|golden|docs|cost|reproducibility" -E "$unfit"

cd build/coverage
llvm-profdata merge -sparse profiles/*.profraw -o tests.profdata
programs="-object tests/test_cli -object tests/test_faults -object bin/hompm-run -object bin/hompm-diff -object bin/hompm-study"
library="$(cd ../.. && pwd)/lib/hompm"
# shellcheck disable=SC2086
llvm-cov show -format=html -show-branches=count -instr-profile tests.profdata -output-dir branches \
  tests/test_unit $programs "$library"
# shellcheck disable=SC2086
llvm-cov export -format=lcov -instr-profile tests.profdata tests/test_unit $programs "$library" >lib.info
genhtml --quiet --legend --title "hompm: lib/" --prefix "$library" --output-directory report lib.info
../../coverage/measure.py tests.profdata tests/test_unit tests/test_cli tests/test_faults bin/hompm-run bin/hompm-diff bin/hompm-study --missed missed.txt
echo "coverage: report in build/coverage/report/index.html, branches in build/coverage/branches/index.html,"
echo "          what is not reached in build/coverage/missed.txt"
