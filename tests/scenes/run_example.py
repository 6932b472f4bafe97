#!/usr/bin/env python3
"""Runs an example scene and holds it to what it says of itself.

    tests/scenes/run_example.py build/release/bin docs/scenes/traction-sine.toml

A line `# expect: displacement 1e-3` in the scene bounds the relative L2 error of that field against the reference solution.
"""
import json
import pathlib
import re
import subprocess
import sys
import tempfile


def main():
    tool, scene = pathlib.Path(sys.argv[1]).resolve() / "hompm-run", pathlib.Path(sys.argv[2])
    with tempfile.TemporaryDirectory() as folder:
        options = ["--scene", scene, "--json", "--no-vtk", "--output", pathlib.Path(folder) / "out"]
        done = subprocess.run([tool, *options], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{scene}: exit code {done.returncode}: {done.stderr.strip()}")
    report = json.loads(done.stdout)
    bounds = re.findall(r"^# expect: (\w+) (\S+)$", scene.read_text(encoding="utf-8"), re.MULTILINE)
    if not bounds:
        sys.exit(f"{scene}: no line `# expect: displacement 1e-3` or the like")
    failed = False
    for field, bound in bounds:
        error = report["errors"][field]["relative_l2"]
        failed |= not error <= float(bound)
        print(f"{field}: relative L2 error {error:.2e}, at most {bound}")
    sys.exit(f"{scene}: not as exact as it says" if failed else 0)


if __name__ == "__main__":
    main()
