#!/usr/bin/env python3
"""Writes docs/accuracy-cost.md anew: runs the studies of docs/studies, keeps their numbers as CSV beside them, and the
generated parts of the page; docs/make_pictures.py draws them.

    docs/make_study.py [--tool build/release/bin] [--work build/study] [--repeats 5] [--check [--quick]]

A run that was interrupted goes on in the folder --work. With --check nothing is written: the exit code is 1 when the page does
not say what the CSV files say, or when they are not current. That is seen from their points, which must be those of the
studies with the present table of schemes, and from a few cheap ones, run anew: their errors must be the same to the digit, their
instructions the same to 0.5 %. --quick runs none. Another compiler makes other instructions; they are
then passed over, with a note.
"""
import argparse
import concurrent.futures
import csv
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from make_tables import ROOT, short, table  # noqa: E402

PAGE = ROOT / "docs/accuracy-cost.md"
STUDIES = ROOT / "docs/studies"
NAMES = ["bar-large", "bar-small", "column-large", "column-small"]
FIELDS = ["displacement", "velocity", "stress"]
KEPT = ["point", "status", "scheme", "degree", "cells", "particles_per_cell", "particles", "steps",
        *(f"{field}_relative_l2" for field in FIELDS), "instructions", "instructions_per_particle_and_step"]
ALL = [*NAMES, "scaling", "ladder"]
AMONG = ["classical", "bspline", "tielen2017", "high-order"]
TOLERANCE = 0.005
ERRORS = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)


def run(tool, *options):
    done = subprocess.run([tool / "hompm-study", *map(str, options)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"hompm-study {' '.join(map(str, options))}: {done.stderr.strip()}")
    return done.stdout


def compiler(tool):
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([tool / "hompm-run", "--case", "bar", "--cells", "8", "--end-time", "0.01", "--no-vtk", "--json",
                               "--output", folder], capture_output=True, text=True, check=True)
        build = json.loads(done.stdout)["build"]
    return f"{build['compiler']} {build['architecture']} {build['flags']}"


def make_study(tool, name, work, repeats):
    """Runs a study; its points as the rows to keep, with the times of those that the page names."""
    folder = work / name
    run(tool, "--study", STUDIES / f"{name}.toml", "--output", folder, "--repeats", 0, "--quiet")
    with open(folder / "points.csv", newline="", encoding="utf-8") as file:
        points = list(csv.DictReader(file))
    times = times_of(tool, name, named_points(points), work, repeats) if name in NAMES and repeats else {}
    with open(STUDIES / f"{name}.csv", "w", newline="", encoding="utf-8") as kept:
        writer = csv.writer(kept, lineterminator="\n")
        writer.writerow([*KEPT, "seconds"])
        for row in points:
            writer.writerow([*(row[column] for column in KEPT), times.get(row["point"], "")])


def named_points(rows):
    """The cheapest for each error."""
    best = [cheapest(rows, field, error) for field in ("displacement", "stress") for error in ERRORS]
    return sorted({row["point"] for row in best if row})


def times_of(tool, name, points, work, repeats):
    """{point: least seconds}, of a study of these points alone."""
    study = (STUDIES / f"{name}.toml").read_text().split("[[sweep]]")[0]
    for point in points:
        pairs = [setting.split("=") for setting in point.split(",")]
        study += "[[sweep]]\n" + "".join(f'{key} = {value if value[0].isdigit() else json.dumps(value)}\n' for key, value in pairs)
    file = work / f"{name}-times.toml"
    file.write_text(study)
    folder = work / f"{name}-times"
    run(tool, "--study", file, "--output", folder, "--repeats", repeats, "--no-instructions", "--quiet")
    with open(folder / "times.csv", newline="", encoding="utf-8") as table_of_times:
        return {row["point"]: row["least"] for row in csv.DictReader(table_of_times)}


def rows_of(name):
    with open(STUDIES / f"{name}.csv", newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def gate():
    """[(study, point)]: what `--check` runs anew, a few seconds of it: each scheme on the large bar, four of them elsewhere."""
    chosen = []
    for name in NAMES:
        rows = [row for row in rows_of(name) if row["cells"] == "16" and "courant=0.1" in row["point"].split(",")]
        for scheme in dict.fromkeys(row["scheme"] for row in rows) if name == "bar-large" else AMONG:
            chosen.append((name, next(row["point"] for row in rows if row["scheme"] == scheme)))
    chosen += [("scaling", f"scheme={scheme},cells=25") for scheme in AMONG]
    return chosen + [("ladder", row["point"]) for row in rows_of("ladder")[1:3]]


def cheapest(rows, field, error):
    """The row that reaches the error with the fewest instructions, or None."""
    there = [row for row in rows if row["status"] == "ok" and row["instructions"] and float(row[f"{field}_relative_l2"]) <= error]
    return min(there, key=lambda row: int(row["instructions"]), default=None)


def setting(row):
    """What of a point is not the same everywhere: p, cells, integrator, Courant number."""
    said = dict(part.split("=") for part in row["point"].split(","))
    integrator = f", {said['time_integrator']}" if "time_integrator" in said else ""
    return f"`{row['scheme']}` p = {row['degree']}, {row['cells']} cells{integrator}, C = {said['courant']}"


def count(value):
    """Three digits with a unit: 1.23 M."""
    for unit, size in (("G", 1e9), ("M", 1e6), ("k", 1e3)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value:.0f}"


def ratio(value):
    """Two digits, never as a power of ten."""
    return f"{value:.2g}" if value < 1 else f"{value:.1f}" if value < 10 else f"{float(f'{value:.2g}'):.0f}"


def time_to_accuracy(name):
    rows = rows_of(name)
    schemes = list(dict.fromkeys(row["scheme"] for row in rows))
    lines = []
    for field in ("displacement", "stress"):
        table_rows = []
        for error in ERRORS:
            best = cheapest(rows, field, error)
            if best is None:
                break
            words = []
            for scheme in schemes:
                own = cheapest([row for row in rows if row["scheme"] == scheme], field, error)
                words.append(ratio(int(own["instructions"]) / int(best["instructions"])) if own else "–")
            milliseconds = ratio(1e3 * float(best["seconds"])) if best["seconds"] else ""
            table_rows.append([f"{error:.0e}".replace("e-0", "e-"), setting(best), count(int(best["instructions"])), milliseconds, *words])
        header = ["error", "cheapest", "instructions", "ms", *(f"`{scheme}`" for scheme in schemes)]
        lines += ["", f"Relative L2 error of the {field}; the last columns: instructions over those of the cheapest.", "",
                  *table(header, table_rows, range(2, len(header)))]
    failed = sum(row["status"] != "ok" for row in rows)
    return [*lines[1:], "", f"{len(rows)} points, {failed} of them failed: crosses at the upper edge."]


def step_cost():
    """Instructions per particle and step of the large bar, by scheme and degree, with 2 particles per cell and 64 cells."""
    kinds = {}
    for row in rows_of("bar-large"):
        integrator = re.search(r"time_integrator=([\w-]+)", row["point"])
        kind = (row["scheme"], row["degree"], integrator.group(1) if integrator else "euler-cromer")
        if row["cells"] == "64" and row["instructions"]:
            kinds.setdefault(kind, float(row["instructions_per_particle_and_step"]))
    return table(["scheme", "p", "integrator", "instructions per particle and step"],
                 [[f"`{scheme}`", degree, integrator, f"{value:.0f}"] for (scheme, degree, integrator), value in kinds.items()], (1, 3))


def ladder():
    rows = rows_of("ladder")
    own = [float(row["instructions_per_particle_and_step"]) for row in rows]
    said = [set(row["point"].split(",")) for row in rows]
    new = ["tielen2017", *((after - before).pop() for before, after in zip(said, said[1:]))]
    names = [f"`{choice.replace('=', ' = ')}`" if "rate" not in choice else "`relaxation_rate`" for choice in new]
    return table(["change", "instructions per particle and step", "over `tielen2017`", "error in u", "error in σ"],
                 [[name, f"{cost:.0f}", f"{cost / own[0]:.2f}", *(short(float(row[f"{field}_relative_l2"])) for field in ("displacement", "stress"))]
                  for name, cost, row in zip(names, own, rows)], range(1, 5))


def scaling():
    rows = rows_of("scaling")
    schemes = list(dict.fromkeys(row["scheme"] for row in rows))
    counts = list(dict.fromkeys(row["particles"] for row in rows))
    by_kind = {(row["scheme"], row["particles"]): float(row["instructions_per_particle_and_step"]) for row in rows}
    return table(["particles", *(f"`{scheme}`" for scheme in schemes)],
                 [[number, *(f"{by_kind[scheme, number]:.0f}" for scheme in schemes)] for number in counts], range(len(schemes) + 1))


def goals():
    rows = rows_of("bar-large")
    best = cheapest(rows, "displacement", 1e-4)
    own = cheapest([row for row in rows if row["scheme"] == "tielen2017"], "displacement", 1e-4)
    fine = cheapest(rows, "displacement", 1e-8)
    milliseconds = f", {ratio(1e3 * float(fine['seconds']))} ms" if fine["seconds"] else ""
    return [f"- Large bar, displacement to 1e-4: {setting(best)}, {count(int(best['instructions']))} instructions; "
            f"`tielen2017` needs {ratio(int(own['instructions']) / int(best['instructions']))} times as many.",
            f"- Large bar, displacement to 1e-8: {setting(fine)}, {count(int(fine['instructions']))} instructions{milliseconds}; "
            f"its error is {short(float(fine['displacement_relative_l2']))}."]


def what_is_tested():
    points = sum(len(rows_of(name)) for name in ALL)
    return [f"These numbers are a gate: the tests run {len(gate())} of the {points} points of this page anew, and fail when one takes 0.5 % more or fewer",
            "instructions, has another error, or when a study has other points: a new row of the table of schemes is one of its schemes."]


PARTS = {**{name: lambda name=name: time_to_accuracy(name) for name in NAMES}, "ladder": ladder, "steps": step_cost, "scaling": scaling, "goals": goals, "gate": what_is_tested}
PART = re.compile(r"<!-- generated by docs/make_study\.py: (\S+) -->\n(.*?)<!-- end of \1 -->", re.DOTALL)


def renewed(text):
    def renew(match):
        name = match.group(1)
        lines = "\n".join(PARTS[name]())
        return f"<!-- generated by docs/make_study.py: {name} -->\n{lines}\n<!-- end of {name} -->"

    return PART.sub(renew, text)


def missing_points(tool):
    """Complaints about studies whose points are others now: a new row of the table of schemes makes some."""
    for name in ALL:
        listed = run(tool, "--study", STUDIES / f"{name}.toml", "--list").split()
        known = [row["point"] for row in rows_of(name)]
        for point in sorted(set(listed) ^ set(known))[:3]:
            yield f"docs/studies/{name}.csv {'lacks' if point in listed else 'still has'} {point}"


def stale_points(tool, same_compiler):
    """Complaints about points of the subset that give other numbers now."""
    def look(task):
        name, point, folder = task
        known = next((row for row in rows_of(name) if row["point"] == point), None)
        if known is None:
            return [f"docs/studies/{name}.csv has no point {point}"]
        run(tool, "--study", STUDIES / f"{name}.toml", "--output", folder, "--point", point, *([] if same_compiler else ["--no-instructions"]))
        record = json.loads((pathlib.Path(folder) / "points" / f"{point}.json").read_text())
        complaints = []
        for field in FIELDS:
            error = record["errors"][field]["relative_l2"]
            if error != float(known[f"{field}_relative_l2"]):
                complaints.append(f"{name}, {point}: the error in {field} is now {error}, not {known[f'{field}_relative_l2']}")
        if same_compiler:
            now = record["instructions"]["total"]
            change = now / int(known["instructions"]) - 1
            if abs(change) > TOLERANCE:
                complaints.append(f"{name}, {point}: {now} instructions, {100 * change:+.2f} % of what docs/studies says")
        return complaints

    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        tasks = [(name, point, f"{folder}/{name}") for name, point in gate()]
        return [complaint for complaints in pool.map(look, tasks) for complaint in complaints]


def check(tool, quick):
    complaints = []
    text = PAGE.read_text()
    if renewed(text) != text:
        complaints.append("docs/accuracy-cost.md does not say what docs/studies/*.csv say")
    complaints += [f"make_study: the part {name} stands in no file" for name in PARTS if f"make_study.py: {name} " not in text]
    complaints += missing_points(tool)
    if quick:
        return complaints
    known = (STUDIES / "compiler.txt").read_text().strip()
    here = compiler(tool)
    if known != here:
        print(f"instructions are passed over: they are of {known}, here is {here}")
    complaints += stale_points(tool, known == here)
    return complaints


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("--tool", type=pathlib.Path, default=ROOT / "build/release/bin", help="folder of hompm-study")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "build/study", help="where the studies are run")
    parser.add_argument("--repeats", type=int, default=5, help="wall-clock times per point")
    parser.add_argument("--check", action="store_true", help="write nothing; fail when the page is stale")
    parser.add_argument("--quick", action="store_true", help="with --check: run no point anew")
    arguments = parser.parse_args()
    tool = arguments.tool.resolve()
    if arguments.check:
        complaints = check(tool, arguments.quick)
        for complaint in complaints:
            print(complaint, file=sys.stderr)
        if complaints:
            print("docs/make_study.py writes docs/accuracy-cost.md anew, in about ten minutes", file=sys.stderr)
        return 1 if complaints else 0
    for name in ALL:
        make_study(tool, name, arguments.work, arguments.repeats)
        print(f"docs/studies/{name}.csv: written anew")
    (STUDIES / "compiler.txt").write_text(compiler(tool) + "\n")
    PAGE.write_text(renewed(PAGE.read_text()))
    return 0


if __name__ == "__main__":
    sys.exit(main())
