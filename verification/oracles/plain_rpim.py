"""The roll-up with radial point interpolation whose moment matrices are solved in plain double precision.

A cantilever of 1.8 m under M = 2 pi EI / L, Green strain, clamped in position and gradient; even nodes, the cell's two and two
more on each side, eight Gauss points a cell. Shape functions solve, per cell,

    u = sum R(X - X_i) a_i + R'(X - X_i) b_i + c_0 + c_1 X,   R = (d^2 + shape^2)^1.03   (d, X in spacings)
    with value and slope at every node of the support, and sum p_j(X_i) a_i + p_j'(X_i) b_i = 0

by Gaussian elimination with partial pivoting. Newton's method in equal load steps, halved where it does not converge. What comes out
is the distance of the tip from the clamp; a shape for which no load step converges is left out.

    python3 plain_rpim.py
"""

import os
import warnings

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from mpmath import mp, mpf

mp.prec = 53  # double precision, the same on every machine

LENGTH, AXIAL, BENDING = 1.8, 68.95e9 * 2.5e-4, 68.95e9 * 0.130e-8
NODES, NEIGHBOURS, POINTS, EXPONENT = 25, 2, 8, 1.03
SHAPES = [1, 2, 3.3, 5, 6, 8, 10, 14, 20, 30, 40]


def kernel(d, shape, order):
    """R or one of its first three derivatives by d."""
    q, g = mpf(EXPONENT), d * d + shape * shape
    if order == 0:
        return g**q
    if order == 1:
        return 2 * q * d * g ** (q - 1)
    if order == 2:
        return 2 * q * g ** (q - 1) + 4 * q * (q - 1) * d**2 * g ** (q - 2)
    return 12 * q * (q - 1) * d * g ** (q - 2) + 8 * q * (q - 1) * (q - 2) * d**3 * g ** (q - 3)


def solve(matrix, right):
    """matrix^-1 right by elimination with partial pivoting."""
    n = len(matrix)
    rows = [list(a) + list(b) for a, b in zip(matrix, right)]
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(rows[i][k]))
        rows[k], rows[pivot] = rows[pivot], rows[k]
        for i in range(k + 1, n):
            factor = rows[i][k] / rows[k][k]
            for j in range(k + 1, len(rows[k])):
                rows[i][j] -= factor * rows[k][j]
    for k in reversed(range(n)):
        for j in range(n, len(rows[k])):
            rows[k][j] = (rows[k][j] - sum(rows[k][i] * rows[i][j] for i in range(k + 1, n))) / rows[k][k]
    return [row[n:] for row in rows]


def functions(left, right, shape, places, order):
    """Derivatives of the shape functions at `places`, for `left` and `right` nodes beside the cell from 0 to 1."""
    count = left + right
    nodes = [i - mpf(count - 1) / 2 for i in range(count)]
    values = [[kernel(a - b, shape, 0) for b in nodes] + [kernel(a - b, shape, 1) for b in nodes] + [mpf(1), a] for a in nodes]
    slopes = [[kernel(a - b, shape, 1) for b in nodes] + [kernel(a - b, shape, 2) for b in nodes] + [mpf(0), mpf(1)] for a in nodes]
    k, zero = count, [mpf(0), mpf(0)]
    # sum p_j a_i + p_j' b_i = 0
    sides = [[mpf(1)] * k + [mpf(0)] * k + zero, nodes + [mpf(1)] * k + zero]
    moment = values + slopes + sides
    transposed = [list(column) for column in zip(*moment)]
    columns = []
    for place in places:
        x = nodes[left - 1] + place
        d = [x - node for node in nodes]
        tail = [[mpf(1), x], [mpf(0), mpf(1)], zero][order]
        columns.append([kernel(v, shape, order) for v in d] + [kernel(v, shape, order + 1) for v in d] + tail)
    result = solve(transposed, [list(row) for row in zip(*columns)])
    return np.array([[float(v) for v in row] for row in result]).T[:, : 2 * k]


def tables(shape):
    """Weights, and rows of N' and N'' at all Gauss points; coefficients are (value, slope) node by node."""
    h = LENGTH / (NODES - 1)
    x, w = np.polynomial.legendre.leggauss(POINTS)
    places = [(mpf(float(v)) + 1) / 2 for v in x]
    known, weights, rows = {}, [], {1: [], 2: []}
    for cell in range(NODES - 1):
        low, high = max(0, cell - NEIGHBOURS), min(NODES, cell + NEIGHBOURS + 2)
        support = (cell + 1 - low, high - cell - 1)
        for order in (1, 2):
            key = (support, order)
            if key not in known:
                known[key] = functions(*support, mpf(shape), places, order)
            local, k = known[key], high - low
            full = np.zeros((POINTS, 2 * NODES))
            full[:, 2 * low : 2 * high : 2] = local[:, :k] / h**order
            full[:, 2 * low + 1 : 2 * high : 2] = local[:, k:] / h ** (order - 1)
            rows[order].append(full)
        weights.append(w / 2 * h)
    return np.concatenate(weights), np.vstack(rows[1]), np.vstack(rows[2])


def turned(v):
    return np.stack([-v[..., 1], v[..., 0]], -1)


def outer(a, b):
    return a[:, :, None] * b[:, None, :]


def balance(q, moment, table):
    """Residual and tangent of the free beam."""
    w, n1, n2 = table
    r, s = n1 @ q, n2 @ q
    unit, g = np.eye(2), (r * r).sum(1)
    strain = (g - 1) / 2
    kappa = (r[:, 0] * s[:, 1] - r[:, 1] * s[:, 0]) / g
    a = -(turned(s) + 2 * kappa[:, None] * r) / g[:, None]
    b = turned(r) / g[:, None]
    curl = np.array([[0.0, 1.0], [-1.0, 0.0]])
    aa = -2 * (outer(a, r) + outer(r, a) + kappa[:, None, None] * unit) / g[:, None, None]
    ab = (curl - 2 * outer(r, b)) / g[:, None, None]
    k = kappa[:, None, None]
    h11 = AXIAL * (outer(r, r) + strain[:, None, None] * unit) + BENDING * (outer(a, a) + k * aa)
    h12 = BENDING * (outer(a, b) + k * ab)
    h22 = BENDING * outer(b, b)
    force = n1.T @ (w[:, None] * (AXIAL * strain[:, None] * r + BENDING * kappa[:, None] * a))
    force += n2.T @ (w[:, None] * BENDING * kappa[:, None] * b)
    add = lambda m, h, n: np.einsum("p,pi,pde,pj->idje", w, m, h, n, optimize=True)
    mixed = add(n1, h12, n2)
    tangent = add(n1, h11, n1) + mixed + mixed.transpose(2, 3, 0, 1) + add(n2, h22, n2)
    end = q[-1]
    square = end @ end
    force[-1] -= moment * turned(end) / square
    tangent[-1, :, -1, :] -= moment * (-curl - 2 * np.outer(turned(end), end) / square) / square
    return force, tangent


def equilibrium(q, moment, table):
    """Newton's method; None where it does not converge."""
    q = q.copy()
    for _ in range(25):
        force, tangent = balance(q, moment, table)
        n = 2 * 2 * NODES
        step = -np.linalg.solve(tangent.reshape(n, n)[4:, 4:], force.reshape(n)[4:])
        q[2:] += step.reshape(-1, 2)
        size = np.abs(step).max()
        if not size < 10:
            return None
        if size < 1e-9:
            return q
    return None


def roll_up(shape):
    table = tables(shape)
    q = np.zeros((2 * NODES, 2))
    q[::2, 0], q[1::2, 0] = np.linspace(0, LENGTH, NODES), 1
    moment, load, step = 2 * np.pi * BENDING / LENGTH, 0.0, 1 / 16
    while load < 1:
        new = equilibrium(q, min(load + step, 1.0) * moment, table)
        if new is None:
            step /= 2
            if step < 1e-4:
                return None
        else:
            q, load = new, load + step
    return q[-2]


if __name__ == "__main__":
    warnings.simplefilter("ignore")
    print("shape,distance,x,y")
    for shape in SHAPES:
        try:
            tip = roll_up(shape)
        except (np.linalg.LinAlgError, ZeroDivisionError):
            tip = None
        if tip is not None:
            print(f"{shape},{np.hypot(*tip):.2e},{tip[0]:.2e},{tip[1]:.2e}", flush=True)
