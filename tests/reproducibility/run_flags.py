#!/usr/bin/env python3
"""Compiles with random flags that touch arithmetic and optimisation: the bits are those of a plain build, or refused.

    run_flags.py [--count N] [--seed S]           what must be refused, with its cause; then N small kernels (default 200), half
                                                  of them by g++, half by clang++
    run_flags.py --library N [--golden FOLDER...] the library with N sets of flags that the kernel's check lets through
    run_flags.py --try "g++ -O2 -mfpmath=both"    the kernel with these flags: what comes of it
    run_flags.py --bisect "g++ -O2 -mfpmath=both" [--golden FOLDER...]
                                                  the sources of the library that change bits with these flags

The check of the arithmetic is in each program. A third outcome, other bits, is narrowed down to sources: objects are built with
and without the flags (the check always without) and linked in mixtures. Exit code 0: golden or refused, each of them.
"""
import argparse
import concurrent.futures
import os
import pathlib
import random
import subprocess
import sys
import tempfile

import run_cell
from cells import REFUSED_BUILDS, Cell

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LIBRARY = ROOT / "lib"
SMALL = ["bar-small-bspline", "column-settled-high-order"]
CHECK = next(LIBRARY.rglob("floating_point.cpp"))
KERNEL = [CHECK, next(LIBRARY.rglob("cubic_spline.cpp")), HERE / "flags" / "kernel.cpp"]
REFUSED = 6

LEVELS = ["-O0", "-O1", "-O2", "-O2", "-O3", "-O3", "-Os", "-Ofast"]
BOTH = ["-freciprocal-math", "-fassociative-math", "-fno-signed-zeros", "-fno-trapping-math", "-ffinite-math-only",
        "-funsafe-math-optimizations", "-ffast-math", "-frounding-math", "-fno-math-errno", "-ffp-contract=fast", "-ffp-contract=on",
        "-ffp-contract=off", "-march=native", "-mfma", "-mavx2", "-mrecip", "-funroll-loops", "-fno-inline", "-fno-builtin", "-flto",
        "-fwrapv", "-ftrapping-math", "-fmerge-all-constants", "-mlong-double-64", "-fomit-frame-pointer", "-fno-strict-aliasing"]
POOLS = {
    "g++": BOTH + ["-fsingle-precision-constant", "-mfpmath=both", "-mfpmath=387", "-mfpmath=sse", "-ffloat-store", "-fsignaling-nans",
                   "-fcx-limited-range", "-fno-fp-int-builtin-inexact", "-fexcess-precision=fast", "-mpc32", "-mpc64", "-ftree-vectorize",
                   "-fno-tree-vectorize", "-fvect-cost-model=unlimited", "-fvariable-expansion-in-unroller", "-fsplit-loops",
                   "-ftree-loop-distribution", "-floop-nest-optimize", "-fipa-pta", "-fgcse-las", "-fmodulo-sched",
                   "-fselective-scheduling2", "-mprefer-vector-width=128", "-fno-ivopts", "-ftree-parallelize-loops=2", "-fwhole-program"],
    "clang++": BOTH + ["-fno-honor-nans", "-fno-honor-infinities", "-fapprox-func", "-ffp-model=fast", "-ffp-model=strict",
                       "-ffp-model=precise", "-fdenormal-fp-math=preserve-sign", "-fdenormal-fp-math=positive-zero", "-mrecip=all",
                       "-ffp-exception-behavior=strict", "-ffp-exception-behavior=maytrap", "-fprotect-parens", "-fno-vectorize",
                       "-fno-slp-vectorize", "-fvectorize", "-mprefer-vector-width=128", "-fstrict-vtable-pointers", "-fno-unroll-loops"],
}
PLAIN = {compiler: f"{compiler} -O0 -ffp-contract=off" for compiler in POOLS}


def drawn(count, seed):
    """Commands: a compiler, a level, some flags."""
    dice = random.Random(seed)
    processor = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").split()
    without = {"-m" + name for name in ("fma", "avx2") if name not in processor}
    for number in range(count):
        compiler = list(POOLS)[number % len(POOLS)]
        flags = dice.sample(POOLS[compiler], dice.choice((1, 1, 2, 3, 4, 6, 8)))
        # Before them, as in the library, whose flag for contraction comes last; here it can be overruled.
        yield " ".join([compiler, dice.choice(LEVELS), "-ffp-contract=off"] + [flag for flag in flags if flag not in without])


def called(command, **options):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, errors="replace", check=False, **options)


def compiled(command, sources, program):
    done = called([*command.split(), "-std=c++20", "-w", f"-I{HERE / 'flags'}", f"-I{LIBRARY}", *sources, "-o", program])
    return done.stderr.strip() if done.returncode != 0 else ""


def kernel(command):
    """The outcome: bits, or the reason of a refusal, or what the compiler says."""
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        (scratch / "all.cpp").write_text("".join(f'#include "{path}"\n' for path in KERNEL), encoding="utf-8")
        complaint = compiled(command, [scratch / "all.cpp"], scratch / "kernel")
        if complaint:
            return "not built", complaint
        done = called([scratch / "kernel"])
        return {0: "bits", REFUSED: "refused"}.get(done.returncode, f"exit code {done.returncode}"), done.stdout


def verdict(command, golden):
    outcome, text = kernel(command)
    return ("golden" if text == golden else "OTHER BITS", text) if outcome == "bits" else (outcome, text)


def golden_bits():
    found = {PLAIN[compiler]: kernel(PLAIN[compiler]) for compiler in POOLS}
    if {outcome for outcome, _ in found.values()} != {"bits"} or len({text for _, text in found.values()}) != 1:
        sys.exit("plain builds do not agree:\n" + "\n".join(f"{command}: {outcome} {text}" for command, (outcome, text) in found.items()))
    return next(iter(found.values()))[1]


def blamed(sources, differs):
    """The sources that make a difference by themselves; those that do so only together, as they are."""
    if not differs(sources):
        return []
    if len(sources) == 1:
        return sources
    half = len(sources) // 2
    return blamed(sources[:half], differs) + blamed(sources[half:], differs) or sources


def bisect_kernel(command, golden):
    """Objects of the kernel's sources with and without the flags, in mixtures."""
    plain = PLAIN[command.split()[0]]
    with tempfile.TemporaryDirectory() as scratch:
        scratch = pathlib.Path(scratch)
        objects = {}
        for path in KERNEL:
            for way, flags in (("plain", plain), ("changed", command.replace(" -flto", ""))):
                objects[path, way] = scratch / f"{path.stem}-{way}.o"
                compiled(flags + " -c", [path], objects[path, way])

        def differs(sources):
            mixture = [objects[path, "changed" if path in sources else "plain"] for path in KERNEL]
            if compiled(command.replace(" -flto", ""), mixture, scratch / "mixture"):
                return False
            return called([scratch / "mixture"]).stdout != golden
        return [str(path.relative_to(ROOT)) for path in blamed([path for path in KERNEL if path != CHECK], differs)]


def library_built(command, folder, headers, whole=True):
    """golden_runner by this command, in one translation unit or many."""
    compiler, *flags = command.split()
    run_cell.build(Cell(folder.name, compiler, " ".join(flags)), folder, headers, unity=whole)
    return folder / "golden_runner"


def library_outcome(program, folders):
    """Golden, refused, or where the first difference is."""
    with tempfile.TemporaryDirectory() as output:
        output = pathlib.Path(output)
        done = called([program, output, *folders])
        if done.returncode != 0:
            return ("refused" if list(output.glob("*")) == [] else f"exit code {done.returncode}"), done.stderr.strip()
        found = run_cell.differences(output, folders)[0]
        return ("OTHER BITS", found[0]) if found else ("golden", "")


def bisect_library(command, build_dir, headers, folders):
    compiler = command.split()[0]
    command = " ".join(word for word in command.split() if word != "-flto")
    builds = {}
    for way, flags in (("plain", f"{compiler} -O1"), ("changed", command)):
        builds[way] = build_dir / "bisect" / f"{compiler}-{way}"
        with run_cell.alone(builds[way]):
            library_built(flags, builds[way], headers, whole=False)
    inside = pathlib.Path("lib/CMakeFiles/hompm.dir")
    objects = sorted(path.relative_to(builds["plain"]) for path in (builds["plain"] / inside).rglob("*.o"))
    runner = builds["plain"] / "CMakeFiles/golden_runner.dir/golden_runner.cpp.o"

    def differs(changed):
        mixture = [builds["changed" if path in changed else "plain"] / path for path in objects]
        with tempfile.TemporaryDirectory() as scratch:
            program = pathlib.Path(scratch) / "mixture"
            done = called([compiler, *(flag for flag in command.split()[1:] if flag.startswith("-m")), runner, *mixture, "-o", program])
            if done.returncode != 0:
                sys.exit(done.stderr[-2000:])
            return library_outcome(program, folders)[0] != "golden"
    found = blamed([path for path in objects if not path.name.startswith(CHECK.name)], differs)
    return [str(path.relative_to(inside)).removesuffix(".o") for path in found]


def test_kernels(given):
    golden = golden_bits()
    commands = list(drawn(given.count, given.seed))
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        found = list(pool.map(lambda command: verdict(command, golden), commands))
    wrong = 0
    for _, message, builds in REFUSED_BUILDS:
        for command in builds:
            outcome, text = verdict(" ".join([*command.split()[:2], "-ffp-contract=off", *command.split()[2:]]), golden)
            if outcome != "refused" or message not in text:
                wrong += 1
                print(f"{command}: not refused with \"{message}\": {outcome} {text[:300]}")
    reasons = {}
    for command, (outcome, text) in zip(commands, found):
        if outcome == "refused":
            reasons[text.strip()] = reasons.get(text.strip(), 0) + 1
        elif outcome != "golden":
            wrong += 1
            print(f"{outcome}: {command}\n  {text[:600]}")
            if outcome == "OTHER BITS":
                print("  by itself changes bits: " + (", ".join(bisect_kernel(command, golden)) or "no single source"))
    kept = sum(outcome == "golden" for outcome, _ in found)
    print("".join(f"{number:5} refused: {reason}\n" for reason, number in sorted(reasons.items(), key=lambda item: -item[1])) +
          f"{kept:5} golden\n{wrong:5} neither, of {len(commands)}")
    return wrong


def test_library(given):
    golden = golden_bits()
    wrong = number = 0
    for command in drawn(10000, given.seed + 1):
        if number == given.library:
            break
        if verdict(command, golden)[0] != "golden":
            continue
        number += 1
        folder = given.build_dir / "flags" / command.split()[0]  # configured anew for each set of flags
        with run_cell.alone(folder):
            outcome, text = library_outcome(library_built(command, folder, given.headers), given.golden)
        print(f"{outcome}: {command} {text}", flush=True)
        if outcome == "OTHER BITS":
            print("  changes bits: " + ", ".join(bisect_library(command, given.build_dir, given.headers, given.golden)))
        wrong += outcome != "golden"
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=200)
    parser.add_argument("--seed", type=int, default=14)
    parser.add_argument("--library", type=int, default=0, metavar="N")
    parser.add_argument("--try", dest="attempt", metavar="COMMAND")
    parser.add_argument("--bisect", metavar="COMMAND")
    parser.add_argument("--jobs", type=int, default=len(os.sched_getaffinity(0)))
    parser.add_argument("--build-dir", type=pathlib.Path, default=ROOT / "build" / "reproducibility")
    parser.add_argument("--headers", nargs="*", default=[], help="folders with boost, toml++ and nlohmann")
    parser.add_argument("--golden", nargs="*", type=pathlib.Path, default=[ROOT / "golden" / name for name in SMALL])
    given = parser.parse_args()
    given.build_dir = given.build_dir.resolve()
    compilers = [given.bisect.split()[0]] if given.bisect else POOLS
    for compiler in compilers:
        if called(["which", compiler]).returncode != 0:
            print(f"skipped: there is no {compiler}")
            return run_cell.SKIPPED
    if given.attempt:
        outcome, text = verdict(given.attempt, golden_bits())
        print(f"{outcome}: {given.attempt}\n{text if outcome != 'golden' else ''}")
        return 0 if outcome in ("golden", "refused") else 1
    if given.bisect:
        found = bisect_library(given.bisect, given.build_dir, given.headers, given.golden)
        print("\n".join(found) or "no source of the library changes a bit of these runs")
        return 0
    return 1 if (test_library(given) if given.library else test_kernels(given)) else 0


if __name__ == "__main__":
    sys.exit(main())
