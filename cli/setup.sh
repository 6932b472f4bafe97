#!/bin/sh
# Installs the Debian packages that building hompm needs; with --tests those of tests/run.sh, too, and with --all those of
# tests/run.sh all. Does nothing when all are there.
set -eu

packages="g++ cmake ninja-build libboost-dev libboost-program-options-dev libtomlplusplus-dev nlohmann-json3-dev zlib1g-dev"
case "${1:-}" in
  --tests | --all) packages="$packages git catch2 libeigen3-dev python3 python3-meshio python3-numpy pybind11-dev python3-dev valgrind gnuplot-nox" ;;
esac
if [ "${1:-}" = --all ]; then
  packages="$packages octave python3-matplotlib clang clang-format clang-tidy llvm lcov snakemake"
  # other architectures, for the reproducibility tests
  packages="$packages g++-aarch64-linux-gnu g++-s390x-linux-gnu qemu-user"
fi

if ! command -v dpkg-query >/dev/null 2>&1; then
  echo "setup: this is not a Debian system; install the equivalents of: $packages" >&2
  exit 0
fi
missing=""
for package in $packages; do
  dpkg-query -W -f '${Status}' "$package" 2>/dev/null | grep -q 'ok installed' || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

if [ "$(id -u)" = 0 ]; then
  root=""
elif command -v sudo >/dev/null 2>&1; then
  root="sudo"
else
  echo "setup: these packages are missing, and only root can install them:$missing" >&2
  echo "setup: run as root: apt-get install$missing" >&2
  exit 1
fi
echo "setup: installing$missing"
log=$(mktemp)
trap 'rm -f "$log"' EXIT
if ! { $root apt-get update && DEBIAN_FRONTEND=noninteractive $root apt-get install -y --no-install-recommends $missing; } >"$log" 2>&1; then
  tail -n 20 "$log" >&2
  echo "setup: apt-get could not install:$missing" >&2
  exit 1
fi
