#!/usr/bin/env python3
"""Runs an example program: it prints what the comment on top of its source says.

    check_example.py PROGRAM SOURCE

The comment has the program's output behind `// Prints:`, a line for a line, each behind `//   `.
"""
import pathlib
import subprocess
import sys

program, source = sys.argv[1:]
lines = pathlib.Path(source).read_text(encoding="utf-8").splitlines()
start = lines.index("// Prints:") + 1
expected = []
for line in lines[start:]:
    if not line.startswith("//   "):
        break
    expected.append(line.removeprefix("//   "))
code = [line for line in lines if not line.startswith("//")]
done = subprocess.run([program], capture_output=True, text=True, check=False)
if done.returncode != 0 or done.stdout.splitlines() != expected:
    sys.exit(f"{source} says that it prints\n{chr(10).join(expected)}\nIt ended with {done.returncode}:\n{done.stdout}{done.stderr}")
if len(code) >= 40:
    sys.exit(f"{source} has {len(code)} lines without its comment; an example has fewer than 40")
