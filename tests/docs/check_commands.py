#!/usr/bin/env python3
"""Runs every command of the Markdown files, and follows every relative link in them.

Usage: check_commands.py BIN_DIR [--quick]

Each file gets a copy of the source tree to work in, and BIN_DIR (hompm-run, hompm-diff, hompm-study, hompm-exact) on the PATH. In it
- a fenced block of any language whose first line is `# NAME`, with a dot in NAME, is written to the file NAME;
- the lines of a ```sh block are run in order, each by a shell of its own (a `\\` at the end joins it with the next);
- a line that ends in `# exit N` must end with that exit code, all others with 0;
- a script of the tree, such as tests/run.sh, is not run but must be there and executable;
- with --quick a block that calls Octave, matplotlib or hompm-study is left out: the first two are not installed by default, the last takes
  long; and one that calls module_NAME.py, where the Python module was not built.

Exit code 0: all fine; 1: a complaint, with file and line; 2: bad usage.
"""
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
SKIPPED = ("build", ".git", "hompm-out", "__pycache__")
SECONDS = 120
LATER = ("octave-cli ", "hompm-study ", "python3 draw.py")  # what --quick leaves out


def markdown_files():
    inside = (path.relative_to(ROOT) for path in ROOT.rglob("*.md"))
    return sorted(path for path in inside if not any(part in SKIPPED or part.startswith(".") for part in path.parts))


def lines_outside_code(text):
    fenced = False
    for number, line in enumerate(text.split("\n"), start=1):
        if line.startswith("```"):
            fenced = not fenced
        elif not fenced:
            yield number, line


def blocks(text):
    """(language, number of the first line, lines) of each fenced block."""
    language = None
    for number, line in enumerate(text.split("\n"), start=1):
        if not line.startswith("```"):
            if language is not None:
                lines.append(line)
        elif language is None:
            language, start, lines = line[3:].strip(), number + 1, []
        else:
            yield language, start, lines
            language = None


def commands(start, lines):
    """(line number, command, expected exit code)"""
    whole = ""
    for number, line in enumerate(lines, start=start):
        if not whole:
            first = number
        if line.endswith("\\"):
            whole += line[:-1]
            continue
        whole += line
        expected = re.search(r"#\s*exit (\d+)\s*$", whole)
        if whole.strip() and not whole.lstrip().startswith("#"):
            yield first, whole.strip(), int(expected.group(1)) if expected else 0
        whole = ""


def script_of(command):
    """The script of the tree that a command calls, behind settings such as PRESET=debug; None for other commands."""
    words = [word for word in command.split() if not re.match(r"[A-Z_]+=", word)]
    return words[0] if words and "/" in words[0] else None


def run(path, text, folder, environment, quick):
    """Complaints about the commands of a file, and how many were run."""
    complaints, count = [], 0
    for language, start, lines in blocks(text):
        named = re.match(r"# ([\w-]+\.\w+)$", lines[0]) if lines else None
        if named and language != "sh":
            (folder / named.group(1)).write_text("\n".join(lines) + "\n")
        later = LATER if "PYTHONPATH" in environment else (*LATER, "python3 module_")
        if language != "sh" or (quick and any(line.startswith(later) for line in lines)):
            continue
        for number, command, expected in commands(start, lines):
            where = f"{path}:{number}: {command}"
            script = script_of(command)
            if script:
                if not os.access(ROOT / script, os.X_OK):
                    complaints.append(f"{where}\n  there is no such script")
                continue
            count += 1
            try:
                done = subprocess.run(["sh", "-c", command], cwd=folder, env=environment, timeout=SECONDS, check=False,
                                      stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            except subprocess.TimeoutExpired:
                complaints.append(f"{where}\n  took more than {SECONDS} s")
                continue
            if done.returncode != expected:
                tail = "".join(f"\n  | {line}" for line in done.stdout.rstrip().split("\n")[-5:])
                complaints.append(f"{where}\n  exit code {done.returncode}, not {expected}{tail}")
    return complaints, count


def anchors(path):
    """The names that GitHub gives the headings of a file."""
    names = set()
    for _, line in lines_outside_code(path.read_text()):
        if heading := re.match(r"#+ (.*)", line):
            name = re.sub(r"[^\w\- ]", "", heading.group(1).lower()).replace(" ", "-")
            repeated = sum(re.fullmatch(re.escape(name) + r"(-\d+)?", other) is not None for other in names)
            names.add(f"{name}-{repeated}" if name in names else name)
    return names


def broken_links(path, text):
    for number, line in lines_outside_code(text):
        for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
            if re.match(r"[a-z]+:", target):
                continue
            name, _, anchor = target.partition("#")
            file = (ROOT / path.parent / name).resolve() if name else ROOT / path
            if not file.exists():
                yield f"{path}:{number}: the link {target} leads nowhere"
            elif anchor and anchor not in anchors(file):
                yield f"{path}:{number}: the link {target} leads to no heading"


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[2:] not in ([], ["--quick"]):
        print(__doc__, file=sys.stderr)
        return 2
    tools = pathlib.Path(sys.argv[1]).resolve()
    for tool in ("hompm-run", "hompm-diff", "hompm-study", "hompm-exact"):
        if not (tools / tool).exists():
            print(f"check_commands: there is no {tools / tool}", file=sys.stderr)
            return 2
    complaints, count = [], 0
    with tempfile.TemporaryDirectory() as work:
        # The python3 that runs this may lack the Debian packages; the one beside them has them.
        shims = pathlib.Path(work) / "bin"
        shims.mkdir()
        if os.access("/usr/bin/python3", os.X_OK):
            (shims / "python3").symlink_to("/usr/bin/python3")
        environment = dict(os.environ, PATH=os.pathsep.join([str(tools), str(shims), os.environ["PATH"]]))
        if (tools.parent / "python").is_dir():
            environment["PYTHONPATH"] = str(tools.parent / "python")
        for number, path in enumerate(markdown_files()):
            text = (ROOT / path).read_text()
            complaints += broken_links(path, text)
            folder = pathlib.Path(work) / str(number)
            shutil.copytree(ROOT, folder, ignore=shutil.ignore_patterns(*SKIPPED, "build-*"))
            more, commands_run = run(path, text, folder, environment, len(sys.argv) == 3)
            complaints += more
            count += commands_run
            shutil.rmtree(folder)
    if count == 0:
        complaints.append("check_commands: not one command was found")
    for complaint in complaints:
        print(complaint)
    print(f"check_commands: {count} commands run, {len(complaints)} complaints")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
