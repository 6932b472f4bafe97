#!/bin/sh
# Feeds what users bring, files of each kind and command lines, with mutations of good and bad ones to what reads them, SECONDS (60) for
# each, as many at a time as there are processors, under the address and undefined-behaviour sanitizers. Fails at a crash, a hang, a leak or
# too much memory; the input that did it is then in build/fuzz/findings. What was found to be of interest is kept, and the next run starts
# from it.
#   tests/fuzz/run.sh [SECONDS [TARGET...]]
set -eu
cd "$(dirname "$0")/../.."
export seconds="${1:-60}"
[ $# -eq 0 ] || shift
[ $# -gt 0 ] || set -- scene csv checkpoint trace study command
cli/setup.sh --all
cmake --preset fuzz >/dev/null
targets=$(printf 'fuzz_%s ' "$@")
# shellcheck disable=SC2086
cmake --build --preset fuzz --target $targets -- --quiet

cd build/fuzz
source=../..
rm -rf seeds files
for target in "$@"; do mkdir -p "seeds/$target" "corpus/$target"; done
mkdir -p seeds/scene seeds/csv seeds/study seeds/command files/golden findings
cp $source/lib/cases/*.toml $source/docs/scenes/*.toml $source/tests/scenes/bad/*.toml seeds/scene
printf '#--set scheme.cells=7\n#--set effect.gravity.acceleration=1e1\n#--set body[0].length=2\n' |
  cat - $source/lib/cases/column-large.toml >seeds/scene/overrides.toml
for table in particles stress history; do
  sed -n '1,8p;700,704p' $source/golden/column-large-tielen2017/$table.csv >seeds/csv/$table.csv
  sed -n '1,9p' $source/golden/bar-small-bspline/$table.csv >files/golden/$table.csv
done
cp $source/docs/studies/*.toml seeds/study
printf '{"name": "cells=8", "program": "x", "scene": "", "seconds": [0.1, 2e-3]}' >seeds/study/times.json
printf 'cells=4,8,degree' >seeds/study/axes
for target in "$@"; do
  case $target in checkpoint | trace) HOMPM_SEEDS=seeds/$target tests/fuzz/fuzz_$target ;; esac
done
# What command lines may name, and command lines: a tool, and its arguments, a line for each.
cp $source/golden/bar-small-bspline/scene.toml files/golden
cp $source/docs/scenes/absorbing.toml files/my.toml
cp $source/docs/studies/bar-small.toml files/study.toml
printf 'X,time,displacement\n0.1,0,0\n0.2,0,1e-3\n' >files/theirs.csv
while read -r line; do
  [ -z "$line" ] || printf '%s\n' "$line" | tr ' ' '\n' >"seeds/command/$(printf '%s' "$line" | cksum | cut -d' ' -f1)"
done <<COMMANDS
run --case bar --variant large --scheme bspline --cells 8
run --scene my.toml --set scheme.cells=4 --set effect.gravity.acceleration=1 --output out
run --check golden --no-vtk
run --resume golden
exact --case column --at 0:1:3 --times 0,0.01 --jumps
exact --case bar --times 0:0.01:3 --json --output exact.csv
run --case column --scheme high-order --degree 4 --courant 0.1 --end-time 0.1 --snapshots 3 --checkpoint 10 --trace t --trace-values 3
run --case bar --critical-step --json
run --list --json
run --keys --quiet
run --case bar --particles-per-cell 2 --time-step 1e-3 --step-fraction 0.5
diff golden golden
diff --ulps all=4 --relative stress=1e-9 --absolute displacement=1e-12 golden golden --json
diff --relative all=1e-2 theirs.csv golden
diff --trace theirs.csv golden --quiet
study --case bar --variant small --vary cells,degree --set end_time=0.1 --jobs 1
study --scene my.toml --vary scheme=bspline,apic --vary cells=4,8 --repeats 0
study --study study.toml --point cells=4 --no-instructions
study --case column --advise --error 1e-3 --field stress
study --count golden
COMMANDS
# Quoted words are how libFuzzer wants its dictionary.
grep -oh '"[a-z][a-z0-9_.-]*"' $source/lib/hompm/kit/scene_file/keys.cpp $source/lib/hompm/effects/*.cpp | tr -d '"' | tr . '\n' |
  sort -u | sed 's/.*/"&"/' >scene.dict
cp scene.dict study.dict
grep -oh '"[a-z][a-z-]*"' $source/cli/hompm-*.cpp $source/cli/scene_choice.cpp $source/cli/diff_options.cpp | sort -u | sed 's/"\(.*\)"/"--\1"/' | cat - scene.dict >command.dict
printf '"%s"\n' time particle X displacement velocity stress 1e400 nan inf -0 0x1p3 ',' ';' '\xef\xbb\xbf' '\x0d\x0a' >csv.dict
printf '"%s"\n' '\xff\xff' '\xfe\xff' '\xfd\xff' '\xfc\xff' '\xff\xff\xff\xff\xff\xff\xff\xff' '\x00\x00\x00\x00\x00\x00\x00\x00' >trace.dict
cp trace.dict checkpoint.dict

cat >fuzz.sh <<'EOS'
target=$1
# Longest input, and seconds that one may take: a study of many points is checked point by point.
case $target in scene | study) size=16384 limit=5 ;; csv) size=4096 limit=5 ;; command) size=1024 limit=20 ;; *) size=32768 limit=5 ;; esac
echo "fuzz: $target for $seconds s"
# A small quarantine: the buffers of one file are large beside the file.
ASAN_OPTIONS=quarantine_size_mb=4 HOMPM_FILES=$PWD/files tests/fuzz/fuzz_"$target" -max_total_time="$seconds" -max_len=$size -dict="$target".dict \
  -timeout=$limit -rss_limit_mb=1024 -malloc_limit_mb=256 -artifact_prefix="$PWD/findings/$target-" -print_funcs=0 -print_final_stats=1 \
  -verbosity=0 "$PWD/corpus/$target" "$PWD/seeds/$target" >"$target".log 2>&1 || {
  tail -n 60 "$target".log >&2
  exit 1
}
echo "fuzz: $target: $(grep -E 'number_of_executed|peak_rss' "$target".log | tr -s ' \n' ' ')"
EOS
printf '%s\n' "$@" | xargs -P "$(nproc)" -n 1 sh fuzz.sh
