"""The generated parts of docs/high-order.md."""
import concurrent.futures
import functools
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

import cut_span
from table_tools import error_of, order, settled_scene, short, table

HIGH_ORDER = ["--scheme", "high-order"]
FINE_STEP = ["--courant", "0.2", "--set", "scheme.time_integrator=blanes-moan"]
BAR = ["--case", "bar", "--variant", "large", "--end-time", "4"]
COLUMN = ["--case", "column", "--variant", "large"]
RAMPED = [*COLUMN, "--set", "effect.gravity.ramp_time=0.5", "--end-time", "1"]
WEIGHT = 1000.0 * 9.81 * 1.0  # ρ g H of the settled column, Pa

# From tielen2017 to high-order: what each step sets, and what that gains.
LADDER = [
    (None, "where it starts"),
    ("time_integrator=leapfrog", "second order in time"),
    ("stress_update=from-positions", "no drift of the stress"),
    ("markers=true", "data up to the ends"),
    ("free_end=extension", "a step that no cut spoils"),
    ("acceleration_mass=consistent", "order p + 1"),
    ("quadrature=reconstructed-exact", "order p + 1 for p ≥ 4"),
    ("velocity_projection=least-squares", "an idempotent projection"),
    ("transfer=pic", "no hidden velocity"),
    ("relaxation_rate", "no hidden displacement"),
]
LADDER_RUNS = {"bar": [*BAR, "--time-step", "2.5e-4"], "column": [*RAMPED, "--cells", "32", "--step-fraction", "0.5"]}


def at_step(tools, case, count):
    """The options after `count` choices; the rate of the last is what high-order takes by itself."""
    options = [*LADDER_RUNS[case], "--scheme", "tielen2017", "--degree", "3"]
    for key, _ in LADDER[1:count + 1]:
        if key == "relaxation_rate":
            scene = tomllib.loads((tools.report(*LADDER_RUNS[case], *HIGH_ORDER, "--degree", 3)[1] / "scene.toml").read_text())
            key = f"relaxation_rate={scene['scheme']['relaxation_rate']!r}"
        options += ["--set", f"scheme.{key}"]
    return options


def run_or_failure(tools, options):
    """(run.json, folder), or the time at which the run ceased to be valid."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=tools.work))
    done = subprocess.run([tools.run_tool, *map(str, options), "--no-vtk", "--json", "--output", folder],
                          capture_output=True, text=True, check=False, cwd=tools.work)
    if done.returncode == 0:
        return json.loads(done.stdout), folder
    failed = re.search(r"invalid at step \d+, t = (\S+) s", done.stderr)
    if not failed:
        sys.exit(done.stderr)
    return f"fails at t = {float(failed.group(1)):.2g}", None


def choice_name(count):
    key = LADDER[count][0]
    return f"`{key.replace('=', ' = ')}`" if key else "`tielen2017`"


def ladder(tools):
    """A row for each choice; the last must be high-order to the byte."""
    jobs = [(case, at_step(tools, case, count)) for count in range(len(LADDER)) for case in LADDER_RUNS]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        results = list(pool.map(lambda job: run_or_failure(tools, job[1]), jobs))
    for (case, _), (_, folder) in list(zip(jobs, results))[-2:]:
        named = tools.report(*LADDER_RUNS[case], *HIGH_ORDER, "--degree", 3)[1]
        for name in ("particles.csv", "stress.csv", "history.csv"):
            if (named / name).read_bytes() != (folder / name).read_bytes():
                sys.exit(f"make_tables: after the last choice the scheme is not high-order: {case}, {name}")
    rows = []
    for count, (_, gain) in enumerate(LADDER):
        (bar, _), (column, folder) = results[2 * count:2 * count + 2]
        errors = [short(error_of(bar, field)) for field in ("displacement", "velocity", "stress")]
        errors += [short(error_of(column, field)) for field in ("displacement", "stress")] if folder else [column, "–"]
        rows.append([choice_name(count), gain, *errors, f"{bar['critical_time_step'] * 10.0 / (25.0 / 64):.3f}"])
    return table(["change", "what it buys", "bar: u", "bar: v", "bar: σ", "column: u", "column: σ", "c Δt/h"], rows, range(2, 8))


def orders(errors):
    """Each error, and the order since the one before; words stand for runs without an error."""
    words = []
    for before, error in zip([None, *errors], errors):
        known = not isinstance(error, str)
        words += [short(error) if known else error, order(before, error) if known and isinstance(before, float) else ""]
    return words


def convergence(tools, cells, runs, words, fields):
    """For each (title, function of a report) in `fields` a table: numbers of cells against the columns called `words`."""
    def error(value, report):
        return report if isinstance(report, str) else value(report) if report["errors"]["reference"] else "not at rest"

    options = [tuple(map(str, run)) for run in sum(runs, [])]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        reports = dict(zip(options, pool.map(lambda run: run_or_failure(tools, run)[0], options)))
    lines = []
    for title, value in fields:
        columns = [orders([error(value, reports[tuple(map(str, run))]) for run in column]) for column in runs]
        rows = [[count, *(word for column in columns for word in column[2 * i:2 * i + 2])] for i, count in enumerate(cells)]
        header = ["cells", *(text for word in words for text in (word, "order"))]
        lines += ["", title, "", *table(header, rows, range(len(header)))]
    return lines[1:]


def worst_stress(report):
    return report["errors"]["stress"]["max"] / WEIGHT


def settled(tools, modulus=1e4, step_fraction=0.55, degrees=(2, 3, 4, 5)):
    settled_scene(tools)
    cells = [8, 16, 32, 64]
    runs = [[["--scene", "settled.toml", "--degree", p, "--cells", n, "--step-fraction", step_fraction, "--end-time", "10",
              "--set", "rest.speed=1e-12", "--set", f"material.youngs_modulus={modulus}"] for n in cells] for p in degrees]
    return convergence(tools, cells, runs, [f"p = {p}" for p in degrees], [
        ("Relative L2 error of the displacement:", lambda report: error_of(report, "displacement")),
        ("Worst stress error over ρgH:", worst_stress)])


def ramped(tools):
    cells = [8, 16, 32, 64]
    runs = [[[*RAMPED, *HIGH_ORDER, *FINE_STEP, "--degree", p, "--cells", n] for n in cells] for p in (2, 3, 4, 5)]
    return convergence(tools, cells, runs, [f"p = {p}" for p in (2, 3, 4, 5)], [
        (f"Relative L2 error of the {field}:", functools.partial(error_of, field=field)) for field in ("displacement", "stress")])


def flip(tools):
    """Energy residual by FLIP and PIC against the step: what a drift that is not symmetric in time feeds."""
    steps = ["0.38", "0.32", "0.25", "0.19", "0.16"]
    rows = []
    for transfer in ("flip", "pic"):
        reports = tools.reports([[*COLUMN, *HIGH_ORDER, "--degree", 2, "--cells", 128, "--end-time", 20, "--courant", step,
                                  "--set", f"scheme.transfer={transfer}"] for step in steps])
        rows.append([f"`{transfer}`", *(short(report["energy"]["largest_residual"]) for report in reports)])
    return table(["c Δt/h", *steps], rows, range(1, 6))


def long_runs(tools):
    """100 s of the undamped column: balances. The longest take minutes."""
    degrees, rows = (2, 3, 4), []
    steps = {2: "0.32", 3: "0.26", 4: "0.2"}
    kinds = [(cells, per_cell) for cells in (8, 16, 32, 64, 128) for per_cell in (2, 4, 8)]
    runs = [[*COLUMN, *HIGH_ORDER, "--degree", p, "--cells", cells, "--particles-per-cell", per_cell, "--courant", steps[p],
             "--end-time", "100"] for cells, per_cell in kinds for p in degrees]
    reports = iter(tools.reports(runs))
    for cells, per_cell in kinds:
        of = [next(reports) for _ in degrees]
        numbers = [report["energy"]["largest_residual"] for report in of] + [report["energy"]["dissipated"] for report in of]
        numbers += [report["momentum"]["largest_residual"] for report in of]
        rows.append([cells, per_cell, *(f"{number:.1e}".replace("e+00", "").replace("e-0", "e-").replace("-", "−", 1 if number < 0 else 0)
                                        for number in numbers)])
    header = ["cells", "particles per cell", *(f"{word}, p = {p}" for word in ("energy", "dissipated", "momentum") for p in degrees)]
    return table(header, rows, range(len(header)))


def conservation(tools):
    cells = [16, 32, 64]
    rows = []
    for kept in ("nothing", "momentum", "cell-mass"):
        reports = tools.reports([[*BAR, *HIGH_ORDER, *FINE_STEP, "--cells", n, "--set", f"scheme.conserve={kept}"] for n in cells])
        for report, words in zip(reports, zip(*[iter(orders([error_of(report, "displacement") for report in reports]))] * 2)):
            residual = report["momentum"]["largest_residual"]
            rows.append([f"`{kept}`", report["cells"], "rounding" if residual < 1e-11 else short(residual), *words])
    return table(["`conserve`", "cells", "momentum residual", "u", "order"], rows, range(1, 5))


CUTS = [1.0, 0.5, 0.1, 1e-2, 1e-3, 1e-6, 1e-12]


def cut_spans(_tools):
    degrees = (2, 3, 4)
    known = {(cut, extended, p): cut_span.cut_span(p, cut, extended) for cut in CUTS for extended in (True, False) for p in degrees}
    lines = []
    for which, title in enumerate(("Critical step c Δt/h:", "Condition number of the mass:")):
        rows = [[short(cut), *(short(known[cut, extended, p][which]) for extended in (True, False) for p in degrees)] for cut in CUTS]
        header = ["ε", *(f"{words}, p = {p}" for words in ("extension", "cut span") for p in degrees)]
        lines += ["", title, "", *table(header, rows, range(7))]
    return lines[1:]


PARTS = {"ladder": ladder, "settled": settled, "squeezed": lambda tools: settled(tools, 2452.5, 0.3, (2, 3)),
         "ramped": ramped, "conservation": conservation, "cut-span": cut_spans}
SLOW_PARTS = {"flip": flip, "long-runs": long_runs}
