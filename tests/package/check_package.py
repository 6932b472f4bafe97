#!/usr/bin/env python3
"""Installs the library, builds an effect outside of it against the package, and runs it from a scene.

    tests/package/check_package.py BUILD_DIR CXX
"""
import math
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent


def run(*command, code=0):
    done = subprocess.run(list(map(str, command)), capture_output=True, text=True, check=False)
    if done.returncode != code:
        sys.exit(f"{' '.join(map(str, command))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def main():
    build_dir, compiler = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    with tempfile.TemporaryDirectory() as folder:
        work = pathlib.Path(folder)
        run("cmake", "--install", build_dir, "--prefix", work / "prefix")
        run("cmake", "-G", "Ninja", "-S", HERE, "-B", work / "build", f"-DCMAKE_PREFIX_PATH={work / 'prefix'}", f"-DCMAKE_CXX_COMPILER={compiler}",
            "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Werror")
        run("cmake", "--build", work / "build")
        velocity, residual = map(float, run(work / "build/drag", HERE / "falling.toml").split())
        exact = -0.1 * math.tanh(10.0 * 0.01 / 0.1)
        print(f"velocity {velocity} m/s, exact {exact:.6f}; energy residual {residual}")
        # First order: 1000 steps.
        if not (abs(velocity / exact - 1.0) < 2e-3 and residual < 1e-2 * 500.0 * exact**2):
            sys.exit("the effect outside the library does not do what it should")

        # Its field is written, traced, and in the checkpoint, from which the run goes on to the same bytes.
        for folder, rest in (("whole", []), ("resumed", [work / "whole/half"])):
            (work / folder).mkdir()
            run(work / "build/drag", HERE / "falling.toml", work / folder, *rest)
        names = ("particles.csv", "stress.csv", "history.csv")
        if any((work / "whole" / name).read_bytes() != (work / "resumed" / name).read_bytes() for name in names):
            sys.exit("the effect outside the library does not resume to the bit")
        header, *rows = (work / "whole/particles.csv").read_text(encoding="utf-8").splitlines()
        heats = [float(row.split(",")[-1]) for row in rows]
        if not header.endswith(",density,drag_heat") or not 0.0 == heats[0] < heats[-1]:
            sys.exit(f"the field of the effect is not reported: {header}")
        if 'Name="drag_heat"' not in (work / "whole/vtk/snapshot_0001.vtu").read_text(encoding="utf-8"):
            sys.exit("the field of the effect is in no .vtu")
        run(work / "prefix/bin/hompm-diff", work / "whole", work / "resumed")
        traced = run(work / "prefix/bin/hompm-diff", "--trace", work / "whole/trace", work / "resumed/trace")
        if b"particles.drag_heat" not in (work / "whole/trace").read_bytes():
            sys.exit(f"the field of the effect is not traced: {traced}")

        misspelt = work / "misspelt.toml"
        misspelt.write_text((HERE / "falling.toml").read_text(encoding="utf-8").replace('"drag"', '"drg"'), encoding="utf-8")
        if 'did you mean "drag"?' not in run(work / "build/drag", misspelt, code=1):
            sys.exit("a misspelt effect outside the library gets no hint")
        # The tools know what the library brings, and nothing else.
        refused = run(work / "prefix/bin/hompm-run", "--scene", HERE / "falling.toml", "--output", work / "out", code=2)
        if '"drag"' not in refused:
            sys.exit(f"hompm-run says about an effect it does not know: {refused}")
        # So does Python, where the module was built.
        for module in (work / "prefix").rglob("hompm*.so"):
            if module.parent.name == "dist-packages":
                run("env", f"PYTHONPATH={module.parent}", "/usr/bin/python3", "-c", "import hompm; hompm.run(case='bar', end_time=0.01)")
        scenes = sorted((work / "prefix/share/hompm/scenes").glob("*.toml"))
        if not scenes:
            sys.exit("the example scenes are not installed")
        run(work / "prefix/bin/hompm-run", "--scene", scenes[0], "--no-vtk", "--quiet", "--output", work / "example")


if __name__ == "__main__":
    main()
