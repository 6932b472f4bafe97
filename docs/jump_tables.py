"""The part of docs/method.md on a jump: what a bar keeps of its speed when it rebounds from a rigid wall, and how long it touches it."""
import csv
import math

from table_tools import ROOT, short, table

CELLS = [16, 32, 64, 128, 256]
SCHEMES = ["classical", "bspline", "tielen2017", "high-order"]
WALL = ["--scene", ROOT / "docs/scenes/wall.toml", "--snapshots", 1]
EXACT_TIME = 2.0  # 2L/c, s


def rebound(tools, scheme, cells, step_fraction):
    """The speed that is lost over that of the impact, and the error of the time of contact over 2L/c."""
    options = ["--scheme", scheme, "--cells", cells, "--step-fraction", f"{step_fraction:g}", "--set", "output.history=1000000"]
    _, folder = tools.report(*WALL, *options)
    with open(folder / "history.csv", newline="", encoding="ascii") as file:
        rows = [(float(row["time"]), float(row["momentum"]), float(row["impulse"])) for row in csv.DictReader(file)]
    closed = next(time for time, _, impulse in rows if impulse != 0.0)
    opened = next(time for time, _, impulse in rows if impulse == rows[-1][2])
    return 1.0 + rows[-1][1] / rows[0][1], abs(opened - closed - EXACT_TIME) / EXACT_TIME


def jumps(tools):
    """Steps of 0.4 of the critical one; once more with steps as the square of the width of a cell."""
    kinds = [(f"`{scheme}`", scheme, lambda _cells: 0.4, CELLS) for scheme in SCHEMES]
    kinds.append(("`high-order`, Δt ∝ h²", "high-order", lambda cells: 0.4 * CELLS[0] / cells, CELLS[:-1]))
    lost, late = [], []
    for name, scheme, step, counts in kinds:
        losses, times = zip(*(rebound(tools, scheme, cells, step(cells)) for cells in counts))
        orders = ["", *(f" ({math.log2(before / now):.2f})" for before, now in zip(losses, losses[1:]))]
        blank = ["–"] * (len(CELLS) - len(counts))
        lost.append([name, *(short(loss) + order for loss, order in zip(losses, orders)), *blank])
        late.append([name, *map(short, times), *blank])
    return ["Part of the speed that is lost, and in brackets its order:", "", *table(["scheme", *CELLS], lost, range(1, 6)), "",
            "Error of the time of contact over 2L/c, known to a step (6e-3 to 3e-2 of it with 16 cells):", "", *table(["scheme", *CELLS], late, range(1, 6))]
