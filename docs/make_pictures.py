#!/usr/bin/env python3
"""Draws the pictures of docs/pictures anew, from runs.

    docs/make_pictures.py [--tool build/release/bin] [--check] [--tables]

With --tables the parts of docs/make_tables.py, too: many come from the same runs.

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

PICTURES = make_tables.ROOT / "docs/pictures"
# Okabe and Ito's colours, which everybody can tell apart; the shapes differ, too.
STYLES = {"classical": ("#D55E00", 7), "bspline": ("#0072B2", 5), "tielen2017": ("#009E73", 9),
          "high-order": ("#CC79A7", 13)}
# The rest of the family: thin, and dashed where a colour comes twice.
OTHERS = {"ugimp": ("#E69F00", 1), "cpgimp": ("#56B4E9", 1), "cpdi": ("#56B4E9", 2), "ddmp": ("#999999", 1), "apic": ("#000000", 1),
          "total-lagrangian": ("#000000", 2), "mixed": ("#E69F00", 2), "mls": ("#999999", 2), "tls": ("#009E73", 2)}
NEW = ("#F0E442", 3)  # a scheme without a style of its own

START = """
set encoding utf8
set terminal svg size {size} font "Helvetica,15" background "#FFFFFF"
set output "{name}.svg"
set tics nomirror
set border 3 linecolor "#404040"
set grid linecolor "#E0E0E0" linetype 1
"""


def block(name, rows):
    return "\n".join([f"${name} << EOD", *(" ".join(row) for row in rows), "EOD", ""])


def bar_large(tools):
    """Errors of the large bar against the number of cells, with lines of second and higher order."""
    reports = make_tables.study(tools, "bar-large")
    script = START.format(size="920,480", name="bar-large")
    fields = ("displacement", "stress")
    for scheme in STYLES:
        rows = [[str(report["cells"]), *(make_tables.short(make_tables.error_of(report, field)) for field in fields)]
                for report in reports[scheme]]
        script += block(scheme.replace("-", "_"), rows)
    script += """
set logscale x 2
set logscale y 10
set xrange [13:310]
set yrange [5e-13:2]
set xtics (16, 32, 64, 128, 256)
set format y "10^{%T}"
set xlabel "cells"
set multiplot layout 1,2 title "Large bar, t = 4 s; high-order with p = 3" font ",17" offset 0,-0.2
"""
    for column, field in enumerate(fields, start=2):
        script += f'set title "{field}" offset 0,-0.5\nset ylabel "{"relative L2 error" if column == 2 else ""}"\n'
        script += "set key at graph 0.03,0.02 left bottom Left reverse samplen 2 spacing 0.9\n" if column == 3 else "unset key\n"
        curves = [f'${scheme.replace("-", "_")} using 1:{column} with linespoints linewidth 2.5 pointsize 0.8 pointtype {point} '
                  f'linecolor "{colour}" title "{scheme}"' for scheme, (colour, point) in STYLES.items()]
        for scheme, slope, dash in (("tielen2017", 2, 2), ("high-order", 4 if column == 2 else 3, 3)):
            beside = 0.4 * make_tables.error_of(reports[scheme][2], field)
            curves.append(f'[64:256] {beside:.3g}*({make_tables.CELLS[2]}.0/x)**{slope} with lines linewidth 1.5 dashtype {dash} '
                          f'linecolor "#606060" notitle')
            script += f'set label {slope} "order {slope}" at 100,{0.2 * beside * (make_tables.CELLS[2] / 100) ** slope:.3g} right textcolor "#606060"\n'
        script += "plot " + ", \\\n     ".join(curves) + "\nunset label\n"
    return script + "unset multiplot\n"


def column_settled(tools):
    """Particle stresses over the height of the settled column, and the closed form."""
    script = START.format(size="1100,480", name="column-settled")
    notes = {}
    for scheme in STYLES:
        report, folder = tools.report("--case", "column", "--variant", "settled", "--scheme", scheme)
        with open(folder / "stress.csv", newline="", encoding="ascii") as file:
            rows = [row for row in csv.DictReader(file) if float(row["time"]) == report["end_time"]]
        notes[scheme] = "at rest" if report["at_rest"] else f"not at rest, t = {report['end_time']:g} s"
        script += block(scheme.replace("-", "_"), [[f"{float(row['stress']) / 1000:.4f}", f"{float(row['X']):.4f}"] for row in rows])
    script += block("exact", [["-9.81", "0"], ["0", "1"]])  # σ = −ρ0 g (H − X) is a straight line
    script += """
set xrange [-12:2]
set yrange [0:1]
set xtics -10,5,0
set xlabel "stress σ, kPa"
unset key
set multiplot layout 1,4 title "Settled column, 32 cells of 4 particles; dots: particles, line: exact" font ",17" offset 0,-0.2
"""
    for number, (scheme, (colour, _)) in enumerate(STYLES.items()):
        script += f'set title "{scheme}\\n{notes[scheme]}" offset 0,-0.5\nset ylabel "{"reference position X, m" if number == 0 else ""}"\n'
        script += (f'plot ${scheme.replace("-", "_")} using 1:2 with points pointtype 7 pointsize 0.35 linecolor "{colour}" title "particles", \\\n'
                   '     $exact using 1:2 with lines linewidth 1.5 linecolor "#000000" title "exact"\n')
    return script + "unset multiplot\n"


def cut_span(_tools):
    """Critical step and condition of the mass against the fraction of the last span that is filled."""
    colours = {2: "#0072B2", 3: "#CC79A7", 4: "#009E73"}
    cuts = [10.0 ** (-k / 2) for k in range(25)]
    script = START.format(size="920,480", name="cut-span")
    for degree in colours:
        rows = [[f"{cut:.3e}", *(f"{number:.3e}" for extended in (True, False) for number in exact_cut_span(degree, cut, extended))]
                for cut in cuts]
        script += block(f"p{degree}", rows)
    script += """
set logscale xy 10
set xrange [1:1e-12] reverse
set xtics (1, "10^{-3}" 1e-3, "10^{-6}" 1e-6, "10^{-9}" 1e-9, "10^{-12}" 1e-12)
set format y "10^{%T}"
set xlabel "filled fraction ε of the last span"
set multiplot layout 1,2 title "Free end in a span: solid with the extension, dashed without" font ",17" offset 0,-0.2
"""
    panels = (("critical step c Δt/h", "[1e-12:10]", "left bottom"), ("condition number of the mass", "[1:1e20]", "right center"))
    for column, (title, limits, place) in enumerate(panels, start=2):
        script += f'set title "{title}" offset 0,-0.5\nset yrange {limits}\nset key {place} samplen 2 spacing 0.9\n'
        curves = [f'$p{degree} using 1:{column + 2 * bare} with lines linewidth 2.5 dashtype {1 + bare} linecolor "{colour}" '
                  + ("notitle" if bare else f'title "p = {degree}"') for degree, colour in colours.items() for bare in (0, 1)]
        script += "plot " + ", \\\n     ".join(curves) + "\n"
    return script + "unset multiplot\n"


def limit_cut(tools):
    """Critical step against the filled part of the last span."""
    curves = [("bspline", 1, 1), ("bspline", 2, 2), ("tielen2017", 1, 1), ("tielen2017", 2, 2), ("high-order", 2, 1), ("high-order", 3, 2)]
    script = START.format(size="760,460", name="limit-cut")
    plots = []
    for number, (scheme, degree, dash) in enumerate(curves):
        script += block(f"c{number}", [[f"{cut:g}", f"{limit:g}"] for cut, limit in make_tables.limit_cuts(tools, scheme, degree)])
        plots.append(f'$c{number} using 1:2 with linespoints linewidth 2.5 dashtype {dash} pointsize 0.5 pointtype {STYLES[scheme][1]} '
                     f'linecolor "{STYLES[scheme][0]}" title "{scheme}, p = {degree}"')
    return script + """
set xrange [0:0.92]
set yrange [0:2.5]
set xlabel "filled part ε of the last span"
set ylabel "critical step c Δt/h"
set key outside right samplen 2
plot """ + ", \\\n     ".join(plots) + "\n"


def long_run(tools):
    """Energy over a thousand periods of the small bar."""
    script = START.format(size="1200,480", name="long-run") + 'set multiplot layout 1,2 title "Energy over a thousand periods, 16 cells, half the critical step" font ",17"\n'
    script += 'set xlabel "t, s"\nset xrange [0:5000]\nset xtics 1000\nset tmargin 4\nset bmargin 4\n'
    for law, top in (("linear", 1.2), ("rate", 9)):
        plots = []
        for row in make_tables.scheme_rows():
            scheme = row["name"]
            colour, dash = (STYLES[scheme][0], 1) if scheme in STYLES else OTHERS.get(scheme, NEW)
            name = f"{law}_{scheme}".replace("-", "_")
            script += block(name, [[f"{time:.0f}", f"{energy:.4f}"] for time, energy in make_tables.long_bar(tools, scheme, law)[::4]])
            plots.append(f'${name} using 1:2 with lines linewidth {2 if scheme in STYLES else 1} dashtype {dash} linecolor "{colour}" title "{scheme}"')
        script += "set lmargin at screen %g\nset rmargin at screen %g\n" % ((0.06, 0.38) if law == "linear" else (0.43, 0.75))
        script += f'set title "law {law}"\nset ylabel "{"energy over that at the start" if law == "linear" else ""}"\nset yrange [{0.8 if law == "linear" else 0}:{top}]\n'
        script += ("set key at screen 0.995,0.8 right top Left reverse samplen 2\n" if law == "rate" else "unset key\n") + "plot " + ", \\\n     ".join(plots) + "\n"
    return script + "unset multiplot\n"


def hard(tools):
    """What the tests of hard cases measured."""
    return hard_cases.picture(tools, START, block, STYLES)


def comparing(tools):
    """What hompm-diff --picture draws, here of golden data of two schemes."""
    golden = make_tables.ROOT / "golden"
    subprocess.run([tools.run_tool.parent / "hompm-diff", "--quiet", "--time", "1.25", "--picture", "comparing.svg",
                    golden / "bar-small-classical/stress.csv", golden / "bar-small-bspline"], check=False, cwd=tools.work)
    return ""


def version(text):
    found = re.search(r"GNUPLOT ([\d.]+) patchlevel (\w+)", text)
    return found.group(0) if found else ""


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter, allow_abbrev=False)
    parser.add_argument("--tool", type=pathlib.Path, default=make_tables.ROOT / "build/release/bin", help="folder of hompm-run")
    parser.add_argument("--check", action="store_true", help="write nothing; fail when a picture is stale")
    parser.add_argument("--tables", action="store_true", help="those of make_tables.py, too")
    arguments = parser.parse_args()

    stale = []
    with tempfile.TemporaryDirectory() as work:
        tools = make_tables.Tools(arguments.tool.resolve(), work)
        if arguments.tables:
            stale += make_tables.renew_all(tools, arguments.check, make_tables.SLOW_PARTS)
        for name, draw in (("bar-large", bar_large), ("column-settled", column_settled), ("cut-span", cut_span), ("limit-cut", limit_cut), ("long-run", long_run), ("hard-cases", hard), ("comparing", comparing)):
            subprocess.run(["gnuplot"], input=draw(tools), text=True, check=True, cwd=work)
            new = (pathlib.Path(work) / f"{name}.svg").read_text()
            path = PICTURES / f"{name}.svg"
            old = path.read_text() if path.exists() else ""
            if new == old:
                continue
            if not arguments.check:
                PICTURES.mkdir(exist_ok=True)
                path.write_text(new)
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
