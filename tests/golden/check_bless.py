#!/usr/bin/env python3
"""What golden/bless refuses, and what it records, in a small repository with programs that only pretend to run.

    tests/golden/check_bless.py build/release/bin
"""
import hashlib
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
NAME = "bar-small-classical"
RUN = """#!/bin/sh
if [ "$1" = --list ]; then echo '{{"schemes": [{{"name": "classical"}}]}}'; exit; fi
while [ "$1" != --output ]; do shift; done
mkdir -p "$2" && cp "{results}"/*.csv "{results}/scene.toml" "$2" && cat "{results}/run.json"
exit {code}
"""
complaints = []


def check(holds, what):
    if not holds:
        complaints.append(what)


class Place:
    """A repository with golden/bless and one golden folder, and two programs beside it."""

    def __init__(self, work, diff_tool):
        self.work = pathlib.Path(work)
        self.tree = self.work / "tree"
        self.golden = self.tree / "golden" / NAME
        shutil.copytree(ROOT / "golden" / NAME, self.golden)
        shutil.copy(ROOT / "golden/bless", self.tree / "golden/bless")
        self.git("init", "--quiet")
        self.commit("first")
        self.tools = [self.work / name / "bin" for name in ("g++", "clang++")]
        for tool, compiler in zip(self.tools, ("GNU 12.2.0", "Clang 14.0.6")):
            results = tool.parent / "results"
            shutil.copytree(self.golden, results)
            tool.mkdir()
            (tool / "hompm-diff").symlink_to(diff_tool)
            self.change(tool, compiler=compiler)

    def git(self, *arguments):
        who = ["-c", "user.name=test", "-c", "user.email=test@example.org", "-c", "commit.gpgsign=false"]
        return subprocess.run(["git", "-C", self.tree, *who, *arguments], capture_output=True, text=True, check=True).stdout.strip()

    def commit(self, subject):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", subject)

    def change(self, tool, compiler=None, commit=None, velocity=None, code=0):
        """What the program says about itself and its run."""
        results = tool.parent / "results"
        path = results / "run.json"
        if path.exists():
            report = json.loads(path.read_text())
        else:
            report = {"build": {"version": "0.1.0"}, "errors": json.loads((self.golden / "provenance.json").read_text())["errors"]}
        report["build"]["compiler"] = compiler or report["build"]["compiler"]
        report["build"]["commit"] = commit or self.git("rev-parse", "--short=12", "HEAD")
        if velocity is not None:
            report["errors"]["velocity"]["relative_l2"] = velocity
        path.write_text(json.dumps(report))
        (tool / "hompm-run").write_text(RUN.format(results=results, code=code))
        (tool / "hompm-run").chmod(0o755)

    def bless(self, *arguments, tools=None):
        command = [sys.executable, self.tree / "golden/bless", *arguments, "--tools", *(tools or self.tools), "--", NAME]
        return subprocess.run(command, capture_output=True, text=True, check=False)

    def replace(self, tool, file, old, new):
        path = tool.parent / "results" / file
        text = path.read_text()
        assert old in text, f"{old} is not in {file}"
        path.write_text(text.replace(old, new, 1))


def refuses(name, words, prepare, reason="because", tools=None):
    """A reason is given, all is well but for what `prepare` does: nothing may be replaced."""
    with tempfile.TemporaryDirectory() as work:
        place = Place(work, TOOL)
        prepare(place)
        before = {path: path.read_bytes() for path in place.golden.iterdir()}
        done = place.bless("--reason", reason, tools=tools(place) if tools else None)
        check(done.returncode == 1, f"{name}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        check(words in done.stderr, f"{name}: expected `{words}` in: {done.stderr}")
        check("Traceback" not in done.stderr, f"{name}: {done.stderr}")
        check(before == {path: path.read_bytes() for path in place.golden.iterdir()}, f"{name}: the golden folder changed")


def both(place, *change):
    for tool in place.tools:
        place.replace(tool, *change)


def refusals():
    first_value = "\n0,0,0.048828125,0.048828125,0,"
    refuses("changed file", "changes that are not committed", lambda p: (p.tree / "golden/bless").open("a").write("\n"))
    refuses("changed golden data", "changes that are not committed", lambda p: (p.golden / "scene.toml").open("a").write("\n"))
    refuses("new file", "?? new.txt", lambda p: (p.tree / "new.txt").write_text("x"))
    refuses("empty reason", "an empty reason is none", lambda p: None, reason="  ")
    refuses("another commit", "is of commit 0123456789ab, the tree of", lambda p: p.change(p.tools[1], commit="0123456789ab"))
    refuses("changed build", "-dirty, the tree of",
            lambda p: p.change(p.tools[0], commit=p.git("rev-parse", "--short=12", "HEAD") + "-dirty"))
    refuses("one compiler twice", "two compilers are needed, both programs are by GNU", lambda p: None,
            tools=lambda p: [p.tools[0], p.tools[0]])
    for file in ("particles.csv", "stress.csv"):
        refuses(f"compilers disagree about {file}", f"GNU 12.2.0 and Clang 14.0.6 disagree about {file}",
                lambda p, f=file: p.replace(p.tools[1], f, first_value, first_value[:-1] + "1,"))
    refuses("compilers disagree about the scene", "disagree about scene.toml",
            lambda p: p.replace(p.tools[1], "scene.toml", "64", "65"))
    refuses("NaN", "particles.csv line 2: displacement is nan",
            lambda p: both(p, "particles.csv", first_value, first_value[:-2] + "nan,"))
    refuses("infinity", "stress.csv line 2: stress is -inf", lambda p: both(p, "stress.csv", first_value, first_value[:-2] + "-inf,"))
    refuses("NaN error", "the error of the velocity (relative_l2) is nan", lambda p: p.change(p.tools[1], velocity=float("nan")))
    refuses("invalid run", f"{NAME}: ", lambda p: p.change(p.tools[1], code=4))


def records():
    with tempfile.TemporaryDirectory() as work:
        place = Place(work, TOOL)
        done = place.bless()
        check(done.returncode == 0 and f"{NAME}: identical" in done.stdout and "nothing was replaced" in done.stdout,
              f"without a reason: {done.stdout}{done.stderr}")
        check(place.git("status", "--porcelain") == "", "without a reason: the golden folder changed")

        content = b"".join((place.golden / name).read_bytes()
                           for name in ("scene.toml", "particles.csv", "stress.csv", "history.csv", "provenance.json"))
        old_error = json.loads((place.golden / "provenance.json").read_text())["errors"]["velocity"]["relative_l2"]
        both(place, "stress.csv", "\n0,0,0.048828125,0.048828125,0,", "\n0,0,0.048828125,0.048828125,1,")
        for tool in place.tools:
            place.change(tool, velocity=2 * old_error)
        done = place.bless("--reason", "a test")
        check(done.returncode == 0 and "1 folders replaced" in done.stdout, f"with a reason: {done.stdout}{done.stderr}")
        check("1 values differ, stress" in done.stdout and "(+1e+02 %)" in done.stdout, f"the change is not told: {done.stdout}")
        record = json.loads((place.golden / "provenance.json").read_text())
        check(record["reason"] == "a test", "reason")
        check(record["commit"] == place.git("rev-parse", "--short=12", "HEAD"), "commit")
        check([build["compiler"] for build in record["builds"]] == ["GNU 12.2.0", "Clang 14.0.6"], f"builds: {record['builds']}")
        check(record["builds"][0]["version"] == "0.1.0", "version")
        check(record["parent"] == hashlib.sha256(content).hexdigest(), "parent is not the hash of what was replaced")
        check(record["errors"]["velocity"]["relative_l2"] == 2 * old_error, "errors")
        check(sorted(os.listdir(place.golden.parent)) == [NAME, "bless"], f"left over: {os.listdir(place.golden.parent)}")

        verify = [sys.executable, place.tree / "golden/bless", "--verify", NAME]
        check(subprocess.run(verify, check=False).returncode == 0, "a blessed folder is not verified")
        for file in ("scene.toml", "history.csv"):
            path = place.golden / file
            path.write_text(path.read_text() + "\n")
            done = subprocess.run(verify, capture_output=True, text=True, check=False)
            check(done.returncode == 1 and f"{NAME}/{file} is not the file that was blessed" in done.stderr, f"{file} changed unseen")


if __name__ == "__main__":
    TOOL = pathlib.Path(sys.argv[1]).resolve() / "hompm-diff"
    refusals()
    records()
    for complaint in complaints:
        print(complaint, file=sys.stderr)
    sys.exit(1 if complaints else 0)
