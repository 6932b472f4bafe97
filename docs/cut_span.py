"""What a free end inside a span does to the consistent mass: critical step and condition number, from their definition.

A body of CELLS full cells, fixed on the left, and the fraction ε of one more, in a grid that goes on; exact integrals, h = c = ρ = 1.
The mass is M, or with the extension Cᵀ M C (docs/high-order.md); the critical step is 2/√(largest eigenvalue of M⁻¹ K).
"""
import math

from stability_limits import GAUSS, basis, tied

CELLS = 16


def matrices(degree, fraction):
    """Mass and stiffness. The cut span begins at x = 0, so that a narrow one keeps its digits."""
    knots = [-CELLS] * degree + list(range(-CELLS, degree + 2))
    size = CELLS + 1 + degree
    mass = [[0.0] * size for _ in range(size)]
    stiffness = [row[:] for row in mass]
    for cell in range(CELLS + 1):
        width = fraction if cell == CELLS else 1.0
        for point, weight in GAUSS.items():
            for s in (0.5 - 0.5 * point, 0.5 + 0.5 * point):
                values, slopes = basis(degree, knots, cell, (cell - CELLS) + width * s)
                for a in range(degree + 1):
                    for b in range(degree + 1):
                        mass[cell + a][cell + b] += 0.5 * width * weight * values[a] * values[b]
                        stiffness[cell + a][cell + b] += 0.5 * width * weight * slopes[a] * slopes[b]
    return mass, stiffness


def cholesky(rows, reach):
    """Band factor of a symmetric positive definite matrix, as a function that solves with it."""
    size = len(rows)
    lower = [[0.0] * size for _ in range(size)]
    for i in range(size):
        for j in range(max(0, i - reach), i + 1):
            s = rows[i][j] - sum(lower[i][k] * lower[j][k] for k in range(max(0, i - reach), j))
            lower[i][j] = math.sqrt(s) if i == j else s / lower[j][j]

    def solve(b):
        x = b[:]
        for i in range(size):
            x[i] = (x[i] - sum(lower[i][k] * x[k] for k in range(max(0, i - reach), i))) / lower[i][i]
        for i in reversed(range(size)):
            x[i] = (x[i] - sum(lower[k][i] * x[k] for k in range(i + 1, min(size, i + reach + 1)))) / lower[i][i]
        return x
    return solve


def times(matrix, x):
    return [sum(a * b for a, b in zip(row, x) if a != 0.0) for row in matrix]


def largest_eigenvalue(apply, weigh, size, rounds=400):
    """Of a map that is symmetric in the inner product x · weigh(y): power iteration and Rayleigh quotient."""
    x = [math.sin(1.0 + 7.0 * i * i) for i in range(size)]
    before = 0.0
    for _ in range(rounds):
        length = math.sqrt(sum(a * a for a in x))
        x = [a / length for a in x]
        y, weighted = apply(x), weigh(x)
        value = sum(a * b for a, b in zip(y, weighted)) / sum(a * b for a, b in zip(x, weighted))
        if abs(value - before) <= 1e-9 * value:
            break
        before, x = value, y
    return value


def cut_span(degree, fraction, extended):
    """Critical step c Δt/h, and condition number of the mass."""
    mass, stiffness = matrices(degree, fraction)
    last = len(mass)
    if extended:
        last -= 1
        mass, stiffness = tied(mass, degree, last), tied(stiffness, degree, last)
    mass, stiffness = ([row[1:last] for row in matrix[1:last]] for matrix in (mass, stiffness))
    # A Cholesky factor keeps the digits of rows of very different size: small eigenvalues come from its inverse.
    solve = cholesky(mass, degree + 1)
    size = len(mass)
    frequency = largest_eigenvalue(lambda x: solve(times(stiffness, x)), lambda x: times(mass, x), size)
    condition = largest_eigenvalue(lambda x: times(mass, x), list, size) * largest_eigenvalue(solve, list, size)
    return 2.0 / math.sqrt(frequency), condition
