"""The hard cases of docs/stability.md: a table and a picture of what the tests of them measured.

`tests/test_stability` runs the scenes in docs/scenes/hard, checks its bounds, and writes what it measured to the file that HOMPM_MEASURED
names: case, series, x, value.
"""
import collections
import csv
import os
import re
import subprocess
import sys

from cut_span import cut_span as exact_cut_span
from picture_tools import curve, page, panel, stroke
from table_tools import ROOT, short, table

TESTS = "grid crossing*,a free end that passes*,a vanishing cut*,rigid flight*,a uniform strain*,extension*,constant stress*,with one particle*," \
        "a body of two*,clustered*,velocity noise*,a step of*,a million*,a thousand periods of the small*,a contrast*,with bulk viscosity*"
SCHEMES = ["classical", "bspline", "tielen2017", "high-order"]


def measured(tools):
    """{case: {series: [(x, value)]}}; measured once."""
    if "hard cases" not in tools.known:
        path = tools.work / "measured.csv"
        done = subprocess.run([tools.run_tool.parent.parent / "tests/test_stability", TESTS], env=os.environ | {"HOMPM_MEASURED": str(path)},
                              capture_output=True, text=True, check=False, cwd=tools.work)
        if done.returncode != 0:
            sys.exit(f"test_stability: {done.stdout[-2000:]}")
        cases = collections.defaultdict(lambda: collections.defaultdict(list))
        with open(path, newline="", encoding="ascii") as file:
            for case, series, x, value in csv.reader(file):
                cases[case][series].append((float(x), float(value)))
        tools.known["hard cases"] = cases
    return tools.known["hard cases"]


def said(tools, scene, *options):
    """What hompm-run says of a scene that it refuses or stops, from the quantity on."""
    text = tools.complaint("--scene", str(ROOT / f"docs/scenes/hard/{scene}.toml"), "--quiet", "--no-vtk", *options).strip()
    return "“" + re.sub(r"^hompm-run: (\S+\.toml:\d+:\d+: |--set \S+: )?", "", text).replace("|", "/") + "”"


def rounding(value):
    """A number of the size of rounding differs from machine to machine in no way, but means nothing beyond its size."""
    return "0" if value == 0.0 else f"{value:.0e}".replace("e-0", "e-")


def each(case, text, schemes=None):
    return ", ".join(f"`{scheme}` {text(points)}" for scheme, points in case.items() if schemes is None or scheme in schemes)


def last(points):
    return short(points[-1][1])


def rows(tools):
    m = measured(tools)
    arrow = lambda points: " → ".join(short(value) for _, value in points)  # noqa: E731
    cut = m["cut-span"]["high-order"]
    limits = [value for x, value in cut if x < 1.0]
    conditions = [exact_cut_span(3, x, True)[1] for x in (1e-3, 1e-6, 1e-12)]
    shock = {scheme: dict(points) for scheme, points in m["shock"].items()}
    percent = lambda value: f"{100 * value:.2g} %"  # noqa: E731
    runs = {scheme: "p ≤ " + str(int(max(x for x, ran in points if ran))) for scheme, points in m["few-particles"].items()}
    clustered = m["clustered"]
    stress = m["constant-stress"]
    return [
        ("grid-crossing", "grid crossing", "the error falls at the scheme's order", "16, 32, 64 cells: " + each(m["grid-crossing"], arrow)),
        ("free-end-knots", "free end crossing knots", "no jump in particle acceleration",
         "10⁻¹² cells on each side: " + each(m["free-end-knots"], lambda points: rounding(points[-1][1]))),
        ("cut-span", "cut span ε → 0", "step and condition independent of ε",
         f"ε = 10⁻¹ … 10⁻¹²: c Δt/h {max(limits):.3f} … {min(limits):.3f}, condition {max(conditions):.0f} from 10⁻³ to 10⁻¹²; without extension 0.59 of the step"),
        ("../flight", "rigid flight", "exact to rounding", "50 cells: " + each(m["flight"], lambda points: rounding(points[-1][1]) + " m")),
        ("uniform-strain-rate", "uniform strain rate", "exact to rounding with reconstruction",
         "largest error of λ: " + each(m["uniform-strain-rate"], lambda points: rounding(max(value for _, value in points)))),
        ("constant-stress", "constant-stress patch", "no interior force with reconstruction",
         "10:1, σ = 1: " + each(stress, lambda points: rounding(points[-1][1])) + " (`classical`: one gradient per cell sees how many, not where)"),
        ("few-particles", "few particles", "runs, or is refused with what to change",
         "one per cell: " + ", ".join(f"`{scheme}` {text}" for scheme, text in runs.items()) + "; then " + said(tools, "few-particles")),
        ("two-particles", "two particles in all", "runs, or is refused", "energy open by " + each(m["two-particles"], last) + "; `high-order` is refused"),
        ("clustered", "clustered particles", "bounded, or a clear error",
         "largest velocity of 1 at the start: 1e-10 cells apart "
         + each(clustered, lambda points: f"{dict(points)[1e-10]:.2f}" if 1e-10 in dict(points) else "stops") + "; 10:1 "
         + each(clustered, lambda points: f"{dict(points)[10.0]:.2f}" if 10.0 in dict(points) else "stops") + "; the others stop by name"),
        ("density-overshoot", "overshoot of the density spline", "never a non-positive density used; reported", said(tools, "density-overshoot")),
        ("inverted", "inverted element", "stops with which particle, where, when", said(tools, "inverted")),
        ("step-too-large", "step too large", "refused with the limit; forced, it ends as unstable",
         said(tools, "step-too-large") + "; forced " + said(tools, "step-too-large", "--set", "scheme.allow_unstable=true")),
        ("long-run", "long run", "energy bounded, no drift", "distance in the last of 1000 periods: " + each(m["long-run"], last, SCHEMES)),
        ("shock", "shock", "exact speed and plateau, no negative density",
         "speed, plateau, ripple: " + "; ".join(f"`{scheme}` " + ", ".join(percent(value) for value in points.values()) for scheme, points in shock.items())),
        ("null-space", "null space", "bounded; removed by the filter", "of the noise are left after 2000 steps: " + each(m["null-space"], last)),
        ("stiffness-contrast", "stiffness contrast 1e6", "stable at the stiffer one's step; reflection coefficient exact",
         "error of the coefficient −0.998002 at 0.3, 0.98 of that step: " + each(m["stiffness-contrast"], lambda points: ", ".join(short(value) for _, value in points))),
        ("extreme-extension", "extension to λ = 10", "no numerical fracture with reconstruction",
         "largest error of λ: " + each(m["extreme-extension-error"], last)
         + f"; `classical` has {m['extreme-extension-holes']['classical'][0][1]:.0f} functions without a particle inside"),
        ("extreme-compression", "compression to λ = 0.05", "follows the motion", "largest error of λ: " + each(m["extreme-compression-error"], last)),
        ("million-particles", "10⁶ particles", "balances to rounding",
         "momentum residual " + rounding(m["million-particles"]["bspline"][0][1]) + " of what was exchanged, mass unchanged"),
    ]


def hard_cases(tools):
    return table(["case", "must show", "shown"], [(f"[{name}](scenes/{'' if scene.startswith('..') else 'hard/'}{scene.removeprefix('../')}.toml)", must, shows)
                                                  for scene, name, must, shows in rows(tools)])


def long_phases(tools):
    return table(["scheme", "amplitude in the last period, over the first", "phase, periods ahead of the exact"],
                 [(f"`{scheme}`", f"{points[0][0]:.3f}", f"{points[0][1]:.2f}") for scheme, points in measured(tools)["long-run-phase"].items()], range(1, 3))


PANELS = [  # case, title, axes, options, and a curve beside
    ("grid-crossing", "grid crossing", "cells", "relative L2 error", "set logscale x 2; set logscale y 10; set xrange [14:72]; set xtics (16, 32, 64)", ""),
    ("free-end-knots", "free end through a knot", "cells on each side", "jump in acceleration", "set logscale xy 10; set xrange [1:1e-13] reverse; set yrange [1e-16:1]", ""),
    ("cut-span", "cut span", "filled part ε", "critical step c Δt/h", "set logscale x 10; set xrange [2:1e-13] reverse; set yrange [0:2.5]", ""),
    ("uniform-strain-rate", "uniform strain rate", "X, m", "error of λ", "set logscale y 10; set xrange [0:1]; set yrange [1e-17:1]", ""),
    ("constant-stress", "constant stress", "unevenness", "largest interior force", "set logscale y 10; set xrange [0:11]; set yrange [1e-17:10]", ""),
    ("null-space", "null space", "step", "velocity left of the noise", "set logscale y 10; set xrange [0:2000]; set xtics 1000", ""),
    ("shock-profile", "impact at c/2, 256 cells", "X, m", "stress, Pa", "set xrange [0:1]; set yrange [-0.75:0.1]", "shock"),
    ("stiffness-contrast-profile", "contrast 1e6, high-order", "X, m", "velocity, m/s", "set xrange [0:2]; set yrange [-0.12:0.12]", ""),
    ("extreme-extension", "extension to λ = 10", "X, m", "λ", "set xrange [0:1]; set yrange [0:16]", "ten"),
    ("extreme-compression", "compression to λ = 0.05", "X, m", "λ", "set xrange [0:1]; set yrange [0:0.5]", "twentieth"),
    ("flight", "rigid flight", "cells crossed", "error of position, m", "set logscale y 10; set xrange [0:50]; set yrange [1e-17:1e-10]", ""),
    ("step-too-large", "1.05 of the critical step, forced", "t, s", "energy over that at the start", "set yrange [0:10]", ""),
]
EXACT = {"ten": "10", "twentieth": "0.05", "shock": "x < 0.75 ? -0.640388 : 0"}


def picture(tools, looks, terminal):
    """Twelve panels."""
    m = measured(tools)
    before_after = {"before": stroke("#0072B2"), "after": stroke("#D55E00")}
    panels = []
    for case, title, across, up, options, exact in PANELS:
        logarithmic = "logscale y" in options or "logscale xy" in options
        floor = 1e-16 if logarithmic else None  # rounding, or nothing at all
        curves = []
        for series, points in m[case].items():
            step = max(1, len(points) // 50)
            look = (looks | before_after)[series] | {"width": 1.5, "size": 0.5 if len(points) <= 16 else 0.0}
            curves.append(curve(series, look, [(float(x), max(value, floor) if floor else value) for x, value in sorted(points)[::step]]))
        if exact:
            curves.append(curve("exact", stroke("#000000", 1, 2), EXACT[exact]))
        powers = "set format x '10^{%T}'\n" if "reverse" in options else ""
        panels.append(panel(title, across, up, curves, options.replace("; ", "\n") + "\nset samples 400\n" + powers, logarithmic))
    return page("Hard cases of docs/scenes/hard", panels, 3, 276, 220, terminal)
