#!/usr/bin/env python3
"""What a step costs: linear in the particles, and within the first marks for speed.

    tests/cost/check_cost.py build/release/bin

Instructions are counted by callgrind: two runs that differ only in the number of steps give those of the steps alone, to
the instruction. Nanoseconds are the least of five runs, so that other work on the machine hardly shows.
`bspline` is held against bare loops (bare_bspline.cpp) that give the same bits, measured in the same run.
"""
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

# Instructions per particle and step at 4 particles per cell: as measured with g++ 12, plus 15 %. A cost that grows past them has a
# reason that someone should know.
MOST_INSTRUCTIONS = {"classical": 175, "bspline": 235, "tielen2017": 515, "high-order": 1100}
# Nanoseconds per particle and step for 256 particles on one core.
MOST_NANOSECONDS = {"tielen2017": 100}

# The library's step of bspline over that of bare loops. Measured: 1.2 in instructions and in time; the plan's stages, each a pass
# over the particles, may cost half as much again. Times are the least of 20 rounds by turns; the best of three such races
# counts, since a busy neighbour makes either side slower, never faster.
MOST_OF_BARE = 1.5

# Above 2 KB glibc copies and clears arrays by one repeated instruction, of which callgrind counts every turn; now by vectors at any size.
STEADY = {"GLIBC_TUNABLES": "glibc.cpu.x86_rep_movsb_threshold=0x40000000:glibc.cpu.x86_rep_stosb_threshold=0x40000000"}


def command(tool, scheme, cells, steps, folder):
    options = ["--case", "bar", "--scheme", scheme, "--cells", str(cells), "--set", "output.history=1", "--snapshots", "1"]
    time_step = 1e-5
    return [str(tool), *options, "--time-step", str(time_step), "--end-time", repr(steps * time_step), "--no-vtk", "--quiet",
            "--output", str(folder)]


def instructions(command_of_steps, cells, folder):
    def count(steps):
        valgrind = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/callgrind.out"]
        done = subprocess.run(valgrind + command_of_steps(steps), env=os.environ | STEADY, capture_output=True, text=True, check=True)
        return int(re.search(r"Collected : (\d+)", done.stderr)[1])

    return (count(60) - count(10)) / 50 / (4 * cells)


def against_bare_loops(bare, folder):
    """Ratios of instructions and of times of the library's bspline to those of the bare loops."""
    subprocess.run([bare, "check", "64", "5000"], check=True)
    counts = [instructions(lambda steps: [bare, mode, "64", str(steps)], 64, folder) for mode in ("library", "bare")]
    print("bspline: {:.0f} instructions, {:.0f} in bare loops".format(*counts))
    races = []
    for _ in range(3):
        race = subprocess.run([bare, "time", "64", "1000"], capture_output=True, text=True, check=True)
        least_bare, least = map(float, race.stdout.split())
        print(f"bspline: {least:.1f} ns per particle and step for 256 particles, {least_bare:.1f} in bare loops")
        races.append(least / least_bare)
    return counts[0] / counts[1], min(races)


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
            few, many = (
                instructions(lambda steps: command(tool, scheme, cells, steps, folder), cells, folder) for cells in (64, 512))
            linear = many <= 1.02 * few  # measured: 0.98 … 0.99, since the ends of the body make few particles dearer
            failed |= few > most or not linear
            print(f"{scheme}: {few:.0f} instructions per particle and step for 256 particles, {many:.0f} for 2048; at most {most}")
        bare = tool.parent.parent / "tests" / "bare_bspline"
        for what, ratio in zip(("instructions", "time"), against_bare_loops(str(bare), folder)):
            failed |= ratio > MOST_OF_BARE
            print(f"bspline: {ratio:.2f} times the {what} of bare loops; at most {MOST_OF_BARE}")
        for scheme, most in MOST_NANOSECONDS.items():
            least = nanoseconds(tool, scheme, folder)
            failed |= least > most
            print(f"{scheme}: {least:.0f} ns per particle and step for 256 particles; at most {most}")
    sys.exit("a step costs more than it may" if failed else 0)


if __name__ == "__main__":
    main()
