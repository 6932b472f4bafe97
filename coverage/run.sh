#!/bin/sh
# Measures which lines and functions of lib/ the tests reach, writes build/coverage/report, and fails below the thresholds.
set -eu
cd "$(dirname "$0")/.."
least_lines=95
least_functions=95

cli/setup.sh --tests
cmake --preset coverage >/dev/null
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
# The others run the same code, only longer.
ctest --preset coverage --parallel "$(nproc)" --output-on-failure -LE "verification|docs"

cd build/coverage
lcov --quiet --capture --directory lib --output-file all.info --rc lcov_branch_coverage=0
lcov --quiet --extract all.info '*/lib/hompm/*' --output-file lib.info
genhtml --quiet --prefix "$(cd ../.. && pwd)" --output-directory report lib.info
lcov --summary lib.info 2>&1 | tee summary.txt

awk -v lines=$least_lines -v functions=$least_functions '
  $1 ~ /^lines/     { found++; if ($2 + 0 < lines)     { print "coverage: lines below " lines " %";         bad = 1 } }
  $1 ~ /^functions/ { found++; if ($2 + 0 < functions) { print "coverage: functions below " functions " %"; bad = 1 } }
  END { if (found != 2) { print "coverage: lcov gave no summary"; bad = 1 }; exit bad }' summary.txt
echo "coverage: report in build/coverage/report/index.html"
