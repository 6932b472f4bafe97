#!/usr/bin/env python3
"""Draws the pictures of docs/pictures anew, from runs.

    docs/make_pictures.py [--tool build/release/bin] [--check] [--tables] [--only NAME ...]

Beside each SVG a PNG is written, for those whose viewer draws gnuplot's SVG wrongly. With --tables the parts of docs/make_tables.py,
too: many come from the same runs.

With --check nothing is written: the exit code is 1 when a picture is stale. Another version of gnuplot draws other bytes; a
picture by another version is then passed over, with a note.
"""
import argparse
import csv
import pathlib
import re
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
import hard_cases  # noqa: E402
import make_tables  # noqa: E402
from cut_span import cut_span as exact_cut_span  # noqa: E402
from picture_tools import curve, decades, page, panel, stroke  # noqa: E402

PICTURES = make_tables.ROOT / "docs/pictures"
FOUR = make_tables.SCHEMES
GREY = stroke("#BBBBBB", 1)
BLACK = stroke("#000000", 1)


def read(path, **wanted):
    """Rows of a table as numbers, those with a column near a value."""
    with open(path, newline="", encoding="ascii") as file:
        rows = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    return [row for row in rows if all(abs(row[name] - value) < 1e-9 for name, value in wanted.items())]


def drawn_by_tool(name):
    """What hompm-run or hompm-diff itself draws, as SVG and PNG."""
    def draw(tools, terminal):
        command = COMMANDS[name].replace("FILE", f"{name}.{terminal}").split()
        command += ["--errors", "full"] if command[0] == "hompm-run" else []  # also where the machine is busy
        subprocess.run([tools.run_tool.parent / command[0], *command[1:]], check=False, capture_output=True, cwd=tools.work)
        return ""
    return draw


COMMANDS = {
    "column": "hompm-run --case column --picture FILE",
    "column-xt": "hompm-run --case column --scheme high-order --end-time 0.8 --picture-xt FILE",
    "comparing": "hompm-diff --quiet --time 1.25 --picture FILE golden/bar-small-classical/stress.csv golden/bar-small-bspline",
}


def bar_large(tools, terminal):
    """Errors of the large bar against the number of cells, with lines of second and higher order."""
    reports = make_tables.study(tools, "bar-large")
    panels = []
    for field in ("displacement", "stress"):
        curves = [curve(scheme, look_of(tools, scheme, 1.5, 0.5), [(report["cells"], make_tables.error_of(report, field)) for report in reports[scheme]])
                  for scheme in FOUR]
        for scheme, slope, dash in (("tielen2017", 2, 2), ("high-order", 4 if field == "displacement" else 3, 3)):
            beside = 0.4 * make_tables.error_of(reports[scheme][2], field)
            curves.append(curve(f"order {slope}", stroke("#606060", 1.2, dash if slope != 4 else 4), [(x, beside * (64 / x) ** slope) for x in (64, 256)]))
        panels.append(panel(field, "cells", "relative L2 error", curves, "set logscale x 2\nset xrange [13:310]\nset yrange [1e-12:1]\nset xtics (16, 32, 64, 128, 256)\n", True))
    return page("Large bar, t = 4 s, 4 particles per cell; high-order with p = 3", panels, 2, 415, 290, terminal)


def column_settled(tools, terminal):
    """Particle stresses over the height of the settled column, and the closed form."""
    panels, moving = [], []
    particles = curve("particles", stroke(size=0.5), [])
    for scheme in FOUR:
        report, folder = tools.report("--case", "column", "--variant", "settled", "--scheme", scheme)
        rows = [(row["stress"] / 1000, row["X"]) for row in read(folder / "stress.csv", time=report["end_time"])]
        moving += [] if report["at_rest"] else [scheme]
        # σ = −ρ0 g (H − X) is a straight line
        panels.append(panel(f"{scheme}, t = {report['end_time']:.3g} s", "σ, kPa", "X, m", [particles, curve("", look_of(tools, scheme, 0, 0.3), rows), curve("exact", stroke("#000000", 0.8), [(-9.81, 0), (0, 1)])],
                            "set xrange [-12:2]\nset yrange [0:1]\nset xtics -10,5,0\n"))
    return page(f"Settled column, 32 cells of 4 particles; not at rest: {', '.join(moving) or 'none'}", panels, 4, 207, 290, terminal)


def cut_span(_tools, terminal):
    """Critical step and condition of the mass against the fraction of the last span that is filled."""
    colours = {2: "#0072B2", 3: "#CC79A7", 4: "#009E73"}
    cuts = [10.0 ** (-k / 2) for k in range(25)]
    panels = []
    for column, title in enumerate(("critical step c Δt/h", "condition number of the mass")):
        curves = [curve(f"p = {degree}, {'with' if extended else 'without'} extension", stroke(colour, 1.5, 1 if extended else 2),
                        [(cut, float(exact_cut_span(degree, cut, extended)[column])) for cut in cuts])
                  for degree, colour in colours.items() for extended in (True, False)]
        panels.append(panel(title, "filled part ε of the last span", title, curves,
                            'set logscale x\nset xrange [1:1e-12] reverse\nset format x "10^{%T}"\nset xtics (1, "10^{-3}" 1e-3, "10^{-6}" 1e-6, "10^{-9}" 1e-9, "10^{-12}" 1e-12)\n' + ("set yrange [1e-12:10]\n", "set yrange [1:1e20]\n")[column], True))
    return page("A free end inside a span of the splines", panels, 2, 415, 290, terminal)


def limit_cut(tools, terminal):
    """Critical step against the filled part of the last span."""
    curves = [curve(f"{scheme}, p = {degree}", look_of(tools, scheme, 1.5, 0.4) | {"dash": dash}, make_tables.limit_cuts(tools, scheme, degree))
              for scheme, degree, dash in (("bspline", 1, 1), ("bspline", 2, 2), ("tielen2017", 1, 1), ("tielen2017", 2, 2), ("high-order", 2, 1), ("high-order", 3, 2))]
    return page("Critical step of a free end inside a span", [panel("", "filled part ε of the last span", "critical step c Δt/h", curves, "set xrange [0:0.92]\nset yrange [0:2.5]\n")], 1, 620, 330, terminal)


def in_front(tools, curves_of, rest):
    """Four schemes in colour before the rest in grey, which has one title."""
    others = [scheme for scheme in tools.schemes() if scheme not in FOUR]
    return [one for scheme in [*others, *FOUR] for one in curves_of(scheme, scheme in FOUR, scheme if scheme in FOUR else rest)]


def long_run(tools, terminal):
    """Energy over a thousand periods of the small bar."""
    panels = []
    for law, limits in (("linear", "[0.7:1.2]"), ("rate", "[0:9]")):
        def curves(scheme, front, title, law=law):
            rows = [(round(time), energy) for time, energy in make_tables.long_bar(tools, scheme, law)[::4]]
            return [curve(title, look_of(tools, scheme, 1.5) if front else GREY, rows)]
        panels.append(panel(f"law {law}", "t, s", "energy over that at the start", in_front(tools, curves, "the other schemes"),
                            f"set xrange [0:5000]\nset xtics 1000\nset yrange {limits}\n"))
    return page("Energy of the small bar over a thousand periods, 16 cells of 4 particles, half the critical step", panels, 2, 415, 290, terminal)


def accuracy_cost(name):
    """Fronts of error against instructions of a study, of its numbers in docs/studies."""
    def draw(tools, terminal):
        with open(make_tables.ROOT / f"docs/studies/{name}.csv", newline="", encoding="utf-8") as file:
            rows = [row for row in csv.DictReader(file)]
        there = [row for row in rows if row["status"] == "ok" and row["instructions"]]
        panels = []
        fields = ("displacement", "velocity", "stress")
        ranges = decades("y", [float(row[f"{field}_relative_l2"]) for row in there for field in fields])
        for field in fields:
            def front(points):
                best = []
                for cost, error in sorted(points):
                    if not best or error < best[-1][1]:
                        best.append((cost, error))
                return best

            def points(scheme, field=field):
                return [(float(row["instructions"]), float(row[f"{field}_relative_l2"])) for row in there if scheme in ("", row["scheme"])]

            def curves(scheme, in_colour, title):
                look = look_of(tools, scheme, 1.5, 0.5) if in_colour else GREY
                return ([curve("", stroke(look["colour"], size=0.2), points(scheme))] if in_colour else []) + [curve(title, look, front(points(scheme)))]
            best = curve("best of all", stroke("#E4E4E4", 8), front(points("")))
            panels.append(panel(field, "instructions", "relative L2 error", [best, *in_front(tools, curves, "front of another scheme")],
                                decades("x", [float(row["instructions"]) for row in there]) + ranges))
        title = f"{name.replace('-', ' ').capitalize()}: {len(rows)} settings, each a dot; lines: front of a scheme; {len(rows) - len(there)} that fail are not drawn"
        return page(title, panels, 3, 276, 300, terminal)
    return draw


def basis(degree, knots, i, x):
    """B-spline i at x, by Cox and de Boor."""
    if degree == 0:
        return 1.0 if knots[i] <= x < knots[i + 1] or (x == knots[-1] and knots[i] < x == knots[i + 1]) else 0.0
    left, right = knots[i + degree] - knots[i], knots[i + degree + 1] - knots[i + 1]
    return ((x - knots[i]) / left * basis(degree - 1, knots, i, x) if left else 0.0) + ((knots[i + degree + 1] - x) / right * basis(degree - 1, knots, i + 1, x) if right else 0.0)


COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#332288"]


def spline_basis(_tools, terminal):
    """The functions of an open knot vector, over four cells."""
    panels = []
    for degree in (1, 2, 3):
        knots = [0.0] * degree + [0.0, 1.0, 2.0, 3.0, 4.0] + [4.0] * degree
        curves = [curve("", stroke(COLOURS[i], 1.5), [(k / 40, basis(degree, knots, i, k / 40)) for k in range(161)]) for i in range(4 + degree)]
        ends = [curve("knot", stroke("#000000", size=0.5), [(k, 0.0) for k in range(5)])]
        panels.append(panel(f"p = {degree}, {4 + degree} functions", "x/h", "N", curves + ends, "set yrange [-0.02:1.05]\nset xrange [-0.1:4.1]\nset xtics 1\n"))
    return page("B-splines on four cells, open knot vector: the first and the last are 1 at the ends", panels, 3, 276, 230, terminal)


def crossing(_tools, terminal):
    """Hat function and quadratic B-spline around the node that a particle passes, their gradients, and the force on the node."""
    hat = lambda x: max(0.0, 1.0 - abs(x))  # noqa: E731
    steps = [k / 50 for k in range(-90, 91)]
    uniform = [float(k) for k in range(-6, 7)]
    spline = lambda x: basis(2, uniform, 4, x + 0.0) if -2.0 <= x <= 1.0 else 0.0  # noqa: E731
    centred = lambda x: spline(x - 0.5)  # noqa: E731  - from −1.5 to 1.5
    slope = lambda x: (centred(x + 1e-6) - centred(x - 1e-6)) / 2e-6  # noqa: E731
    hats, smooth = stroke("#D55E00", 1.5), stroke("#0072B2", 1.5)
    pieces = [(-1.8, -1.0, 0.0), (-1.0, 0.0, 1.0), (0.0, 1.0, -1.0), (1.0, 1.8, 0.0)]

    def jumps(values):
        return [curve("hat function" if i == 0 else "", hats, [(a, value), (b, value)]) for i, (a, b, value) in enumerate(values)]
    names = [curve("hat function", hats, [(x, hat(x)) for x in steps]), curve("B-spline, p = 2", smooth, [(x, centred(x)) for x in steps])]
    gradients = [*jumps(pieces), curve("B-spline, p = 2", smooth, [(x, slope(x)) for x in steps])]
    # Two particles of the same stress and volume, h/2 apart, walk to the right: f = −Σ V σ ∂N/∂x.
    walk = [k / 400 for k in range(-399, 400)]
    def force(gradient, x):
        return -0.5 * (gradient(x - 0.25) + gradient(x + 0.25))
    hat_slope = lambda x: 0.0 if abs(x) >= 1.0 else 1.0 if x < 0.0 else -1.0  # noqa: E731
    forces = [curve("", hats, [(x, force(hat_slope, x)) for x in walk]), curve("", smooth, [(x, force(slope, x)) for x in walk])]
    return page("A particle passes the node at x = 0: the gradient of its hat function jumps, and with it the force",
                [panel("function of the node", "x/h", "N", names, "set yrange [0:1.05]\nset xtics 1\n"),
                 panel("its gradient", "x/h", "h ∂N/∂x", gradients, "set yrange [-1.2:1.2]\nset xtics 1\n"),
                 panel("force of two particles, h/2 apart", "middle of the two, x/h", "f/(V σ/h)", forces, "set yrange [-1.2:1.2]\nset xrange [-1:1]\nset xtics 0.5\n")], 3, 276, 250, terminal)


def steps_of_mpm(_tools, terminal):
    """Four phases of a step."""
    nodes, before, after = [0.0, 1.0, 2.0, 3.0], [0.3, 0.8, 1.25, 1.7, 2.2, 2.7], [0.42, 0.95, 1.45, 1.92, 2.4, 2.85]
    moved = [0.0, 1.25, 2.3, 3.25]
    def arrows(pairs):
        return "".join(f"set arrow from {a[0]},{a[1]} to {b[0]},{b[1]} head size 0.08,20 filled linewidth 0.8 linecolor rgb '#606060'\n" for a, b in pairs)
    def near(x):
        return [node for node in nodes if abs(node - x) < 1.0]
    up = [((x, 1), (node, 0.06)) for x in before for node in near(x)]
    down = [((moved[int(node)], 0.06), (x, 0.94)) for x, start in zip(after, before) for node in near(start)]
    accelerated = [((node, 0), (there, 0)) for node, there in zip(nodes[1:], moved[1:])]
    carried = [((a, 1), (b - 0.03, 1)) for a, b in zip(before, after)]
    frames = [("particles to grid: mass, momentum, forces", before, nodes, up),
              ("on the grid: acceleration and velocity of the nodes", before, nodes, accelerated),
              ("grid to particles: velocity, strain, position", after, moved, down + carried),
              ("the grid is laid anew", after, nodes, [])]

    panels = []
    for title, particles, grid, pairs in frames:
        curves = [curve("", stroke("#404040", 1), [(-0.2, 0), (3.3, 0)]), curve("nodes", stroke("#000000", size=1.0, shape=5), [(x, 0) for x in grid]),
                  curve("particles", stroke("#0072B2", size=1.0), [(x, 1) for x in particles])]
        panels.append(panel(title, "", "", curves, "unset border\nunset tics\nunset grid\nset xrange [-0.3:3.4]\nset yrange [-0.3:1.3]\n" + arrows(pairs)))
    return page("One step of the material point method", panels, 2, 415, 170, terminal)


def column_top(tools, terminal):
    """How the top of the large column moves."""
    moves = {}
    for scheme in FOUR:
        _, folder = tools.report("--case", "column", "--scheme", scheme, "--snapshots", 200)
        last = max(row["X"] for row in read(folder / "particles.csv", time=0.0))
        moves[scheme] = [(row["time"], 1000 * row["displacement"]) for row in read(folder / "particles.csv", X=last)]
    curves = [curve(scheme, look_of(tools, scheme, 1.5), moves[scheme]) for scheme in FOUR]
    beside = [curve("", look_of(tools, scheme, 1.5), [(t, abs(u - best)) for (t, u), (_, best) in zip(moves[scheme], moves["high-order"]) if t > 0.0])
              for scheme in FOUR[:-1]]
    return page("Top of the large column, 64 cells of 4 particles",
                [panel("displacement", "t, s", "u, mm", curves),
                 panel("distance from high-order", "t, s", "|u − u of high-order|, mm", beside, "set yrange [1e-3:1e3]\n", True)], 2, 415, 250, terminal)


def look_of(tools, scheme, width=0.0, size=0.0):
    """How every picture draws the scheme."""
    look = next(row["look"] for row in tools.catalogue()["schemes"] if row["name"] == scheme)
    return stroke(look["colour"], width, look["dash"], look["shape"], size)


def hard(tools, terminal):
    """What the tests of hard cases measured."""
    return hard_cases.picture(tools, {scheme: look_of(tools, scheme) for scheme in FOUR}, terminal)


DRAWN = {"bar-large": bar_large, "column-settled": column_settled, "cut-span": cut_span, "limit-cut": limit_cut, "long-run": long_run, "hard-cases": hard,
         "spline-basis": spline_basis, "crossing": crossing, "steps": steps_of_mpm, "column-top": column_top,
         **{f"accuracy-cost-{name}": accuracy_cost(name) for name in ("bar-large", "bar-small", "column-large", "column-small")},
         **{name: drawn_by_tool(name) for name in COMMANDS}}


def version(svg):
    found = re.search(rb"GNUPLOT ([\d.]+) patchlevel (\w+)", svg)
    return found.group(0).decode() if found else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("--tool", type=pathlib.Path, default=make_tables.ROOT / "build/release/bin", help="folder of hompm-run")
    parser.add_argument("--check", action="store_true", help="write nothing; fail when a picture is stale")
    parser.add_argument("--tables", action="store_true", help="those of make_tables.py, too")
    parser.add_argument("--only", nargs="+", choices=sorted(DRAWN), help="these pictures")
    arguments = parser.parse_args()

    stale = []
    with tempfile.TemporaryDirectory() as work:
        tools = make_tables.Tools(arguments.tool.resolve(), work)
        (tools.work / "golden").symlink_to(make_tables.ROOT / "golden")
        if arguments.tables:
            stale += make_tables.renew_all(tools, arguments.check, make_tables.SLOW_PARTS)
        for name in arguments.only or DRAWN:
            def drawn(terminal, name=name):
                script = DRAWN[name](tools, terminal)
                if script:
                    return subprocess.run(["gnuplot", "-d"], input=script.encode(), capture_output=True, check=True, cwd=work).stdout
                return (pathlib.Path(work) / f"{name}.{terminal}").read_bytes()
            new = drawn("svg")
            path = PICTURES / f"{name}.svg"
            old = path.read_bytes() if path.exists() else b""
            if new == old:
                continue
            if not arguments.check:
                path.write_bytes(new)
                path.with_suffix(".png").write_bytes(drawn("png"))
                print(f"{path.relative_to(make_tables.ROOT)}: drawn anew")
            elif old and version(old) != version(new):
                print(f"{path.relative_to(make_tables.ROOT)}: passed over, it is by {version(old)}, here is {version(new)}")
            else:
                stale.append(f"{path.relative_to(make_tables.ROOT)} is stale (docs/make_pictures.py draws it anew)")
    for complaint in stale:
        print(complaint, file=sys.stderr)
    return 1 if stale else 0


if __name__ == "__main__":
    sys.exit(main())
