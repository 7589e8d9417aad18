"""A circle of 3 m interpolated from exact nodal positions and gradients, in 60-digit arithmetic.

The pseudo-strain energy is int EA eps^2 / 2 ds with eps = (r'.r' - 1)/2 and EA = 8000 pi N, by eight Gauss points in
every cell (exact for the cubic, whose integrand has degree 8). The distance is the largest | |r| - R | over 201 even places.

cubic    Hermite cubic between neighbouring nodes
rpim     Hermite radial point interpolation: the unknown coefficients of
             u = sum R(X - X_i) a_i + R'(X - X_i) b_i + c_0 + c_1 X,   R = (d^2 + alpha^2)^q
         meet value and slope at every node and  sum p_j(X_i) a_i + p_j'(X_i) b_i = 0;  q = 1.03, alpha = 3.3 spacings.

Written from these formulas alone; shares nothing with the program under test.

    python3 interpolation.py
"""

from mpmath import mp, mpf, matrix, sin, cos, pi, sqrt, lu_solve, nstr

mp.dps = 60
EA = 8000 * pi
RADIUS = mpf(3) / (2 * pi)


def gauss(n):
    """Abscissae and weights on [0, 1]: Newton's method on the recurrence of the Legendre polynomials."""
    points = []
    for i in range(1, n + 1):
        x = cos(pi * (i - mpf(1) / 4) / (n + mpf(1) / 2))
        for _ in range(12):
            before, p = mpf(1), x
            for k in range(1, n):
                before, p = p, ((2 * k + 1) * x * p - k * before) / (k + 1)
            slope = n * (before - x * p) / (1 - x * x)
            x -= p / slope
        points.append(((1 + x) / 2, 1 / ((1 - x * x) * slope**2)))
    assert abs(sum(w for _, w in points) - 1) < mpf(10) ** -50
    assert abs(sum(w * x ** (2 * n - 1) for x, w in points) - mpf(1) / (2 * n)) < mpf(10) ** -50
    return points


def exact(s):
    a = s / RADIUS
    return (RADIUS * cos(a), RADIUS * sin(a)), (-sin(a), cos(a))


def cubic(nodes, values, slopes, cell):
    """(position, gradient) as functions of xi in [0, 1] of a cell, one coordinate."""
    l = nodes[cell + 1] - nodes[cell]
    u0, u1, v0, v1 = values[cell], values[cell + 1], slopes[cell], slopes[cell + 1]
    def at(x):
        u = (1 - 3*x**2 + 2*x**3) * u0 + l * (x - 2*x**2 + x**3) * v0 + (3*x**2 - 2*x**3) * u1 + l * (x**3 - x**2) * v1
        d = (-6*x + 6*x**2) / l * u0 + (1 - 4*x + 3*x**2) * v0 + (6*x - 6*x**2) / l * u1 + (3*x**2 - 2*x) * v1
        return u, d
    return at


def rpim(nodes, values, slopes, cell, q=mpf("1.03"), alpha=mpf("3.3"), neighbours=2):
    low, high = max(0, cell - neighbours), min(len(nodes), cell + neighbours + 2)
    unit = (nodes[-1] - nodes[0]) / (len(nodes) - 1)
    middle = (nodes[low] + nodes[high - 1]) / 2
    place = [(s - middle) / unit for s in nodes[low:high]]
    n = len(place)
    R = lambda d: (d * d + alpha**2) ** q
    R1 = lambda d: 2 * q * d * (d * d + alpha**2) ** (q - 1)
    R2 = lambda d: 2 * q * (d * d + alpha**2) ** (q - 1) + 4 * q * (q - 1) * d * d * (d * d + alpha**2) ** (q - 2)
    G = matrix(2 * n + 2, 2 * n + 2)
    f = matrix(2 * n + 2, 1)
    for i, x in enumerate(place):
        for j, y in enumerate(place):
            G[i, j], G[i, n + j] = R(x - y), R1(x - y)
            G[n + i, j], G[n + i, n + j] = R1(x - y), R2(x - y)
        G[i, 2 * n], G[i, 2 * n + 1], G[n + i, 2 * n + 1] = 1, x, 1
        G[2 * n, i], G[2 * n + 1, i], G[2 * n + 1, n + i] = 1, x, 1
        f[i], f[n + i] = values[low + i], slopes[low + i] * unit
    c = lu_solve(G, f)
    l = nodes[cell + 1] - nodes[cell]
    def at(xi):
        x = (nodes[cell] + xi * l - middle) / unit
        u = sum(R(x - y) * c[j] + R1(x - y) * c[n + j] for j, y in enumerate(place)) + c[2 * n] + c[2 * n + 1] * x
        d = sum(R1(x - y) * c[j] + R2(x - y) * c[n + j] for j, y in enumerate(place)) + c[2 * n + 1]
        return u, d / unit
    return at


def measure(method, length, count):
    nodes = [length * i / (count - 1) for i in range(count)]
    data = [exact(s) for s in nodes]
    energy, distance = mpf(0), mpf(0)
    curves = []
    for cell in range(count - 1):
        curves.append([method(nodes, [p[k] for p, _ in data], [t[k] for _, t in data], cell) for k in (0, 1)])
        for xi, w in gauss(8):
            (_, dx), (_, dy) = (c(xi) for c in curves[-1])
            energy += EA / 2 * ((dx * dx + dy * dy - 1) / 2) ** 2 * w * (nodes[cell + 1] - nodes[cell])
    for i in range(201):
        s = length * i / 200
        cell = min(int(s / length * (count - 1)), count - 2)
        xi = (s - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
        (x, _), (y, _) = (c(xi) for c in curves[cell])
        distance = max(distance, abs(sqrt(x * x + y * y) - RADIUS))
    return energy, distance


if __name__ == "__main__":
    print("curve,basis,energy,distance")
    for curve, length, count in (("one-cell", mpf(1), 2), ("circle", mpf(3), 4)):
        for name, method in (("ancf", cubic), ("rpim", rpim)):
            energy, distance = measure(method, length, count)
            print(f"{curve},{name},{nstr(energy, 17)},{nstr(distance, 17)}")
