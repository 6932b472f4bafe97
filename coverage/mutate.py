#!/usr/bin/env python3
"""Breaks the library in small ways, one at a time, and counts how often the unit tests notice.

    coverage/mutate.py [--count N] [--room ROOM ...] [--seconds S] [--again]     runs mutants, writes the table
    coverage/mutate.py --list                                                    prints the mutants that would run
    coverage/mutate.py --show ID                                                 prints one mutant as a difference
    coverage/mutate.py --check                                                   checks the table, runs nothing

The mutants are drawn by a fixed seed and named by what they change, so the same code gives the same sample. Results are kept
in coverage/mutation.json; what is there is not run again without --again. Reasons for survivors stand in
coverage/survivors.toml. Works on a copy of the tree in build/mutation. Exit code 1: a survivor without a reason, or a kill
rate below the threshold.
"""
import argparse
import collections
import dataclasses
import hashlib
import json
import pathlib
import re
import shutil
import subprocess
import sys
import time
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutation"
TREE, BUILD = WORK / "tree", WORK / "build"
RESULTS, REASONS, TABLE = (ROOT / "coverage" / name for name in ("mutation.json", "survivors.toml", "mutation.md"))
SEED = "hompm 1"
COUNT = 150
LEAST_KILLED = 90.0
ROOMS = ["numerics", "materials", "plan", "effects", "scheme", "simulation", "scene_file", "output", "verify"]
FEW = 12  # a header that more translation units include takes too long to compile
DONE = ("killed", "survived")

# Formatted code has blanks around binary operators, and none in template brackets.
SWAPS = {
    "arithmetic": {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " -= ": " += ", " *= ": " /= ",
                   " /= ": " *= "},
    "comparison": {" < ": " <= ", " <= ": " < ", " > ": " >= ", " >= ": " > ", " == ": " != ", " != ": " == ", " && ": " || ",
                   " || ": " && "},
    "sign": {"(-": "(", " = -": " = ", "return -": "return ", ", -": ", ", " * -": " * "},
}
NUMBER = re.compile(r"(?<![\w.'\"])(\d+\.\d+(?:[eE][-+]?\d+)?|\d+[eE][-+]?\d+|\d+)(?![\w.'\"])")
INDEX = re.compile(r"(?<=[\w)\]])\[([^\[\]]+)\]")


@dataclasses.dataclass(frozen=True)
class Mutant:
    path: str  # below the root
    line: int  # from 1
    start: int
    end: int
    kind: str
    text: str  # what stands there instead
    before: str  # the whole line

    @property
    def after(self):
        return self.before[:self.start] + self.text + self.before[self.end:]

    @property
    def identity(self):
        return digest(self.path + self.before.strip() + "\n" + self.after.strip())[:8]

    @property
    def room(self):
        return self.path.split("/")[2]


def digest(text):
    return hashlib.sha256(text.encode()).hexdigest()


def without_strings_and_comments(line):
    """The line with the same columns, and blanks for what is not code."""
    blank = lambda match: "\0" * len(match[0])
    return re.sub(r"//.*", blank, re.sub(r'"(?:[^"\\]|\\.)*"|\'(?:[^\'\\]|\\.)*\'', blank, line))


def changed_number(text):
    if text.isdigit():
        return str(int(text) + 1)
    return "1.0" if float(text) == 0.0 else repr(2.0 * float(text))


def mutants_of_line(path, number, line):
    code = without_strings_and_comments(line)
    if re.match(r"\s*(#|using |namespace |template|static_assert|static constexpr bool|throw |\[\[)", code):
        return
    for kind, swaps in SWAPS.items():
        for old, new in swaps.items():
            for match in re.finditer(re.escape(old), code):
                if kind == "arithmetic" and "\0" in code:
                    continue  # strings are joined, too
                if old in (" * ", " - ") and re.match(r"\s*(const )?\w+ \* \w+( =|;|,|\))", code):
                    continue  # a pointer
                if kind == "sign" and code[match.end():match.end() + 1] in ("-", ">", "="):
                    continue
                yield Mutant(path, number, match.start(), match.end(), kind, new, line)
    for match in NUMBER.finditer(code):
        yield Mutant(path, number, match.start(), match.end(), "constant", changed_number(match[0]), line)
    for match in INDEX.finditer(code):
        for step in (" + 1", " - 1"):
            yield Mutant(path, number, match.end() - 1, match.end() - 1, "index", step, line)


def all_mutants(rooms):
    """Of every line of the rooms, in the order that the seed draws them."""
    found = {}
    for path in sorted((ROOT / "lib" / "hompm").rglob("*.[ch]pp")):
        name = str(path.relative_to(ROOT))
        if name.split("/")[2] in rooms:
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), start=1):
                for mutant in mutants_of_line(name, number, line):
                    found.setdefault(mutant.identity, mutant)
    return sorted(found.values(), key=lambda mutant: digest(SEED + mutant.identity))


def run(*command, timeout=None):
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=timeout)


def prepare():
    """Copies the tree, builds the unit tests, and returns how many translation units read each file, and the seconds of a run."""
    files = run("git", "-C", str(ROOT), "ls-files", "--cached", "--others", "--exclude-standard").stdout.splitlines()
    for name in files:
        source, target = ROOT / name, TREE / name
        if source.is_file() and (not target.exists() or source.read_bytes() != target.read_bytes()):
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
            shutil.copymode(source, target)
    configured = run("cmake", "-S", str(TREE), "-B", str(BUILD), "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-O1")
    built = run("ninja", "-C", str(BUILD), "test_unit") if configured.returncode == 0 else configured
    if built.returncode != 0:
        sys.exit(f"mutate: the code as it is does not build:\n{built.stdout[-3000:]}{built.stderr[-3000:]}")
    start = time.monotonic()
    tested = tests(600)
    if tested != "survived":
        sys.exit("mutate: the unit tests fail on the code as it is")
    readers = collections.Counter()
    for row in run("ninja", "-C", str(BUILD), "-t", "deps").stdout.splitlines():
        if str(TREE) in row or "/lib/hompm/" in row:
            readers["lib/hompm/" + row.strip().split("/lib/hompm/")[-1]] += 1
    return readers, time.monotonic() - start


def tests(timeout):
    """The unit tests, the cheapest first, until one fails."""
    program = str(BUILD / "tests" / "test_unit")
    try:
        done = run(program, "--abort", timeout=timeout)
    except subprocess.TimeoutExpired:
        return "killed"  # it hangs
    return "killed" if done.returncode != 0 else "survived"


def verdict(mutant, timeout):
    target = TREE / mutant.path
    original = target.read_text(encoding="utf-8")
    lines = original.split("\n")
    lines[mutant.line - 1] = mutant.after
    try:
        target.write_text("\n".join(lines), encoding="utf-8")
        if run("ninja", "-C", str(BUILD), "test_unit").returncode != 0:
            return "not compiled"  # the compiler noticed; does not count
        return tests(timeout)
    finally:
        target.write_text(original, encoding="utf-8")


def stored(path, empty):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else empty


def reasons():
    return tomllib.loads(REASONS.read_text(encoding="utf-8")) if REASONS.exists() else {}


def summary(results):
    counted = [entry for entry in results.values() if entry["verdict"] in DONE]
    killed = sum(entry["verdict"] == "killed" for entry in counted)
    return len(counted), killed, 100.0 * killed / max(1, len(counted))


def share_table(title, results, key):
    rows = [f"| {title} | mutants | killed |", "| --- | --- | --- |"]
    for name in sorted({entry[key] for entry in results.values()}):
        count, killed, share = summary({i: entry for i, entry in results.items() if entry[key] == name})
        if count:
            rows.append(f"| {name} | {count} | {killed}, {share:.0f} % |")
    return rows


def table(results):
    count, killed, share = summary(results)
    known = reasons()
    text = ["# Mutation run", "", "Written by `coverage/mutate.py`; [what it means](README.md#mutants).", "",
            f"{killed} of {count} mutants are killed: {share:.1f} %. The sample has {COUNT}; {len(results) - count} that were tried do not compile.", "", *share_table("room", results, "room"), "",
            *share_table("change", results, "kind"), "", "## Survivors", "", "| mutant | where | change | why no test notices |",
            "| --- | --- | --- | --- |"]
    for identity, entry in sorted(results.items(), key=lambda item: item[1]["path"]):
        if entry["verdict"] == "survived":
            before, after = (entry[key].strip().replace("|", "\\|") for key in ("before", "after"))
            text.append(f"| {identity} | {entry['path']} | `{before}` → `{after}` | {known.get(identity, 'not looked into')} |")
    return "\n".join(text) + "\n"


def complaints(results):
    count, _, share = summary(results)
    known = reasons()
    found = [f"{identity}: {entry['path']}: survives without a reason in {REASONS.name}"
             for identity, entry in results.items() if entry["verdict"] == "survived" and identity not in known]
    found += [f"{identity}: a reason, but no such survivor" for identity in known
              if results.get(identity, {}).get("verdict") != "survived"]
    if count == 0 or share < LEAST_KILLED:
        found.append(f"{share:.1f} % of {count} mutants are killed, the threshold is {LEAST_KILLED:g} %")
    return found


def run_mutants(sample, results, seconds):
    if not sample:
        return
    readers, normal = prepare()
    end = time.monotonic() + seconds
    timeout = 10 + 5 * normal
    for mutant in sample:
        if time.monotonic() > end:
            print("mutate: the time is over; run again to go on")
            break
        if readers[mutant.path] > FEW:
            continue
        entry = {"path": mutant.path, "room": mutant.room, "kind": mutant.kind, "before": mutant.before, "after": mutant.after,
                 "verdict": verdict(mutant, timeout)}
        results[mutant.identity] = entry
        RESULTS.write_text(json.dumps(results, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")
        print(f"{entry['verdict']:12} {mutant.identity} {mutant.path}:{mutant.line}: {mutant.before.strip()}  ->  "
              f"{mutant.after.strip()}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=COUNT, help=f"mutants in the sample (default {COUNT})")
    parser.add_argument("--room", nargs="+", choices=ROOMS, default=ROOMS, help="only these folders of lib/hompm")
    parser.add_argument("--seconds", type=float, default=1e9, help="stop after this time")
    parser.add_argument("--again", action="store_true", help="forget the results of earlier runs")
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--show", metavar="ID")
    parser.add_argument("--check", action="store_true")
    given = parser.parse_args()

    mutants = all_mutants(given.room)
    if given.show:
        for mutant in mutants:
            if mutant.identity == given.show:
                print(f"{mutant.path}:{mutant.line}\n-{mutant.before}\n+{mutant.after}")
                return 0
        parser.error(f"no mutant {given.show} in this code")
    results = {} if given.again else stored(RESULTS, {})
    if not given.check:
        # A result of code that is no more is worth nothing.
        there = {mutant.identity for mutant in all_mutants(ROOMS)}
        results = {identity: entry for identity, entry in results.items() if identity in there}
        sample = mutants[:given.count]
        if given.list:
            print("\n".join(f"{m.identity} {m.kind:10} {m.path}:{m.line}: {m.after.strip()}" for m in sample))
            return 0
        run_mutants([mutant for mutant in sample if mutant.identity not in results], results, given.seconds)
        TABLE.write_text(table(results), encoding="utf-8")
    elif not TABLE.exists() or TABLE.read_text(encoding="utf-8") != table(results):
        print(f"mutate: {TABLE.name} is not what {RESULTS.name} and {REASONS.name} say; run coverage/mutate.py --count 0")
        return 1
    found = complaints(results)
    count, killed, share = summary(results)
    print("".join(f"mutate: {complaint}\n" for complaint in found) + f"mutate: {killed} of {count} mutants killed, {share:.1f} %")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
