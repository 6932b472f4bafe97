#!/usr/bin/env python3
"""Runs the other codes of golden/examples and lets hompm-diff judge them.

    tests/golden/check_examples.py build/release/bin [EXAMPLE ...]     all, or those named

They share no line with hompm, so they also say that the golden data are what the schemes make of the scenes.
"""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
EXAMPLES = ROOT / "golden/examples"
# The interpreter, the example, the golden folder, the bound on the largest distance from golden over the largest value of
# the field: as measured, times ten or so, and the largest error against the exact solution, which is that of the scheme.
RUNS = [
    # Same formulas and step: sums in another order. Measured 5.4e-15.
    (["/usr/bin/python3"], "classical_mpm.py", "bar-small-classical", 1e-13, 0.5),
    # Same formulas, ten times the step: measured 5.7e-4 in the velocity.
    (["octave-cli", "--no-gui"], "bspline_mpm.m", "bar-small-bspline", 5e-3, 0.015),
]


def judge(tool, csv, golden, *options):
    done = subprocess.run([tool, "--json", *options, csv, golden], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        sys.exit(f"hompm-diff: exit code {done.returncode}: {done.stderr.strip()}")
    return json.loads(done.stdout)


def main():
    tool = pathlib.Path(sys.argv[1]).resolve() / "hompm-diff"
    complaints = []
    runs = [run for run in RUNS if len(sys.argv) == 2 or run[1] in sys.argv[2:]]
    if not runs:
        sys.exit(f"there is no example {' '.join(sys.argv[2:])}")
    for interpreter, example, name, distance, error in runs:
        if shutil.which(interpreter[0]) is None:
            complaints.append(f"{example}: {interpreter[0]} is not installed")
            continue
        with tempfile.TemporaryDirectory() as work:
            csv = pathlib.Path(work) / "mine.csv"
            done = subprocess.run([*interpreter, EXAMPLES / example, csv], capture_output=True, text=True, check=False)
            if done.returncode != 0 or done.stdout.count("largest distance") != 3:
                complaints.append(f"{example}: exit code {done.returncode}: {done.stdout}{done.stderr}")
                continue
            golden = ROOT / "golden" / name
            report = judge(tool, csv, golden, "--relative", f"all={distance}", "--exact", f"all={error}")
            worst = max(field["difference"]["max"] / field["largest"] for field in report["fields"])
            print(f"{example}: {report['verdict']}, largest distance {worst:.1e} of the largest value")
            if report["verdict"] != "equivalent":
                complaints.append(f"{example}: {report['messages']} {report['fields']}")
            # A bound that nothing could break would be none.
            for option in (f"--relative=all={worst / 2}", f"--exact=all={error / 20}"):
                if judge(tool, csv, golden, option)["verdict"] != "different":
                    complaints.append(f"{example}: {option} does not make it different")
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
