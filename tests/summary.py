#!/usr/bin/env python3
"""Sums up a run of tests/run.sh, from the folder of its logs: what each part and each folder of tests took, and how many tests passed.

    tests/summary.py build/release-tests

The last line counts tests, and the parts that are one test each (lint, say): "512 passed, 0 failed".
"""
import collections
import pathlib
import sys
import xml.etree.ElementTree

SET_UP = ("packages", "build")


def main():
    logs = pathlib.Path(sys.argv[1])
    parts = [line.split(" ", 2) for line in (logs / "parts").read_text(encoding="utf-8").splitlines()]
    folders = collections.defaultdict(lambda: [0.0, 0])  # seconds, tests
    failed, skipped, passed = [], [], 0
    for path in sorted(logs.glob("*.xml")):
        for case in xml.etree.ElementTree.parse(path).iter("testcase"):
            name, with_sanitizers = case.get("name"), path.stem == "sanitised"
            row = folders["sanitised" if with_sanitizers else name.split(":")[0]]
            row[0] += float(case.get("time"))
            row[1] += 1
            if case.get("status") == "run":
                passed += 1
            elif case.find("skipped") is not None and "SKIP_RETURN_CODE" in case.find("skipped").get("message"):
                skipped.append(f"{name}: {(case.findtext('system-out') or '').strip().splitlines()[-1:]}")
            else:
                failed.append(name)
    print("\n seconds  part")
    for result, seconds, name in parts:
        print(f"{seconds:>8}  {name}{'' if result == 'passed' else ': FAILED'}")
    print("\n seconds  tests  folder (seconds of each test, of which as many run at a time as there are processors)")
    for name, (seconds, count) in sorted(folders.items(), key=lambda item: -item[1][0]):
        print(f"{seconds:8.0f}  {count:5}  {name}")
    for line in skipped:
        print(f"skipped: {line}")
    for name in failed:
        print(f"failed: {name}")
    # A part without tests of its own is one; a build that failed is one, too.
    for result, _, name in parts:
        if result != "passed" and not (name.startswith("tests") and failed):
            failed.append(name)
        elif result == "passed" and not name.startswith("tests") and name not in SET_UP:
            passed += 1
    print(f"\n{passed} passed, {len(failed)} failed")


if __name__ == "__main__":
    main()
