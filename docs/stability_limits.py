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


def courant(degree, end, acceleration, velocity):
    """`end` on the right: fixed; margin, free with grid beyond; cut, free at the last knot. The left end is fixed.
    `acceleration`, `velocity`: lumped or consistent mass."""
    import numpy  # pylint: disable=import-outside-toplevel  (python3-numpy, which no other part needs)
    mass, stiffness = matrices(degree, degree + 1 if end == "margin" else 0)
    first, last = 1, CELLS + degree - (1 if end == "fixed" else 0)
    if acceleration == "consistent" and end == "margin":
        last -= 1
        mass, stiffness = tied(mass, degree, last), tied(stiffness, degree, last)
    lumped = numpy.sum(mass, axis=1)[first:last]
    mass, stiffness = (numpy.array(matrix)[first:last, first:last] for matrix in (mass, stiffness))
    # Each map has the eigenvalues of a symmetric matrix.
    if acceleration == "consistent":
        root = numpy.linalg.cholesky(mass)
        symmetric = numpy.linalg.solve(root, numpy.linalg.solve(root, stiffness).T)
    elif velocity == "consistent":
        symmetric = stiffness / numpy.sqrt(numpy.outer(lumped, lumped))
    else:
        root = numpy.linalg.cholesky(mass / numpy.outer(lumped, lumped))
        symmetric = root.T @ stiffness @ root
    return 2.0 / math.sqrt(numpy.linalg.eigvalsh(symmetric)[-1])
