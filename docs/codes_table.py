"""The table of codes in docs/codes.md, from golden/others."""
import json
import math
import shlex
import subprocess
import tempfile

from table_tools import ROOT, short, table

OTHERS = ROOT / "golden/others"
FIELDS = ["displacement", "velocity", "stress"]
WORDS = ["code", "authors", "version", "language", "settings", "machine", "ran_by"]


def read_codes():
    """{folder: its code.json}, each with all its words, each of its files there, and no file that it does not name."""
    codes = {}
    for path in sorted(OTHERS.glob("*/code.json")):
        code = json.loads(path.read_text())
        missing = [word for word in WORDS if not code.get(word)]
        files = {path.parent / result["file"] for result in code["results"]} ^ set(path.parent.glob("*.csv"))
        if missing or files:
            raise SystemExit(f"{path}: to be filled in or mended: {', '.join([*missing, *map(str, sorted(files))])}")
        codes[path.parent.name] = code
    return codes


def compared(tools, file, options):
    """{field: (digits of agreement with the run of hompm, largest error against the exact solution or None)}"""
    folder = tempfile.mkdtemp(dir=tools.work)
    options = [str(ROOT / word) if word.startswith("golden/") else word for word in options]
    tools.text(*options, "--no-vtk", "--quiet", "--output", folder)
    # Karamelo's dumps do not have the start: only the times that both have.
    times = sorted({line.split(",")[0] for line in file.read_text().splitlines()[1:]}, key=float)
    chosen = [word for time in times for word in ("--time", repr(float(time)))]
    done = subprocess.run([tools.run_tool.parent / "hompm-diff", "--json", *chosen, file, folder], capture_output=True, text=True, check=False)
    if done.returncode not in (0, 3):
        raise SystemExit(f"{file}: {done.stderr}")
    report = json.loads(done.stdout)
    if report["messages"]:
        raise SystemExit(f"{file}: {report['messages']}")
    errors = {}
    for figures in report["fields"]:
        if figures["error"] and figures["largest"] > 0:
            errors.setdefault(figures["field"], []).append(figures["error"]["max"] / figures["largest"])
    return {field: (report["digits"].get(field), max(errors.get(field, []), default=None)) for field in FIELDS}


def codes(tools):
    rows = []
    for folder, code in read_codes().items():
        for result in code["results"]:
            figures = compared(tools, OTHERS / folder / result["file"], shlex.split(result["run"]))
            digits = " / ".join("all" if d is None else f"{d:.1f}" for d, _ in figures.values())
            errors = " / ".join("–" if e is None else short(e) for _, e in figures.values())
            rows.append([code["code"], result["case"], f"`{scheme_of(result['run'])}`", digits, errors, result["ns_per_particle_and_step"] or "–"])
    return table(["code", "case", "as", "digits", "error", "ns"], rows, [5])


def scheme_of(run):
    words = shlex.split(run)
    return " ".join([words[words.index("--scheme") + 1], *(w.split("=", 1)[1] for w in words if w.startswith("scheme."))])


PARTS = {"codes": codes}
