#!/usr/bin/env python3
"""Runs an example scene and holds it to what it says of itself.

    tests/scenes/run_example.py build/release/bin docs/scenes/traction-sine.toml

Its table [require] says how exact it must be, which the tool itself demands, and lines of its own what else is known:

    # expect: stress at X = 0.5 is -4e4 within 1e-2    relative error at a point at the end, of a solution the scene explains
    # expect: momentum.end is -0.1 within 1e-3         absolute error of a number of run.json
    # expect: exit 2, saying "is above the critical"   it does not run, or not to the end, and leaves nothing that looks like a result
"""
import csv
import json
import pathlib
import re
import subprocess
import sys
import tempfile


def at_end(folder, field, place):
    """Of the last snapshot, between the two particles next to a place X."""
    name = "stress.csv" if field in ("stress", "stretch") else "particles.csv"
    with open(folder / name, newline="", encoding="ascii") as file:
        rows = list(csv.DictReader(file))
    points = sorted((float(row["X"]), float(row[field])) for row in rows if row["time"] == rows[-1]["time"])
    for (a, below), (b, above) in zip(points, points[1:]):
        if a <= place <= b:
            return below + (above - below) * (place - a) / (b - a)
    sys.exit(f"no particles next to X = {place}")


def main():
    tool, scene = pathlib.Path(sys.argv[1]).resolve() / "hompm-run", pathlib.Path(sys.argv[2])
    text = scene.read_text(encoding="utf-8")
    expected = re.findall(r"^# expect: (.*)$", text, re.MULTILINE)
    if not expected and "[require]" not in text:
        sys.exit(f"{scene}: no table [require], and no line `# expect: momentum.end is 0 within 1e-3` or the like")
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        output = pathlib.Path(folder) / "out"
        done = subprocess.run([tool, "--scene", scene, "--json", "--no-vtk", "--errors", "full" if "[require]" in text else "auto", "--output", output], capture_output=True, text=True, check=False)
        if refusals := [(int(code), words) for code, words in re.findall(r'^# expect: exit (\d), saying "(.*)"$', "\n".join(f"# expect: {line}" for line in expected), re.MULTILINE)]:
            for code, words in refusals:
                failed |= done.returncode != code or words not in done.stderr
            failed |= output.exists() and {path.name for path in output.iterdir()} != {"invalid"}
            print(f"exit code {done.returncode}: {done.stderr.strip()}")
            sys.exit(f"{scene}: not the exit code and the message it says" if failed else 0)
        if done.returncode != 0:
            sys.exit(f"{scene}: exit code {done.returncode}: {done.stderr.strip()}")
        report = json.loads(done.stdout)
        for line in expected:
            if point := re.fullmatch(r"(\w+) at X = (\S+) is (\S+) within (\S+)", line):
                field, place, value, bound = point[1], *map(float, point.groups()[1:])
                error = abs(at_end(output, field, place) / value - 1.0)
            else:
                number = re.fullmatch(r"([\w.]+) is (\S+) within (\S+)", line)
                found = report
                for key in number[1].split("."):
                    found = found[int(key) if key.isdigit() else key]
                error, bound = abs(found - float(number[2])), float(number[3])
            failed |= not error <= bound
            print(f"{line}: error {error:.2e}")
        print(report["verdict"]["text"])
    sys.exit(f"{scene}: not as exact as it says" if failed else 0)


if __name__ == "__main__":
    main()
