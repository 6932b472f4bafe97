#!/usr/bin/env python3
"""clang-tidy over the sources of lib/ and cli/, many read as one.

    tests/tidy.py BUILD    BUILD: a build folder with compile_commands.json, configured by clang++

Most of clang-tidy's time goes into headers, which it reads and searches anew for each source. So many are put together in one, not
included, since some checks look at no file but the main one; where that does not compile, each is read by itself.
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
NAME = re.compile(r"^(?:template\b.*>\s+)?(?:(?:struct|class|enum(?: class)?) (\w+)|(?!using |namespace )[A-Za-z].*?(\w+) ?[({=])",
                  re.MULTILINE)
LARGEST = 4500  # lines of sources in one, about


def local_names(text):
    return {"main"} | {match[1] or match[2] for part in LOCAL.findall(text) for match in NAME.finditer(part)}


def in_groups(entries):
    """Sources in groups of about the same size."""
    sizes = {entry["file"]: pathlib.Path(entry["file"]).read_text(encoding="utf-8").count("\n") for entry in entries}
    count = -(-sum(sizes.values()) // LARGEST)
    groups = [[] for _ in range(count)]
    for entry in sorted(entries, key=lambda entry: -sizes[entry["file"]]):
        min(groups, key=lambda group: sum(sizes[one["file"]] for one in group)).append(entry)
    return groups


def tidy(folder, file):
    done = subprocess.run(["clang-tidy", "-p", folder, "--quiet", f"--config-file={ROOT / '.clang-tidy'}", "--warnings-as-errors=*", file],
                          capture_output=True, text=True, check=False)
    return done.returncode, done.stdout


def unify(source, group):
    """Writes the sources of a group as one, each header in the first that includes it, and gives the file and line of each line.
    A local name that is taken gets a number."""
    places, lines, included, taken = [], [], set(), set()
    for number, entry in enumerate(group):
        text = pathlib.Path(entry["file"]).read_text(encoding="utf-8")
        names = local_names(text)
        for name in names & taken:
            text = re.sub(rf"(?<![.\w:\"/])(?<!->){name}\b(?![\w/]*\.hpp)", f"{name}_{number}", text)
        taken |= names
        text = text.splitlines()
        lines += ["" if line in included else line for line in text]
        places += [f"{entry['file']}:{number}" for number in range(1, len(text) + 1)]
        included |= {line for line in text if line.startswith("#include")}
    source.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return places


def check(folder, number, group):
    """What is found in a group of sources."""
    source = folder / f"{number}.cpp"
    places = unify(source, group)
    code, found = tidy(folder, source)
    if "clang-diagnostic-error" in found and len(group) > 1:
        print(f"tidy: {len(group)} sources do not compile as one, which takes longer: {found.splitlines()[0]}", flush=True)
        results = [tidy(folder, entry["file"]) for entry in group]
        return max(code for code, _ in results), "".join(found for _, found in results)
    return code, re.sub(re.escape(str(source)) + r":(\d+)", lambda match: places[int(match[1]) - 1], found)


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
        parts = pathlib.Path(entry["file"]).relative_to(ROOT).parts
        folders["python" if "python" in parts else parts[0]].append(entry)  # that one has headers of its own
    groups = [group for part in folders.values() for group in in_groups(part)]
    folder = build / "tidy"
    folder.mkdir(exist_ok=True)
    database = entries + [dict(group[0], file=str(folder / f"{number}.cpp"), command=group[0]["command"].replace(
        group[0]["file"], f"{folder / f'{number}.cpp'} -I{ROOT / 'cli'} -Wno-shadow")) for number, group in enumerate(groups)]
    (folder / "compile_commands.json").write_text(json.dumps(database), encoding="utf-8")
    worst = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for code, found in pool.map(lambda item: check(folder, *item), enumerate(groups)):
            print(found, end="", flush=True)
            worst |= int(code != 0)
    return worst


if __name__ == "__main__":
    sys.exit(main())
