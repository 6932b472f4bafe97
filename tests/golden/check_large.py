#!/usr/bin/env python3
"""hompm-diff on large files: the verdict is right, memory and time stay within bounds.

    tests/golden/check_large.py build/release/bin ROWS

Two folders with stress.csv of ROWS rows that differ in the last value, and the same as the CSV file of another code, with
rows at many times of which golden has two.
"""
import os
import pathlib
import resource
import subprocess
import sys
import tempfile
import time

PARTICLES = 1000
# What the program itself takes is about 10 MB; the files go past row by row.
MOST_MEGABYTES = 64
# Seconds per million rows and comparison on one core, measured 0.4, with room for a busy machine.
MOST_SECONDS = 10.0


def write(path, rows, last):
    with open(path, "w", encoding="ascii") as file:
        file.write("time,particle,X,x,stress,stretch\n")
        lines = [f",{p},{p}.5,{p}.25,0.1,1.5\n" for p in range(PARTICLES)]
        for step in range(rows // PARTICLES - 1):
            file.write("".join(f"{step}" + line for line in lines))
        final = rows // PARTICLES - 1
        file.write("".join(f"{final}" + line for line in lines[:-1]) + f"{final},{PARTICLES - 1},{PARTICLES - 1}.5,{PARTICLES - 1}.25,{last},1.5\n")
    return final


def measured(command, rows, expected, words):
    start = time.monotonic()
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        out = process.stdout.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    seconds, megabytes = time.monotonic() - start, usage.ru_maxrss / 1024
    print(f"{rows} rows: exit code {process.returncode}, {seconds:.1f} s, {megabytes:.0f} MB")
    wrong = [word for word in words if word not in out]
    if process.returncode != expected or wrong or megabytes > MOST_MEGABYTES or seconds > MOST_SECONDS * rows / 1e6:
        sys.exit(f"{' '.join(map(str, command))}: expected exit code {expected}, {words}, at most {MOST_MEGABYTES} MB\n{out}")


def main():
    tool, rows = pathlib.Path(sys.argv[1]).resolve() / "hompm-diff", int(float(sys.argv[2]))
    with tempfile.TemporaryDirectory() as work:
        a, b, golden = (pathlib.Path(work) / name for name in ("a", "b", "golden"))
        for folder in (a, b, golden):
            folder.mkdir()
        last = write(a / "stress.csv", rows, "0.10000000000000002")
        (a / "again").mkdir()
        os.link(a / "stress.csv", a / "again/stress.csv")
        measured([tool, a, a / "again"], rows, 0, ["identical"])
        write(b / "stress.csv", rows, "0.1")
        measured([tool, a, b], rows, 3, [f"first difference: stress.csv, stress, time {last}, particle {PARTICLES - 1}", "1 ulp"])
        lines = (b / "stress.csv").open(encoding="ascii")
        (golden / "stress.csv").write_text("".join(line for line in lines if line.startswith(("time", "0,", f"{last},"))))
        lines.close()
        measured([tool, a / "stress.csv", golden], rows, 3, ["different", "999"])
        measured([tool, "--ulps", "all=4", a / "stress.csv", golden], rows, 0, ["equivalent"])


if __name__ == "__main__":
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    sys.exit(main())
