"""The parts of docs/verification.md: errors and orders of all schemes on the manufactured solution."""
import concurrent.futures
import json
import math
import os
import pathlib
import subprocess
import sys
import tempfile

from table_tools import ROOT, short, table

CELLS = [4, 8, 16, 32, 64, 128, 256]
AMPLITUDES = {"small": 1e-4, "large": 0.05}  # G over L
PER_CELL = [2, 4]
SCENE = ROOT / "docs/scenes/manufactured.toml"
# The order in space is looked for: time by leapfrog, of high-order by its method of fourth order; halving these steps changes no figure but the last.
STEPS = {"high-order": ["--courant", "0.2", "--set", "scheme.time_integrator=blanes-moan"]}
OTHER_STEPS = ["--courant", "0.05", "--set", "scheme.time_integrator=leapfrog"]
INVALID = (math.inf, math.inf)


def run(tools, scheme, amplitude, per_cell, cells):
    """Relative L2 errors of displacement and stress."""
    folder = pathlib.Path(tempfile.mkdtemp(dir=tools.work))
    done = subprocess.run([tools.run_tool, "--scene", SCENE, "--scheme", scheme, "--cells", str(cells), *STEPS.get(scheme, OTHER_STEPS), "--end-time", "0.08",
                           "--set", f"scheme.particles_per_cell={per_cell}", "--set", f"effect[0].amplitude={amplitude:g}",
                           "--set", "output.snapshots=1", "--set", "output.history=1", "--no-vtk", "--json", "--output", folder],
                          capture_output=True, text=True, check=False)
    if done.returncode == 4 or "no step is stable" in done.stderr:
        return INVALID
    if done.returncode != 0:
        sys.exit(f"verification: {scheme}: {done.stderr.strip()}")
    errors = json.loads(done.stdout)["errors"]
    return errors["displacement"]["relative_l2"], errors["stress"]["relative_l2"]


def measure(tools, schemes):
    """{(scheme, amplitude, particles per cell): [(displacement, stress) for each number of cells]}"""
    if not hasattr(tools, "verification"):
        keys = [(scheme, name, per_cell) for scheme in schemes for name in AMPLITUDES for per_cell in PER_CELL]
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            runs = {key: [pool.submit(run, tools, key[0], AMPLITUDES[key[1]], key[2], cells) for cells in CELLS] for key in keys}
        tools.verification = {key: [future.result() for future in futures] for key, futures in runs.items()}
    return tools.verification


def order(before, now):
    return math.log2(before / now)


def words(errors):
    """Each error, and in brackets the order from the one before."""
    cells, before = [], math.inf
    for error in errors:
        if math.isinf(error):
            cells.append("–")
        else:
            cells.append(short(error) + (f" ({order(before, error):.1f})".replace("-", "−") if not math.isinf(before) else ""))
        before = error
    return cells


def part(name, field):
    def lines(tools):
        schemes = tools.schemes()
        measured = measure(tools, schemes)
        rows = [[f"`{scheme}`", per_cell, *words([errors[field] for errors in measured[scheme, name, per_cell]])]
                for scheme in schemes for per_cell in PER_CELL]
        return table(["scheme", "particles per cell", *CELLS], rows, range(1, 2 + len(CELLS)))
    return lines


def claims(schemes, measured):
    """(what the literature says, whether it is seen)"""
    def errors(scheme, name, field=0, per_cell=4):
        return [pair[field] for pair in measured[scheme, name, per_cell]]

    def last_order(of):
        return order(of[-2], of[-1]) if not math.isinf(of[-2]) else -math.inf

    def falls(of):
        return all(now < before for before, now in zip(of, of[1:]))

    for scheme in schemes:
        # What floors these is explained in verification.md.
        cells = CELLS[:5] if scheme in ("classical", "mixed") else CELLS
        yield (f"small displacements: `{scheme}` is of second order at least, at {cells[-1]} cells",
               all(last_order(errors(scheme, "small", 0, per_cell)[:len(cells)]) > 1.85 for per_cell in PER_CELL))
    large = {scheme: errors(scheme, "large") for scheme in schemes}
    yield "large: `classical` gets worse with refinement", large["classical"][-1] > large["classical"][2]
    for scheme in ("bspline", "ugimp", "ddmp", "apic"):
        yield f"large: `{scheme}`, which integrates by particles with gaps and overlaps, stalls", last_order(large[scheme]) < 1.0
    yield "large: `mixed`, whose stress in a cell is a mean that jumps when a particle crosses, stalls", last_order(large["mixed"]) < 1.0
    for scheme in ("cpgimp", "cpdi", "total-lagrangian", "tielen2017", "mls", "tls", "high-order"):
        yield f"large: the displacement of `{scheme}` falls with every refinement, and keeps its order", falls(large[scheme]) and last_order(large[scheme]) > 1.6


def seen(tools):
    schemes = tools.schemes()
    found = list(claims(schemes, measure(tools, schemes)))
    for claim, holds in found:
        if not holds:
            print(f"verification: not seen: {claim}", file=sys.stderr)
    return table(["what is expected", "seen"], [[claim, "yes" if holds else "**no**"] for claim, holds in found])


PARTS = {f"verification-{name}-{word}": part(name, field) for name in AMPLITUDES for field, word in enumerate(("displacement", "stress"))} | {
    "verification-seen": seen}
