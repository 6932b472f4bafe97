#!/usr/bin/env python3
"""What a run watches costs less than 1 % of its steps: guards, and the critical step computed again.

    tests/cost/check_watch.py build/release/tests/step_scene

Instructions are counted by callgrind, of as many steps as lie between two computations of the critical step: all but one step in
8192 are cheap.
"""
import concurrent.futures
import os
import pathlib
import re
import subprocess
import sys
import tempfile

from check_cost import STEADY

MOST = 0.01  # of the instructions of the steps; measured: 0.74 % and 0.87 %
BETWEEN = 8192  # StepWatch::look
# The large bar, whose particles cross cells all the time; high-order with fewer cells, since it takes four times as long.
SCENES = {"bspline": 64, "high-order": 16}


def scene_text(scheme, cells):
    return f"""end_time = 1.0
body.length = 25
material = {{ law = "rate", density = 1, youngs_modulus = 100 }}
initial.velocity = {{ shape = "sine", amplitude = 1 }}
scheme = {{ name = "{scheme}", cells = {cells}, particles_per_cell = 4, time_step = 1e-4 }}
output = {{ history = 1, snapshots = 1 }}
"""


def instructions(tool, scheme, steps, watched):
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        (work / "scene.toml").write_text(scene_text(scheme, SCENES[scheme]), encoding="utf-8")
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={work}/callgrind.out", tool, str(steps), work / "scene.toml"]
        done = subprocess.run(command + ["watched"] * watched, env=os.environ | STEADY, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{scheme}: {done.stderr}")
        return int(re.search(r"Collected : (\d+)", done.stderr)[1])


def main():
    tool = sys.argv[1]
    # From 128 steps on, so that what the first of everything costs is left out, to a step after the computation.
    first, last = 128, 128 + BETWEEN
    runs = [(scheme, steps, watched) for scheme in SCENES for watched in (False, True) for steps in (first, last)]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        counts = dict(zip(runs, pool.map(lambda run: instructions(tool, *run), runs)))
    failed = False
    for scheme in SCENES:
        bare, watched = (counts[scheme, last, how] - counts[scheme, first, how] for how in (False, True))
        share = watched / bare - 1.0
        failed |= share > MOST
        print(f"{scheme}: {bare / BETWEEN:.0f} instructions a step, {100 * share:+.2f} % with all that is watched; at most {100 * MOST:.0f} %")
    sys.exit("watching costs more than it may" if failed else 0)


if __name__ == "__main__":
    main()
