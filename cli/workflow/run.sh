#!/bin/sh
# Runs a study by Snakemake: cli/workflow/run.sh STUDY OUTPUT [options of snakemake, such as --cores 4]
# HOMPM_BIN names the folder of hompm-study where it is not on the PATH, HOMPM_REPEATS the rounds of times.
set -eu
if [ $# -lt 2 ]; then
  echo "usage: cli/workflow/run.sh STUDY OUTPUT [options of snakemake, such as --cores 4]" >&2
  exit 2
fi
study=$1
output=$2
shift 2
exec snakemake --snakefile "$(dirname "$0")/Snakefile" "$@" \
  --config study="$study" output="$output" ${HOMPM_BIN:+bin="$HOMPM_BIN"} repeats="${HOMPM_REPEATS:-5}"
