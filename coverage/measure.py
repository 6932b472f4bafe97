#!/usr/bin/env python3
"""Reads what llvm-cov measured and demands the thresholds.

    measure.py PROFILE BINARY ... [--missed FILE]

Lines, functions and branch outcomes of lib/: LEAST percent each. A comment on a line excludes it with a reason:
LCOV_EXCL_LINE: REASON; many lines between LCOV_EXCL_START: REASON and LCOV_EXCL_STOP. A place in the source counts once, reached by any instantiation.
Exit code 0: above the thresholds; 1: below, or an exclusion without a reason or of a line that is reached.
"""
import argparse
import collections
import json
import pathlib
import re
import shutil
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LEAST = (100.0, 100.0, 93.0)  # percent of lines, functions, branch outcomes
EXCLUSION = re.compile(r"LCOV_EXCL_(LINE|START|STOP)(?::\s*(\S.*))?")


def llvm_cov(*arguments):
    tool = shutil.which("llvm-cov") or shutil.which("llvm-cov-14")
    return subprocess.run([tool, *arguments], capture_output=True, text=True, check=True).stdout


def lib_path(name):
    """Path below the root, or nothing for a file outside lib/hompm."""
    path = pathlib.Path(name).resolve()
    return str(path.relative_to(ROOT)) if path.is_relative_to(ROOT / "lib" / "hompm") else ""


def read_lines_and_functions(text):
    lines, functions, places = collections.Counter(), collections.Counter(), {}
    file = ""
    for row in text.splitlines():
        kind, _, rest = row.partition(":")
        if kind == "SF":
            file, places = lib_path(rest), {}
        elif not file:
            continue
        elif kind == "DA":
            line, count = map(int, rest.split(",")[:2])
            lines[file, line] += count
        elif kind == "FN":
            line, name = rest.split(",", 1)
            places[name] = int(line)
            functions[file, int(line)] += 0
        elif kind == "FNDA":
            count, name = rest.split(",", 1)
            functions[file, places[name]] += int(count)
    return lines, functions


def read_branches(text):
    """Count of each outcome, by file, line, column and outcome."""
    branches = collections.Counter()
    for file in json.loads(text)["data"][0]["files"]:
        name = lib_path(file["filename"])
        for line, column, _, _, true_count, false_count, *_ in file["branches"] if name else ():
            branches[name, line, column, "true"] += true_count
            branches[name, line, column, "false"] += false_count
    return branches


def exclusions():
    """Reason ("" where none is given) by file and line."""
    found = {}
    for path in (ROOT / "lib").rglob("*.[ch]pp"):
        open_reason = None
        for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
            match = EXCLUSION.search(line)
            kind, reason = (match[1], match[2] or "") if match else ("", "")
            if kind in ("START", "STOP"):
                open_reason = reason if kind == "START" else None
            if kind == "LINE" or open_reason is not None:
                found[str(path.relative_to(ROOT)), number] = reason if kind == "LINE" else open_reason
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("profile")
    parser.add_argument("binaries", nargs="+")
    parser.add_argument("--missed", type=pathlib.Path, required=True, help="write here what is not reached")
    given = parser.parse_args()
    objects = [given.binaries[0]] + [part for binary in given.binaries[1:] for part in ("-object", binary)]
    common = [*objects, "-instr-profile", given.profile]
    lines, functions = read_lines_and_functions(llvm_cov("export", "-format=lcov", *common))
    branches = read_branches(llvm_cov("export", "-format=text", "-skip-functions", *common))
    excluded = exclusions()
    complaints, missed = [], []
    for (file, line), reason in sorted(excluded.items()):
        if not reason:
            complaints.append(f"{file}:{line}: excluded without a reason")
        elif lines[file, line] > 0:
            complaints.append(f"{file}:{line}: excluded, but a test reaches it")
    unreached = [[place for place, count in sorted(counts.items()) if count == 0 and place[:2] not in excluded]
                 for counts in (lines, functions, branches)]
    missed += [f"line {file}:{line}" for file, line in unreached[0]]
    missed += [f"function {file}:{line}" for file, line in unreached[1]]
    missed += [f"branch {file}:{line}:{column} never {outcome}" for file, line, column, outcome in unreached[2]]
    given.missed.write_text("".join(entry + "\n" for entry in missed), encoding="utf-8")
    if not lines or not functions or not branches:
        complaints.append("llvm-cov found nothing")
    shares = []
    for name, counts, zero, least in zip(("lines", "functions", "branch outcomes"), (lines, functions, branches), unreached,
                                         LEAST):
        share = 100.0 * (1.0 - len(zero) / max(1, len(counts)))
        shares.append(f"{share:.1f} % of {len(counts)} {name}")
        if share < least:
            complaints.append(f"{share:.2f} % of the {name} are reached, the threshold is {least:g} %; see {given.missed}")
    print(f"coverage of lib/: {', '.join(shares)}; {len(excluded)} lines excluded with a reason")
    print("".join(f"coverage: {complaint}\n" for complaint in complaints), end="")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
