#!/bin/sh
# Feeds what users bring, scenes and tables of results, with mutations of good and bad ones to the readers, SECONDS (60) for each
# reader, both at a time, under the address and undefined-behaviour sanitizers. Fails at a crash, a hang, a leak or too much memory; the
# file that did it is then in build/fuzz/findings. What was found to be of interest is kept, and the next run starts from it.
set -eu
cd "$(dirname "$0")/../.."
seconds=${1:-60}
cli/setup.sh --all
cmake --preset fuzz >/dev/null
cmake --build --preset fuzz --target fuzz_scene fuzz_csv -- --quiet

cd build/fuzz
mkdir -p seeds/scene seeds/csv corpus/scene corpus/csv findings
source=../..
cp $source/lib/cases/*.toml $source/docs/scenes/*.toml $source/tests/scenes/bad/*.toml seeds/scene
printf '#--set scheme.cells=7\n#--set effect.gravity.acceleration=1e1\n#--set body[0].length=2\n' |
  cat - $source/lib/cases/column-large.toml >seeds/scene/overrides.toml
for table in particles stress history; do
  sed -n '1,8p;700,704p' $source/golden/column-large-tielen2017/$table.csv >seeds/csv/$table.csv
done
# Quoted words are how libFuzzer wants its dictionary.
grep -oh '"[a-z][a-z0-9_.-]*"' $source/lib/hompm/scene_file/keys.cpp $source/lib/hompm/effects/*.cpp | tr -d '"' | tr . '\n' |
  sort -u | sed 's/.*/"&"/' >scene.dict
printf '"%s"\n' time particle X displacement velocity stress 1e400 nan inf -0 0x1p3 ',' ';' '\xef\xbb\xbf' '\x0d\x0a' >csv.dict

fuzz() {
  echo "fuzz: $1 for $seconds s"
  # A small quarantine: the buffers of one file are large beside the file.
  ASAN_OPTIONS=quarantine_size_mb=4 tests/fuzz/fuzz_"$1" -max_total_time="$seconds" -max_len="$2" -dict="$1".dict \
    -timeout=5 -rss_limit_mb=1024 -malloc_limit_mb=256 -artifact_prefix=findings/"$1"- -print_funcs=0 -print_final_stats=1 \
    -verbosity=0 corpus/"$1" seeds/"$1" >"$1".log 2>&1 || {
    tail -n 60 "$1".log >&2
    exit 1
  }
  grep -E 'number_of_executed|peak_rss' "$1".log
}
fuzz scene 16384 &
scene=$!
fuzz csv 4096 &
csv=$!
failed=0
wait $scene || failed=1
wait $csv || failed=1
exit $failed
