"""What the parts of docs/make_tables.py have in common: runs of hompm-run, and words for a table."""
import concurrent.futures
import json
import math
import os
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


class Tools:
    """Runs hompm-run in a working folder of its own."""

    def __init__(self, folder, work):
        self.run_tool = folder / "hompm-run"
        self.work = pathlib.Path(work)
        self.known = {}  # reports, by their options
        self.known_catalogue = None

    def text(self, *options):
        done = subprocess.run([self.run_tool, *map(str, options)], capture_output=True, text=True, check=False, cwd=self.work)
        if done.returncode != 0:
            sys.exit(f"{' '.join(['hompm-run', *map(str, options)])}: {done.stderr.strip() or done.stdout.strip()}")
        return done.stdout

    def json(self, *options, tool="hompm-run"):
        """What a tool prints with --json."""
        done = subprocess.run([self.run_tool.with_name(tool), *map(str, options), "--json"], capture_output=True, text=True, check=False, cwd=self.work)
        if done.returncode != 0:
            sys.exit(f"{' '.join([tool, *map(str, options)])}: {done.stderr.strip() or done.stdout.strip()}")
        return json.loads(done.stdout)

    def catalogue(self):
        """Cases, schemes, materials, effects, and the formats of files."""
        if not self.known_catalogue:
            self.known_catalogue = self.json("--list")
        return self.known_catalogue

    def schemes(self):
        return [row["name"] for row in self.catalogue()["schemes"]]

    def complaint(self, *options):
        """What the tool says about a mistake."""
        return subprocess.run([self.run_tool, *options], capture_output=True, text=True, check=False, cwd=self.work).stderr

    def report(self, *options):
        """The run.json of a run, and its folder."""
        folder = pathlib.Path(tempfile.mkdtemp(dir=self.work))
        return json.loads(self.text(*options, "--errors", "full", "--no-vtk", "--json", "--output", folder)), folder

    def reports(self, runs):
        """The run.json of many runs, in their order."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            new = list({tuple(run) for run in runs} - set(self.known))
            self.known.update(zip(new, pool.map(lambda options: self.report(*options)[0], new)))
        return [self.known[tuple(run)] for run in runs]


def error_of(report, field):
    return report["errors"][field]["relative_l2"]


def short(value):
    """Three digits, as in 9.05e-4."""
    mantissa, exponent = f"{value:.2e}".split("e")
    return f"{mantissa}e{int(exponent)}"


def table(header, rows, right=()):
    """Markdown; the columns whose indices are in `right` are flush right."""
    line = ["---:" if i in right else "---" for i in range(len(header))]
    return ["| " + " | ".join(map(str, row)) + " |" for row in [header, line, *rows]]


def order(before, error):
    return f"{math.log2(before / error):.1f}".replace("-", "−")


def settled_scene(tools):
    """The scene in docs/benchmarks.md."""
    text = re.search(r"```toml\n(# settled\.toml\n.*?)```", (ROOT / "docs/benchmarks.md").read_text(), re.DOTALL).group(1)
    (tools.work / "settled.toml").write_text(text)
