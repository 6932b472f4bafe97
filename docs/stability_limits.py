"""Stability limits c Δt/h of B-spline schemes with exact integrals, from their definition.

With every integral exact the step on the grid is σ = E Σ u_j N_j', a = −M_L⁻¹ K u, and the velocity that the grid gets back
is M_L⁻¹ M a (lumped) or M⁻¹ M a = a (consistent). The limit is 2/√(largest eigenvalue of M_L⁻¹ K [M_L⁻¹ M]), for h = c = 1.
With consistent mass for the acceleration, too, it is that of M⁻¹ K, with the last function of a grid that goes on tied to its
neighbours (extension): Cᵀ M C and Cᵀ K C.
"""
import math

CELLS = 64
GAUSS = {  # points and weights on [−1, 1], exact to degree 11, which is beyond 2p
    0.2386191860831969: 0.4679139345726910, 0.6612093864662645: 0.3607615730481386, 0.9324695142031521: 0.1713244923791704}


def basis(degree, knots, cell, x):
    """Values and derivatives of the degree + 1 B-splines on a cell (Cox-de Boor)."""
    i = cell + degree
    values = [1.0]
    for d in range(1, degree + 1):
        lower, values = values, [0.0] * (d + 1)
        for r in range(d):
            left, right = knots[i - d + 1 + r], knots[i + 1 + r]
            part = lower[r] / (right - left)
            values[r] += (right - x) * part
            values[r + 1] += (x - left) * part
    slopes = [0.0] * (degree + 1)
    for r in range(degree):
        slope = degree * lower[r] / (knots[i + 1 + r] - knots[i - degree + 1 + r])
        slopes[r] -= slope
        slopes[r + 1] += slope
    return values, slopes


def matrices(degree, margin):
    """Mass and stiffness of a body of CELLS cells in a grid with `margin` cells more, full rows without zeros."""
    cells = CELLS + margin
    knots = [0] * degree + list(range(cells + 1)) + [cells] * degree
    mass = [[0.0] * (cells + degree) for _ in range(cells + degree)]
    stiffness = [row[:] for row in mass]
    for cell in range(CELLS):
        for point, weight in GAUSS.items():
            for x in (cell + 0.5 - 0.5 * point, cell + 0.5 + 0.5 * point):
                values, slopes = basis(degree, knots, cell, x)
                for a in range(degree + 1):
                    for b in range(degree + 1):
                        mass[cell + a][cell + b] += 0.5 * weight * values[a] * values[b]
                        stiffness[cell + a][cell + b] += 0.5 * weight * slopes[a] * slopes[b]
    return mass, stiffness


def tied(matrix, degree, j):
    """Cᵀ A C for c_j = Σ (−1)^(k+1) binomial(degree + 1, k) c_(j−k)."""
    part = {j - k: (-1) ** (k + 1) * math.comb(degree + 1, k) for k in range(1, degree + 2)}
    result = [row[:] for row in matrix]
    for a, ea in part.items():
        for b, eb in part.items():
            result[a][b] += ea * matrix[j][b] + eb * matrix[a][j] + ea * eb * matrix[j][j]
    return result


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


def courant(degree, end, acceleration, velocity, rounds=1500):
    """`end` on the right: fixed; margin, free with grid beyond; cut, free at the last knot. The left end is fixed.
    `acceleration`, `velocity`: lumped or consistent mass."""
    consistent = velocity == "consistent"
    mass, stiffness = matrices(degree, degree + 1 if end == "margin" else 0)
    first, last = 1, CELLS + degree - (1 if end == "fixed" else 0)
    if acceleration == "consistent":
        if end == "margin":
            last -= 1
            mass, stiffness = tied(mass, degree, last), tied(stiffness, degree, last)
        solve = cholesky([row[first:last] for row in mass[first:last]], degree + 1)
        rounds //= 5
    lumped = [sum(row) for row in mass[first:last]]

    def sparse(matrix):
        return [[(j - first, row[j]) for j in range(first, last) if row[j] != 0.0] for row in matrix[first:last]]

    mass, stiffness = sparse(mass), sparse(stiffness)

    def times(matrix, x):
        return [sum(entry * x[j] for j, entry in row) for row in matrix]

    def over_lumped(x):
        return [a / m for a, m in zip(x, lumped)]

    # Power iteration; the Rayleigh quotient, in the inner product in which the map is symmetric, squares its error.
    x = [math.sin(1.0 + 7.0 * i * i) for i in range(last - first)]
    for _ in range(rounds):
        if acceleration == "consistent":
            y, weighted = solve(times(stiffness, x)), times(mass, x)
        else:
            y = over_lumped(times(stiffness, x if consistent else over_lumped(times(mass, x))))
            weighted = [a * m for a, m in zip(x, lumped)] if consistent else times(mass, x)
        largest = sum(a * b for a, b in zip(y, weighted)) / sum(a * b for a, b in zip(x, weighted))
        length = math.sqrt(sum(a * a for a in y))
        x = [a / length for a in y]
    return 2.0 / math.sqrt(largest)
