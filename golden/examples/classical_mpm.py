#!/usr/bin/env python3
"""Another code, in numpy: the classical material point method on the small bar.

    golden/examples/classical_mpm.py mine.csv [TIME_STEP]
    hompm-diff --relative all=1e-9 mine.csv golden/bar-small-classical

Writes displacement, velocity and stress at the times of the golden data, then reads those and compares itself, field by
field. Needs numpy (Debian package python3-numpy) and nothing of hompm.
"""
import pathlib
import sys

import numpy as np

GOLDEN = pathlib.Path(__file__).resolve().parent.parent / "bar-small-classical"

# golden/bar-small-classical/scene.toml
L, rho, E, amplitude, end_time = 25.0, 1.0, 100.0, 0.1, 2.5
cells, per_cell = 64, 4
dt = float(sys.argv[2]) if len(sys.argv) > 2 else 1e-4
h = L / cells

X = (np.arange(cells * per_cell) + 0.5) * h / per_cell
V0 = np.full_like(X, h / per_cell)
m = rho * V0
u = np.zeros_like(X)
v = amplitude * np.sin(np.pi * X / L)
stress = np.zeros_like(X)
stretch = np.ones_like(X)


def to_grid(left, weights):
    """Sums of what the particles give to the node on their left and to the one on their right."""
    return sum(np.bincount(left + k, weights[k], cells + 1) for k in (0, 1))


def step():
    global u, v, stress, stretch
    x = X + u
    left = np.floor(x / h).astype(int)
    right_part = x / h - left
    N = np.array([1 - right_part, right_part])
    dN = np.array([-1 / h, 1 / h])
    mass = to_grid(left, N * m)
    acceleration = -to_grid(left, dN[:, None] * (V0 * stretch * stress)) / mass
    acceleration[[0, -1]] = 0.0  # fixed ends
    v = v + dt * (N[0] * acceleration[left] + N[1] * acceleration[left + 1])
    velocity = to_grid(left, N * (m * v)) / mass
    velocity[[0, -1]] = 0.0
    strain = dt * (velocity[left + 1] - velocity[left]) / h
    u = u + dt * (N[0] * velocity[left] + N[1] * velocity[left + 1])
    stress = stress + (E - stress) * strain  # the law `rate`
    stretch = stretch * (1 + strain)


def rows(time):
    return np.column_stack([np.full_like(X, time), X, u, v, stress])


steps = round(end_time / dt)
results = [rows(0.0)]
for number in range(1, steps + 1):
    step()
    if number in (steps // 2, steps):
        results.append(rows(number * dt))
results = np.concatenate(results)
np.savetxt(sys.argv[1], results, fmt="%.17g", delimiter=",", header="time,X,displacement,velocity,stress", comments="")

# The golden data as numpy sees them: the rows are in the order of time and X, as ours are.
particles, stresses = (np.genfromtxt(GOLDEN / name, delimiter=",", names=True) for name in ("particles.csv", "stress.csv"))
for column, (field, golden) in enumerate([("displacement", particles), ("velocity", particles), ("stress", stresses)], start=2):
    distance = np.max(np.abs(results[:, column] - golden[field])) / np.max(np.abs(golden[field]))
    print(f"{field}: largest distance {distance:.1e} of the largest value")
