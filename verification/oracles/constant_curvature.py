"""Exact solutions whose curvature is constant: beams bent by end moments into circular arcs, in 40-digit arithmetic.

A moment M at the free end of a cantilever bends it to kappa = kappa_0 + M / EI with no axial force, so the centreline
keeps its length (exactly, for any strain measure):

    x(s) = sin(kappa s) / kappa      y(s) = (1 - cos(kappa s)) / kappa      theta(s) = kappa s

    python3 constant_curvature.py NAME
"""

import sys

from mpmath import mp, mpf, sin, cos, pi, nstr

mp.dps = 40
HEADER = ["s", "x", "y", "angle", "curvature", "strain"]


def digits(value):
    return "0" if abs(value) < mpf(10) ** -30 else nstr(value, 17, min_fixed=-8, max_fixed=17)


def show(header, rows):
    print(",".join(header))
    for row in rows:
        print(",".join(v if isinstance(v, str) else digits(v) for v in row))


def arc(length, curvature, angle=mpf(0), start=(mpf(0), mpf(0)), pieces=20):
    """Rows of HEADER along an arc that leaves `start` at `angle`."""
    rows = []
    for k in range(pieces + 1):
        s = length * k / pieces
        theta = angle + curvature * s
        if curvature == 0:
            x, y = start[0] + s * cos(angle), start[1] + s * sin(angle)
        else:
            x = start[0] + (sin(theta) - sin(angle)) / curvature
            y = start[1] - (cos(theta) - cos(angle)) / curvature
        rows.append([s, x, y, theta, curvature, mpf(0)])
    return rows


def roll_up():
    """The paper's beam, L = 1.8 m, M = lambda EI / L."""
    length = mpf("1.8")
    rows = []
    for quarters in (0, 1, 2, 3, 4, 40):  # lambda = quarters pi / 2
        rows += [[mpf(quarters)] + r for r in arc(length, quarters * pi / 2 / length, pieces=100)]
    show(["quarters"] + HEADER, rows)


def unbend():
    """A half circle of radius 1 that leaves the origin along x, straightened and bent the other way.

    factor f is the moment in units of -EI / R: kappa = 1 - f.
    """
    rows = []
    for factor in (1, 2):
        rows += [[mpf(factor)] + r for r in arc(pi, mpf(1 - factor))]
    show(["factor"] + HEADER, rows)


def axial_bar():
    """A bar under an end force along its axis: EA e(g) e'(g) = F, tip at g L, L = 2."""
    rows = []
    for ratio in ("0.1", "-0.1", "0.5"):
        load = mpf(ratio)
        rows.append(["engineering", load, 2 * (1 + load), load])
        g = 1 + load
        for _ in range(60):
            g -= (g**3 - g - 2 * load) / (3 * g**2 - 1)
        rows.append(["green", load, 2 * g, (g * g - 1) / 2])
    show(["measure", "ratio", "x", "strain"], rows)


def circle():
    """A circle of 3 m about the origin, from (R, 0) counter-clockwise."""
    curvature = 2 * pi / 3
    show(HEADER, arc(mpf(3), curvature, pi / 2, (1 / curvature, mpf(0)), 60))


def full_circle():
    """A beam of length 1 that a moment at its end has rolled up once, from the origin along x."""
    show(HEADER, arc(mpf(1), 2 * pi))


CASES = {"circle": circle, "full-circle": full_circle, "roll-up": roll_up, "unbend": unbend, "axial-bar": axial_bar}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: constant_curvature.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
