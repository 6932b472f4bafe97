#!/usr/bin/env python3
"""clang-tidy over the sources of lib/ and cli/, many read as one.

    tests/tidy.py BUILD    BUILD: a build folder with compile_commands.json, configured by clang++

Most of clang-tidy's time goes into headers, which it reads and searches anew for each source. Sources whose local names differ are
included in one file, which clang's analyser knows as a unified source; where that does not compile, each is read by itself.
Exit code 1: a finding.
"""
import collections
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
LOCAL = re.compile(r"^namespace \{\n(.*?)^\}  // namespace$", re.DOTALL | re.MULTILINE)
NAME = re.compile(r"^(?:template\b.*>\s+)?(?:(?:struct|class|enum(?: class)?) (\w+)|(?!using |namespace )[A-Za-z].*?(\w+) ?[({=])", re.MULTILINE)
LARGEST = 4000  # lines of sources in one: the first and largest bounds how long all take


def local_names(text):
    return {match[1] or match[2] for part in LOCAL.findall(text) for match in NAME.finditer(part)}


def unified(entries):
    """Sources in groups, none of which has a local name twice."""
    groups = []  # [entries, names, lines]
    for entry in entries:
        text = pathlib.Path(entry["file"]).read_text(encoding="utf-8")
        names, lines = local_names(text), text.count("\n")
        for group in groups:
            if not group[1] & names and group[2] + lines <= LARGEST:
                break
        else:
            groups.append(group := [[], set(), 0])
        group[0].append(entry)
        group[1] |= names
        group[2] += lines
    return [group[0] for group in sorted(groups, key=lambda group: -group[2])]


def tidy(folder, *files):
    done = subprocess.run(["clang-tidy", "-p", folder, "--quiet", f"--config-file={ROOT / '.clang-tidy'}", "--warnings-as-errors=*", *files],
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


def check(folder, number, group):
    """What is found in a group of sources."""
    source = folder / f"{number}.cpp"
    code, found = tidy(folder, source)
    if "clang-diagnostic-error" not in found or len(group) == 1:
        return code, found
    print(f"tidy: {len(group)} sources do not compile as one, as in\n{found[:400]}", flush=True)
    results = [tidy(folder, entry["file"]) for entry in group]
    return max(code for code, _ in results), "".join(found for _, found in results)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    wanted = set(subprocess.run(["git", "ls-files", "lib/*.cpp", "cli/*.cpp"], cwd=ROOT, capture_output=True, text=True,
                                check=True).stdout.split())
    entries = [entry for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8"))
               if entry["file"] in {str(ROOT / name) for name in wanted}]
    if len(entries) != len(wanted):
        sys.exit(f"tidy: {build} builds {len(entries)} of {len(wanted)} sources; configure it anew")
    folders = collections.defaultdict(list)
    for entry in entries:
        folders[str(pathlib.Path(entry["file"]).relative_to(ROOT)).split("/")[0]].append(entry)
    groups = [group for part in folders.values() for group in unified(part)]
    folder = build / "tidy"
    folder.mkdir(exist_ok=True)
    for number, group in enumerate(groups):
        (folder / f"{number}.cpp").write_text("".join(f'#include "{entry["file"]}"\n' for entry in group), encoding="utf-8")
    database = entries + [dict(group[0], file=str(folder / f"{number}.cpp"),
                               command=group[0]["command"].replace(group[0]["file"], str(folder / f"{number}.cpp")))
                          for number, group in enumerate(groups)]
    (folder / "compile_commands.json").write_text(json.dumps(database), encoding="utf-8")
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda item: check(folder, *item), enumerate(groups)))
    print("".join(found for _, found in results), end="")
    return int(any(code for code, _ in results))


if __name__ == "__main__":
    sys.exit(main())
