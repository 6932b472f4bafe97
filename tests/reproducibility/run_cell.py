#!/usr/bin/env python3
"""Builds one cell of the reproducibility matrix and holds what it computes against the golden data, byte by byte.

    run_cell.py --list
    run_cell.py CELL [--all-folders] [--build-dir DIR] [--headers DIR ...] [--golden FOLDER ...]

The library is built for the cell below DIR (default build/reproducibility) and runs the scene of every golden folder; all
files it writes must be those of the folder. A cell that runs slowly runs small scenes instead (small_scenes.py), with the whole library,
and is held against what the same scenes give natively; with --all-folders it runs the golden folders, too. The library of the cell is
also disassembled: see check_binary.py.
Exit code 0: equal; 1: not equal, or not built; 77: this machine cannot run the cell, with the reason.
"""
import argparse
import contextlib
import fcntl
import hashlib
import os
import pathlib
import resource
import shutil
import subprocess
import sys
import time

import check_binary
import small_scenes
from cells import CELLS, NATIVE

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
SKIPPED = 77
# Where the functions of libm come in several versions, these arguments make some of them differ in the last bit.
LIBM_PROBE = """
import hashlib, math
values = ((math.exp(x / 9), math.sin(x), math.log(x), math.pow(x, 1.7)) for x in (0.001 * i + 0.37 for i in range(20000)))
print(hashlib.sha256(repr(list(values)).encode()).hexdigest())
"""


def why_not(cell):
    """The reason why this machine cannot run the cell; empty when it can."""
    for tool in [cell.compiler, "cmake", "ninja", *cell.emulator[:1]]:
        if shutil.which(tool) is None:
            return f"there is no {tool}"
    if cell.cpu_flag and cell.cpu_flag not in pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").split():
        return f"the processor has no {cell.cpu_flag}"
    if cell.environment:
        digests = [subprocess.run([sys.executable, "-c", LIBM_PROBE], env=environment, capture_output=True, check=True).stdout
                   for environment in (os.environ, os.environ | dict(cell.environment))]
        if digests[0] == digests[1]:
            name, value = cell.environment[0]
            return f"{name}={value} changes nothing in this C library"
    return ""


def build(cell, folder, headers, unity=True):
    """Builds golden_runner; most of the library is one translation unit, or each file one."""
    configure = ["cmake", "-S", HERE / "cell", "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None",
                 f"-DCMAKE_CXX_FLAGS={cell.flags}", f"-DHOMPM_LAST_FLAGS={cell.last_flags}", f"-DHOMPM_LEAVE_OUT_EFFECTS={cell.leave_out}",
                 f"-DHOMPM_UNITY={'ON' if unity else 'OFF'}", f"-DHOMPM_WHOLE={'ON' if cell.whole else 'OFF'}",
                 f"-DCMAKE_INTERPROCEDURAL_OPTIMIZATION={'ON' if cell.lto else 'OFF'}"]
    if headers:
        configure.append("-DHOMPM_HEADERS=" + ";".join(headers))
    if cell.toolchain:
        configure.append(f"-DCMAKE_TOOLCHAIN_FILE={HERE / 'cell' / cell.toolchain}")
    else:
        configure.append(f"-DCMAKE_CXX_COMPILER={cell.compiler}")
    # ctest runs as many cells at a time as there are processors to use.
    for command in (configure, ["ninja", "-C", folder, "-j", "1", "golden_runner"]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"the build failed:\n{done.stdout[-4000:]}{done.stderr[-4000:]}")


@contextlib.contextmanager
def alone(folder):
    """Cells that share a build wait for each other."""
    folder.mkdir(parents=True, exist_ok=True)
    with open(folder / "lock", "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


def difference(mine, theirs):
    """Where two files differ, in a line."""
    a, b = mine.read_bytes().split(b"\n"), theirs.read_bytes().split(b"\n")
    differing = [i for i, (x, y) in enumerate(zip(a, b), start=1) if x != y]
    if not differing:
        return f"{len(a)} lines instead of {len(b)}"
    i = differing[0]
    return f"{len(differing)} lines differ, first line {i}:\n  here   {a[i - 1].decode()}\n  golden {b[i - 1].decode()}"


def differences(output, folders):
    """What differs below `output` from the files of `folders` but the provenance; the number and size of these."""
    found, count, size = [], 0, 0
    for golden in folders:
        for theirs in sorted(path for path in golden.rglob("*") if path.is_file() and path.name != "provenance.json"):
            mine = output / golden.name / theirs.relative_to(golden)
            count, size = count + 1, size + theirs.stat().st_size
            if not mine.exists():
                found.append(f"{golden.name}/{theirs.name} is missing")
            elif mine.read_bytes() != theirs.read_bytes():
                found.append(f"{golden.name}/{theirs.name}: {difference(mine, theirs)}")
    return found, count, size


def execute(cell, folder, output, inputs):
    shutil.rmtree(output, ignore_errors=True)
    command = [*cell.emulator, folder / "golden_runner", output, *inputs]
    return subprocess.run(command, env=os.environ | dict(cell.environment), capture_output=True, text=True, check=False)


def native_results(build_dir, headers):
    """(small scenes, folders with what they give natively): made once for a build of the library."""
    folder, output = build_dir / NATIVE.build, build_dir / "small"
    with alone(folder):
        build(NATIVE, folder, headers)
        scenes = build_dir / "small-scenes"
        made = hashlib.sha256((folder / "golden_runner").read_bytes() + (HERE / "small_scenes.py").read_bytes()).hexdigest()
        stamp = build_dir / "small.sha256"
        if not stamp.exists() or stamp.read_text(encoding="utf-8") != made:
            words = {}
            for line in subprocess.run([folder / "golden_runner", "--words"], capture_output=True, text=True, check=True).stdout.splitlines():
                key, word = line.split()
                words.setdefault(key, []).append(word)
            shutil.rmtree(scenes, ignore_errors=True)
            scenes.mkdir()
            for name, text in small_scenes.scenes(words).items():
                (scenes / f"{name}.toml").write_text(text, encoding="utf-8")
            done = execute(NATIVE, folder, output, sorted(scenes.iterdir()))
            complaints = [done.stderr] if done.returncode != 0 else small_scenes.missed(words, output)
            if complaints:
                sys.exit("\n".join(complaints))
            stamp.write_text(made, encoding="utf-8")
    return sorted(scenes.iterdir()), sorted(output.iterdir())


def used_seconds():
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def run_cell(name, build_dir, headers, folders, all_folders):
    cell = CELLS[name]
    reason = why_not(cell)
    if reason:
        print(f"skipped: {reason}")
        return SKIPPED
    inputs, expected = (folders, folders) if not cell.whole or all_folders else ([], [])
    if cell.whole:
        small, native = native_results(build_dir, headers)
        inputs, expected = [*small, *inputs], [*native, *expected]
    folder = build_dir / cell.build
    before = used_seconds()
    with alone(folder):
        build(cell, folder, headers)
    seconds_to_build = used_seconds() - before

    output = build_dir / "results" / hashlib.sha256(name.encode()).hexdigest()[:12]
    done = execute(cell, folder, output, inputs)
    if cell.refused_with:
        if done.returncode != 1 or cell.refused_with not in done.stderr or list(output.glob("*")):
            sys.exit(f"not refused with \"{cell.refused_with}\": exit code {done.returncode}, {done.stderr}")
        print(f"refused as it must be: {done.stderr.strip()}")
        return 0
    if done.returncode != 0:
        sys.exit(f"golden_runner ended with {done.returncode}:\n{done.stderr}")
    found, count, size = differences(output, expected)
    if found:
        sys.exit("\n".join(found))
    seconds_to_run = used_seconds() - before - seconds_to_build
    # The objects of a build with LTO hold no machine code yet.
    binary = folder / ("golden_runner" if cell.lto else "lib/libhompm.a")
    complaints = check_binary.complaints_about(binary)
    if complaints:
        sys.exit("\n".join(complaints))
    to_what = "what the same scenes give natively" if cell.whole else "the golden data"
    print(f"{len(expected)} runs, {count} files, {size} bytes: identical to {to_what}; "
          f"{seconds_to_build:.0f} s to build, {seconds_to_run:.0f} s to run")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cell", nargs="?", choices=CELLS)
    parser.add_argument("--list", action="store_true", help="print the cells, each behind its seconds of processor time")
    parser.add_argument("--build-dir", type=pathlib.Path, default=ROOT / "build" / "reproducibility")
    parser.add_argument("--headers", nargs="*", default=[], help="folders with boost, toml++ and nlohmann")
    parser.add_argument("--golden", nargs="*", type=pathlib.Path, help="golden folders instead of all")
    parser.add_argument("--all-folders", action="store_true", help="the golden folders, too, where small scenes are run")
    given = parser.parse_args()
    if given.list:
        print("\n".join(f"{cell.seconds:5} {name}" for name, cell in CELLS.items()))
        return 0
    if given.cell is None:
        parser.error("name a CELL, or --list")
    folders = given.golden or sorted(path.parent for path in ROOT.glob("golden/*/provenance.json"))
    return run_cell(given.cell, given.build_dir.resolve(), given.headers, folders, given.all_folders)


if __name__ == "__main__":
    sys.exit(main())
