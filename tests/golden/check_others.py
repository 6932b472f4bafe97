#!/usr/bin/env python3
"""Holds hompm against the results of other codes in golden/others, and asks hompm-diff which variant of a scheme they are.

    tests/golden/check_others.py build/release/bin
"""
import json
import math
import pathlib
import shlex
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
OTHERS = ROOT / "golden/others"
FIELDS = ["displacement", "velocity", "stress"]
# Digits of displacement, velocity and stress at least: as measured, the last digit rounded down. What is left of the digits of
# a double is rounding; of the others, see "differences from the authors' code" in docs/method.md.
LEAST = {
    "bspline-mpm-1d/bar-small_64x4_deg1.csv": (13.2, 12.1, 12.3), "bspline-mpm-1d/bar-small_64x4_deg2.csv": (13.3, 12.3, 11.9),
    "bspline-mpm-1d/bar-small_64x4_splines.csv": (7.8, 6.1, 6.2), "bspline-mpm-1d/bar-large_64x4_deg1.csv": (12.0, 11.1, 11.3),
    "bspline-mpm-1d/bar-large_64x4_deg2.csv": (12.9, 12.0, 11.8), "bspline-mpm-1d/bar-large_64x4_splines.csv": (7.8, 5.9, 6.1),
    "bspline-mpm-1d/bar-small_16x4_deg1.csv": (14.2, 14.8, 13.8), "bspline-mpm-1d/bar-small_16x4_deg2.csv": (14.3, 14.8, 13.9),
    "bspline-mpm-1d/bar-small_16x4_splines.csv": (4.7, 5.0, 3.6), "bspline-mpm-1d/column-large_16x4_deg1.csv": (14.8, 14.1, 14.2),
    "bspline-mpm-1d/column-large_16x4_deg2.csv": (4.8, 2.9, 3.0), "bspline-mpm-1d/column-large_16x4_splines.csv": (4.8, 3.4, 3.5),
    "karamelo/bar-small_64x4_usl.csv": (11.3, 11.6, 12.0), "karamelo/bar-small_64x4_musl.csv": (4.3, 3.2, 2.8),
    "classical-python/bar-small_64x4.csv": (14.8, 14.2, 14.2), "bspline-octave/bar-small_64x4.csv": (5.4, 3.2, 4.4),
}
# With the choices of the other code: what hompm-diff is to find, or what is set, and the digits then.
THEIR_WAY = [
    ("karamelo/bar-small_64x4_musl.csv", ["scheme.position_update=before-projection"], 10.9),
    ("bspline-mpm-1d/bar-small_16x4_splines.csv", ["scheme.essential_conditions=after-solution"], 7.4),
]


def call(tool, *arguments):
    done = subprocess.run([tool, *arguments], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        sys.exit(f"{tool.name} {' '.join(map(str, arguments))}: exit code {done.returncode}: {done.stderr.strip()}")
    return done.stdout


def digits(tools, work, name, run, *changes):
    folder = tempfile.mkdtemp(dir=work)
    options = [word for change in changes for word in ("--set", change)]
    call(tools / "hompm-run", *shlex.split(run), *options, "--errors", "none", "--no-vtk", "--quiet", "--output", folder)
    times = sorted({line.split(",")[0] for line in (OTHERS / name).read_text().splitlines()[1:]}, key=float)
    chosen = [word for time in times for word in ("--time", repr(float(time)))]
    report = json.loads(call(tools / "hompm-diff", "--json", *chosen, OTHERS / name, folder))
    assert not report["messages"], report["messages"]
    return [report["digits"].get(field) or math.inf for field in FIELDS]


def main():
    tools = pathlib.Path(sys.argv[1]).resolve()
    runs = {f"{path.parent.name}/{result['file']}": result["run"]
            for path in OTHERS.glob("*/code.json") for result in json.loads(path.read_text())["results"]}
    wrong = [f"{name} is in golden/others or in this script only" for name in sorted(set(runs) ^ set(LEAST))]
    with tempfile.TemporaryDirectory() as work:
        for name, least in LEAST.items():
            found = digits(tools, work, name, runs[name])
            print(name, *(f"{d:.2f}" for d in found))
            if any(d < bound for d, bound in zip(found, least)):
                wrong.append(f"{name}: agrees to {found} digits, not {least}")
        for name, changes, least in THEIR_WAY:
            found = digits(tools, work, name, runs[name], *changes)
            print(name, *changes, *(f"{d:.2f}" for d in found))
            if min(found) < least:
                wrong.append(f"{name} with {changes}: agrees to {found} digits, not {least}")

        # A run of another variant is found, by one change and by two, with the step at which it leaves.
        for changes, step in ([["scheme.sequence=usl"], 2], [["scheme.sequence=usl", "scheme.stress_update=from-stretch"], 2]):
            mine = pathlib.Path(work) / "mine"
            setting = [word for change in ["end_time=0.02", "output.snapshots=20", *changes] for word in ("--set", change)]
            call(tools / "hompm-run", "--case", "bar", "--variant", "small", "--scheme", "classical", "--time-step", "1e-3",
                 *setting, "--no-vtk", "--quiet", "--output", mine)
            scene = pathlib.Path(work) / "plain.toml"
            text = (mine / "scene.toml").read_text()
            for change in changes:
                key, value = change.removeprefix("scheme.").split("=")
                line = next(line for line in text.splitlines() if line.startswith(key + " "))
                text = text.replace(line, {"sequence": 'sequence = "musl"', "stress_update": 'stress_update = "incremental"'}[key])
            scene.write_text(text)
            report = json.loads(call(tools / "hompm-diff", "--which", "--json", mine / "particles.csv", scene))
            best = report["tried"][1]
            print("which:", best["changes"], min(best["digits"].values()), "first difference", report["tried"][0]["first_difference"])
            if best["changes"] != dict(change.split("=") for change in changes) or min(best["digits"].values()) < 17:
                wrong.append(f"--which finds {best}, not {changes}")
            first = report["tried"][0]["first_difference"]
            if not first or first["step"] > step:
                wrong.append(f"--which finds no difference at step {step}: {first}")
        text = call(tools / "hompm-diff", "--which", OTHERS / "classical-python/bar-small_64x4.csv", ROOT / "golden/bar-small-classical")
        if not text.endswith("no variant agrees better than the scene as it is\n"):
            wrong.append(f"--which of a code that agrees to rounding: {text}")
        # Other particles: nothing can be told.
        done = subprocess.run([tools / "hompm-diff", "--which", OTHERS / "bspline-mpm-1d/bar-small_16x4_deg1.csv", ROOT / "golden/bar-small-classical"],
                              capture_output=True, text=True, check=False)
        if done.returncode != 5 or "no particle has the X" not in done.stderr:
            wrong.append(f"--which with other particles: {done.returncode}: {done.stdout}{done.stderr}")
        made = pathlib.Path(work) / "submitted"
        submit = ["--relative", "all=1e-9", "--submit", made, OTHERS / "classical-python/bar-small_64x4.csv", ROOT / "golden/bar-small-classical"]
        call(tools / "hompm-diff", *submit)
        code = json.loads((made / "code.json").read_text())
        if code["code"] != "" or code["results"][0]["run"] != "--scene golden/bar-small-classical/scene.toml --snapshots 2" or \
                (made / "results.csv").read_bytes() != (OTHERS / "classical-python/bar-small_64x4.csv").read_bytes():
            wrong.append(f"--submit makes {code}")
        if subprocess.run([tools / "hompm-diff", *submit], capture_output=True, check=False).returncode != 2:
            wrong.append("--submit takes a folder that is there")
    for complaint in wrong:
        print(complaint, file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
