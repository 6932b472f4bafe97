#!/bin/sh
# Fails when a file is not formatted as .clang-format says, or clang-tidy finds what .clang-tidy forbids.
set -eu
cd "$(dirname "$0")/.."
cli/setup.sh --all
git ls-files '*.cpp' '*.hpp' | xargs clang-format --dry-run --Werror
[ -f build/clang/compile_commands.json ] || cmake --preset clang >/dev/null
git ls-files 'lib/*.cpp' 'cli/*.cpp' | xargs -P "$(nproc)" -n 4 clang-tidy -p build/clang --quiet --warnings-as-errors='*' 2>/dev/null
