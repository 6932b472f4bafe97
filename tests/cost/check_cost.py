#!/usr/bin/env python3
"""What a step costs: linear in the particles, and within the first marks for speed.

    tests/cost/check_cost.py build/release/bin

Instructions are counted by callgrind: two runs that differ only in the number of steps give those of the steps alone, to
the instruction. Nanoseconds are the least of five runs, so that other work on the machine hardly shows.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile

# Instructions per particle and step at 4 particles per cell: as measured with g++ 12, plus 15 %. A cost that grows past them has a
# reason that someone should know.
MOST_INSTRUCTIONS = {"classical": 225, "bspline": 365, "tielen2017": 800, "high-order": 1500}
# Nanoseconds per particle and step for 256 particles on one core.
MOST_NANOSECONDS = {"tielen2017": 100}


def command(tool, scheme, cells, steps, folder):
    options = ["--case", "bar", "--scheme", scheme, "--cells", str(cells), "--set", "output.history=1", "--snapshots", "1"]
    time_step = 1e-5
    return [str(tool), *options, "--time-step", str(time_step), "--end-time", repr(steps * time_step), "--no-vtk", "--quiet",
            "--output", str(folder)]


def instructions(tool, scheme, cells, folder):
    def count(steps):
        valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out"]
        done = subprocess.run(valgrind + command(tool, scheme, cells, steps, folder), capture_output=True, text=True, check=True)
        return int(re.search(r"Collected : (\d+)", done.stderr)[1])

    return (count(60) - count(10)) / 50 / (4 * cells)


def nanoseconds(tool, scheme, folder):
    least = float("inf")
    for _ in range(5):
        subprocess.run(command(tool, scheme, 64, 10000, folder), check=True)
        timing = json.loads((pathlib.Path(folder) / "timing.json").read_text())
        least = min(least, timing["nanoseconds_per_particle_and_step"])
    return least


def main():
    tool = pathlib.Path(sys.argv[1]).resolve() / "hompm-run"
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for scheme, most in MOST_INSTRUCTIONS.items():
            few, many = (instructions(tool, scheme, cells, folder) for cells in (64, 512))
            linear = many <= 1.02 * few  # the ends of the body make few particles dearer, never cheaper
            failed |= few > most or not linear
            print(f"{scheme}: {few:.0f} instructions per particle and step for 256 particles, {many:.0f} for 2048; at most {most}")
        for scheme, most in MOST_NANOSECONDS.items():
            least = nanoseconds(tool, scheme, folder)
            failed |= least > most
            print(f"{scheme}: {least:.0f} ns per particle and step for 256 particles; at most {most}")
    sys.exit("a step costs more than it may" if failed else 0)


if __name__ == "__main__":
    main()
