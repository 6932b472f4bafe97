#!/usr/bin/env python3
"""Breaks the library in small ways, one at a time, and counts how often the tests notice.

    coverage/mutate.py --update [--count N] [--room ROOM ...] [--seconds S] [--again]  runs mutants without a verdict, writes the table
    coverage/mutate.py --list                                                          prints the sample, with its verdicts
    coverage/mutate.py --show ID                                                       prints one mutant as a difference
    coverage/mutate.py --check                                                         checks verdicts and table, runs nothing

The mutants are drawn by a fixed seed and named by what they change, so the same code gives the same sample. Verdicts are kept
in coverage/mutation.json, each with a digest of the function around the mutant: it holds until that function changes. Reasons for
survivors stand in coverage/survivors.toml. Works on a copy of the tree in build/mutation, built once with all mutants in it, each behind a
switch; a mutant is then run against the tests that reach it, the shortest first, until one fails. Exit code 1: a mutant of the
sample without a verdict, a survivor without a reason, or a kill rate below the threshold.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import resource
import shutil
import subprocess
import sys
import time
import tomllib

sys.dont_write_bytecode = True
from mutants import digest, mutants_of_file, with_switches  # noqa: E402

ROOT = pathlib.Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutation"
TREE, BUILD = WORK / "tree", WORK / "build"
RESULTS, REASONS, TABLE = (ROOT / "coverage" / name for name in ("mutation.json", "survivors.toml", "mutation.md"))
SEED = "hompm 1"
COUNT = 200
LEAST_KILLED = 90.0
FEW = 12  # a header that more translation units include takes too long to compile for one mutant
LONG = 10.0  # seconds: tests that take longer are left out, as those of long runs are that check no more than shorter ones
DONE = ("killed", "survived")
DEFAULT_OF_MEMBER = re.compile(r"  [\w:<>, ]+ \w+ = [^;()]*[;,]")
PROGRAMS = ["test_unit", "test_cli"]
NOT_RUN = ("counted steps", "instructions repeat")  # under callgrind
SWITCH = """// Which mutant is in force, and which were asked about: HOMPM_MUTANT, and a file HOMPM_REACHED with a byte for each.
#include <cstdlib>
#include <fcntl.h>
#include <sys/mman.h>

int hompm_mutant_in_force = 0;
static unsigned char nowhere[SIZE];
unsigned char* hompm_mutants_reached = nowhere;

__attribute__((constructor)) static void read_environment() {
  if (const char* number = std::getenv("HOMPM_MUTANT")) hompm_mutant_in_force = std::atoi(number);
  const char* name = std::getenv("HOMPM_REACHED");
  const int file = name ? open(name, O_RDWR | O_CLOEXEC) : -1;
  if (file < 0) return;
  void* const shared = mmap(nullptr, SIZE, PROT_READ | PROT_WRITE, MAP_SHARED, file, 0);
  if (shared != MAP_FAILED) hompm_mutants_reached = static_cast<unsigned char*>(shared);
}
"""
SWITCH_HEADER = """#pragma once
extern int hompm_mutant_in_force;
extern unsigned char* hompm_mutants_reached;
constexpr bool hompm_mutant(int number) {
  if (__builtin_is_constant_evaluated()) return false;
  hompm_mutants_reached[number] = 1;
  return number == hompm_mutant_in_force;
}
"""


def run(*command, timeout=None, **variables):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, errors="replace", check=False,
                          timeout=timeout, env=os.environ | variables)


def used_seconds():
    """Of processor time, which other work on the machine does not lengthen."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def sources():
    return {str(path.relative_to(ROOT)): path for path in sorted((ROOT / "lib" / "hompm").rglob("*.[ch]pp"))}


def all_mutants(rooms=()):
    """Of every line of the library, or of some rooms, in the order that the seed draws them."""
    found = {}
    for name, path in sources().items():
        for mutant in mutants_of_file(name, path.read_text(encoding="utf-8")):
            if not rooms or mutant.room in rooms:
                found.setdefault(mutant.identity, mutant)
    return sorted(found.values(), key=lambda mutant: digest(SEED + mutant.identity))


def write_if_other(path, content):
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


class Mutation:
    """A build of the tests with mutants in it."""

    def __init__(self, mutants):
        self.numbers = {mutant: number for number, mutant in enumerate(mutants, start=1)}
        self.size = 4096 * (1 + len(mutants) // 4096)
        self.copy_tree()
        self.embed()
        self.readers = collections.Counter()
        for row in run("ninja", "-C", BUILD, "-t", "deps").stdout.splitlines():
            if "/lib/hompm/" in row:
                self.readers["lib/hompm/" + row.strip().split("/lib/hompm/")[-1]] += 1
        self.find_reached()

    def copy_tree(self):
        names = run("git", "-C", ROOT, "ls-files", "--cached", "--others", "--exclude-standard").stdout.splitlines()
        for name in names:
            if (ROOT / name).is_file() and name not in sources():
                write_if_other(TREE / name, (ROOT / name).read_bytes())
                shutil.copymode(ROOT / name, TREE / name)
        for path in (TREE / "lib" / "hompm").rglob("*.[ch]pp"):
            if str(path.relative_to(TREE)) not in sources() and path.name != "mutant_switch.cpp":
                path.unlink()
        write_if_other(WORK / "mutant_switch.hpp", SWITCH_HEADER.encode())
        write_if_other(TREE / "lib/hompm/mutant_switch.cpp", SWITCH.replace("SIZE", str(self.size)).encode())

    def embed(self):
        """Builds with all mutants, and without those whose expression does not compile, until it does."""
        inside = dict(self.numbers)
        for _ in range(20):
            places = {}
            for name, path in sources().items():
                numbers = {mutant: number for mutant, number in inside.items() if mutant.path == name}
                text, found = with_switches(path.read_text(encoding="utf-8"), numbers)
                write_if_other(TREE / name, text.encode())
                places |= found
            inside = {mutant: number for mutant, number in inside.items() if mutant in places}
            built = self.build("-k", "0")
            if built.returncode == 0:
                self.embedded = set(inside)
                return
            faulty = {(match[1], int(match[2]))
                      for match in re.finditer(r"(lib/hompm/[\w/]+\.[ch]pp):(\d+)(?=[:,])", built.stdout + built.stderr)}
            wrong = {mutant for mutant in inside if any((mutant.path, line) in faulty for line in places[mutant])}
            if not wrong:
                sys.exit(f"mutate: the code as it is does not build:\n{built.stdout[-3000:]}{built.stderr[-3000:]}")
            inside = {mutant: number for mutant, number in inside.items() if mutant not in wrong}
            print(f"mutate: {len(wrong)} of {len(self.numbers)} mutants do not compile behind a switch", flush=True)
        sys.exit("mutate: there is no end to the mutants that do not compile")

    def build(self, *options):
        if not (BUILD / "build.ninja").exists():
            configured = run("cmake", "-S", TREE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=None", "-DHOMPM_UNITE=OFF",
                             f"-DCMAKE_CXX_FLAGS=-O1 -w -include {WORK / 'mutant_switch.hpp'}",
                             *(["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []))
            if configured.returncode != 0:
                return configured
        return run("ninja", "-C", BUILD, *options, *PROGRAMS, "hompm-run", "hompm-diff", "hompm-study")

    def test(self, test, timeout=600.0, **variables):
        """Whether the test passes; one that hangs does not."""
        program, name = test
        escaped = re.sub(r"([\\,\[\]\"*])", r"\\\1", name)
        try:
            return run(BUILD / "tests" / program, escaped, timeout=timeout, **variables).returncode == 0
        except subprocess.TimeoutExpired:
            return False

    def find_reached(self):
        """Seconds of each test, and the numbers of the mutants that it reaches."""
        self.seconds, self.reached = {}, {}
        file = WORK / "reached"
        for program in PROGRAMS:
            for name in run(BUILD / "tests" / program, "--list-test-names-only").stdout.splitlines():
                if name.startswith(NOT_RUN):
                    continue
                file.write_bytes(bytes(self.size))
                start = used_seconds()
                if not self.test((program, name), HOMPM_REACHED=str(file)):
                    sys.exit(f"mutate: the test `{name}` fails on the code as it is")
                seconds = used_seconds() - start
                if seconds < LONG:
                    self.seconds[program, name] = seconds
                    self.reached[program, name] = {number for number, byte in enumerate(file.read_bytes()) if byte}

    def verdict(self, mutant):
        number = self.numbers[mutant]
        return self.judged([test for test in self.seconds if number in self.reached[test]], HOMPM_MUTANT=str(number))

    def judged(self, tests, **variables):
        for test in sorted(tests, key=lambda test: self.seconds[test]):
            if not self.test(test, 60.0 + 20.0 * self.seconds[test], **variables):
                return "killed"
        return "survived"

    def verdict_alone(self, mutant):
        """In a build of its own: for what is computed by the compiler, and for what is no expression."""
        if self.readers[mutant.path] > FEW:
            return "not run"
        target = TREE / mutant.path
        original = target.read_bytes()
        try:
            target.write_text(with_switches((ROOT / mutant.path).read_text(encoding="utf-8"), {}, mutant)[0], encoding="utf-8")
            if self.build().returncode != 0:
                return "not compiled"  # the compiler noticed; does not count
            return self.judged(self.seconds)
        finally:
            target.write_bytes(original)

    def alone(self, mutant):
        """What is no expression, and what the compiler computes itself, as it may the default of a member."""
        number = self.numbers[mutant]
        return (mutant not in self.embedded or DEFAULT_OF_MEMBER.match(mutant.before)
                or not any(number in reached for reached in self.reached.values()))


def stored(path, empty):
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else empty


def save(results):
    RESULTS.write_text(json.dumps(results, indent=1, ensure_ascii=False, sort_keys=True) + "\n", encoding="utf-8")


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
    others = collections.Counter(entry["verdict"] for entry in results.values() if entry["verdict"] not in DONE)
    commits = " and ".join(sorted({entry["commit"] for entry in results.values()}))
    text = ["# Mutation run", "", "Written by `coverage/mutate.py`; [what it means](README.md#mutants).", "",
            f"{killed} of {count} mutants are killed: {share:.1f} %. Of {max(COUNT, len(results))} that were drawn "
            f"{others['not compiled']} do not compile, and {max(COUNT, len(results)) - count - others['not compiled']} were not run: "
            f"most need a build of their own. Run at {commits}.", "",
            *share_table("room", results, "room"), "", *share_table("change", results, "kind"), "", "## Survivors", "",
            "| mutant | where | change | why no test notices |", "| --- | --- | --- | --- |"]
    for identity, entry in sorted(results.items(), key=lambda item: (item[1]["path"], item[0])):
        if entry["verdict"] == "survived":
            before, after = (entry[key].strip().replace("|", "\\|") for key in ("before", "after"))
            text.append(f"| {identity} | {entry['path']} | `{before}` → `{after}` | {known.get(identity, 'not looked into')} |")
    return "\n".join(text) + "\n"


def valid(results, sample):
    """The verdicts of the sample that hold: those on functions that are as they were then."""
    return {mutant.identity: results[mutant.identity] for mutant in sample
            if results.get(mutant.identity, {}).get("function") == mutant.function}


def complaints(results, sample):
    count, _, share = summary(results)
    known = reasons()
    found = []
    missing = [mutant for mutant in sample if mutant.identity not in results]
    if missing:
        names = ", ".join(f"{mutant.identity} ({mutant.path}:{mutant.line})" for mutant in missing[:3])
        found.append(f"{len(missing)} of {len(sample)} mutants of this code have no verdict: {names}, ...; run coverage/mutate.py --update")
    found += [f"{identity}: {entry['path']}: survives without a reason in {REASONS.name}"
             for identity, entry in results.items() if entry["verdict"] == "survived" and identity not in known]
    found += [f"{identity}: a reason, but no such survivor" for identity in known
              if results.get(identity, {}).get("verdict") != "survived"]
    if count == 0 or share < LEAST_KILLED:
        found.append(f"{share:.1f} % of {count} mutants are killed, the threshold is {LEAST_KILLED:g} %")
    return found


def run_mutants(sample, results, seconds, jobs):
    """Those of the sample that have no verdict."""
    missing = [mutant for mutant in sample if mutant.identity not in results]
    if not missing:
        return
    mutation = Mutation(missing)
    end = time.monotonic() + seconds
    commit = run("git", "-C", ROOT, "describe", "--always", "--dirty").stdout.strip()

    def keep(mutant, verdict):
        results[mutant.identity] = {"path": mutant.path, "room": mutant.room, "kind": mutant.kind, "before": mutant.before,
                                    "after": mutant.after, "function": mutant.function, "verdict": verdict, "commit": commit}
        save(results)
        print(f"{verdict:12} {mutant.identity} {mutant.path}:{mutant.line}: {mutant.before.strip()}  ->  {mutant.after.strip()}",
              flush=True)

    switched = [mutant for mutant in missing if not mutation.alone(mutant)]
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for mutant, verdict in zip(switched, pool.map(lambda m: mutation.verdict(m) if time.monotonic() < end else None, switched)):
            if verdict:
                keep(mutant, verdict)
    for mutant in missing:
        if mutation.alone(mutant) and time.monotonic() < end:
            keep(mutant, mutation.verdict_alone(mutant))
    if time.monotonic() > end:
        print("mutate: the time is over; run again to go on")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=COUNT, help=f"mutants in the sample (default {COUNT})")
    parser.add_argument("--room", nargs="+", default=[], help="only these folders of lib/hompm")
    parser.add_argument("--seconds", type=float, default=1e9, help="begin no mutant after this time")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), help="mutants at a time")
    parser.add_argument("--again", action="store_true", help="forget the verdicts of earlier runs")
    parser.add_argument("--update", action="store_true", help="run the mutants of the sample that have no verdict")
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
    sample = mutants[:given.count]
    results = {} if given.again else valid(stored(RESULTS, {}), sample if given.check or not given.room else all_mutants())
    if given.list:
        for mutant in sample:
            verdict = results.get(mutant.identity, {}).get("verdict", "no verdict")
            print(f"{mutant.identity} {verdict:10} {mutant.kind:10} {mutant.path}:{mutant.line}: {mutant.after.strip()}")
        return 0
    if given.update:
        start, before = time.monotonic(), used_seconds()
        run_mutants(sample, results, given.seconds, given.jobs)
        save(results)
        TABLE.write_text(table(results), encoding="utf-8")
        print(f"mutate: {time.monotonic() - start:.0f} s, {used_seconds() - before:.0f} s of processor time")
    elif not given.check:
        parser.error("say --update, --check, --list or --show ID")
    found = complaints(results, sample)
    if given.check and (not TABLE.exists() or TABLE.read_text(encoding="utf-8") != table(results)):
        found.append(f"{TABLE.name} is not what the verdicts and {REASONS.name} say; run coverage/mutate.py --update")
    count, killed, share = summary(results)
    print("".join(f"mutate: {complaint}\n" for complaint in found) + f"mutate: {killed} of {count} mutants killed, {share:.1f} %")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
