#!/bin/sh
# Measures which lines and functions of lib/ the tests reach, writes build/coverage/report, and fails below the thresholds.
set -eu
cd "$(dirname "$0")/.."
least_lines=98
least_functions=99

cli/setup.sh --tests
cmake --preset coverage >/dev/null
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
rm -f build/coverage/missed.txt
# The others run the same code, only longer.
ctest --preset coverage --parallel "$(nproc)" --output-on-failure -LE "verification|docs|cost|reproducibility"

cd build/coverage
lcov --quiet --capture --directory . --output-file all.info 2>/dev/null
lcov --quiet --extract all.info '*/lib/hompm/*' --output-file lib.info
genhtml --quiet --prefix "$(cd ../.. && pwd)" --output-directory report lib.info

# lcov counts every instantiation of a template as a function of its own; here a function is a place in the source, and it is
# reached when one of its instantiations is.
awk -F '[:,]' -v least_lines=$least_lines -v least_functions=$least_functions '
  $1 == "SF" { file = $2 }
  $1 == "FN" { place[file, $3] = file ":" $2; known[file ":" $2] = 1 }
  $1 == "FNDA" && $2 > 0 { reached[place[file, $3]] = 1 }
  $1 == "DA" { lines++; if ($3 > 0) lines_reached++; else print "not reached: " file ":" $2 > "missed.txt" }
  END {
    for (f in known) { functions++; if (f in reached) functions_reached++; else print "not reached: function at " f > "missed.txt" }
    if (lines == 0 || functions == 0) { print "coverage: lcov found nothing"; exit 1 }
    l = 100 * lines_reached / lines
    f = 100 * functions_reached / functions
    printf "coverage of lib/: %.1f %% of %d lines, %.1f %% of %d functions\n", l, lines, f, functions
    if (l < least_lines || f < least_functions) { print "coverage: below the threshold of " least_lines " % lines, " least_functions " % functions"; exit 1 }
  }' lib.info
echo "coverage: report in build/coverage/report/index.html, what is not reached in build/coverage/missed.txt"
