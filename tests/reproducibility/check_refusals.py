#!/usr/bin/env python3
"""Changes the floating-point environment under a program, and demands that it refuses to compute.

    check_refusals.py HOMPM_RUN

A library that is loaded into the process sets another rounding mode, or flushes subnormal numbers to zero, as one that was
built with -ffast-math does. hompm-run must say what is wrong in one line, end with exit code 6 and leave no file.
Exit code 0: refused; 1: not refused; 77: this machine cannot try it.
"""
import os
import pathlib
import platform
import shutil
import subprocess
import sys
import tempfile

SET_ROUNDING = "#include <fenv.h>\n__attribute__((constructor)) static void set(void) { fesetround(%s); }\n"
FLUSH = "#include <xmmintrin.h>\n__attribute__((constructor)) static void set(void) { _mm_setcsr(_mm_getcsr() | 0x8000); }\n"
ROUNDING_MESSAGE = "the rounding mode is not to nearest"
FLUSH_MESSAGE = "subnormal numbers are flushed to zero here"
CHANGES = [
    ("nothing", "", "", ""),
    ("rounding upward", SET_ROUNDING % "FE_UPWARD", "", ROUNDING_MESSAGE),
    ("rounding downward", SET_ROUNDING % "FE_DOWNWARD", "", ROUNDING_MESSAGE),
    ("rounding toward zero", SET_ROUNDING % "FE_TOWARDZERO", "", ROUNDING_MESSAGE),
    ("flush to zero", FLUSH, "", FLUSH_MESSAGE),
    ("a library linked with -ffast-math", "", "-ffast-math", FLUSH_MESSAGE),
]


def main():
    if len(sys.argv) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    if platform.machine() != "x86_64" or shutil.which("gcc") is None:
        print("skipped: written for gcc on x86_64")
        return 77
    wrong = 0
    for name, text, flag, message in CHANGES:
        with tempfile.TemporaryDirectory() as scratch:
            scratch = pathlib.Path(scratch)
            (scratch / "change.c").write_text(text or "int unused;\n", encoding="utf-8")
            subprocess.run(["gcc", "-shared", "-fPIC", *flag.split(), "change.c", "-o", "change.so", "-lm"], cwd=scratch, check=True)
            command = [sys.argv[1], "--case", "bar", "--variant", "small", "--cells", "4", "--quiet", "--output", scratch / "out"]
            done = subprocess.run(command, env=os.environ | {"LD_PRELOAD": str(scratch / "change.so")}, capture_output=True,
                                  text=True, check=False)
            written = (scratch / "out").exists()
            if message:
                right = done.returncode == 6 and done.stderr.count("\n") == 1 and message in done.stderr and not written
            else:
                right = done.returncode == 0 and written
            wrong += not right
            print(f"{'ok   ' if right else 'WRONG'} {name}: exit code {done.returncode}, "
                  f"{'files' if written else 'no files'}, {done.stderr.strip() or 'no message'}")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
