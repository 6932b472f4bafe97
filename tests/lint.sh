#!/bin/sh
# Fails when a file is not formatted as .clang-format says, or clang-tidy finds what .clang-tidy forbids.
set -eu
cd "$(dirname "$0")/.."
cli/setup.sh --all
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
cmake --preset clang -DHOMPM_TESTS=OFF -DHOMPM_UNITE=OFF -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >/dev/null
tests/tidy.py build/clang
