"""The curved beam of Qiu, Lang and Slocum: a cosine without stress, pressed at its middle, which cannot turn.

    python3 bistable.py shooting    half of the beam as the extensible elastica
    python3 bistable.py published   their formula for small slopes

l = 3 mm, h = 60 um, t = 10 um: Q = h/t = 6; E = 160 GPa, width 490 um in the mean. By symmetry half of the beam; the force
of this half, upwards, against the place of the middle. In the paper f l^3/(E I h) is given for the whole beam over d/h; the
load factor is d/2h.
"""

import sys
from math import cos, pi, sin, sqrt

import numpy as np
from planar import Elastica, follow, show

# In units of l, and of E I/l^2 for forces.
RISE, THICKNESS = 0.02, 0.02 / 6
SPAN, MODULUS, WIDTH = 3e-3, 160e9, 490e-6
FORCE = MODULUS * WIDTH * (THICKNESS * SPAN) ** 3 / 12 / SPAN**2


def shooting():
    """The width is 1 % above its mean at the clamp and 1 % below at the middle, even in between.

    A half of even width would be symmetric about its quarter, and its path divided where the third mode begins.
    """
    slope = lambda x: pi * RISE * sin(2 * pi * x)
    bend = lambda x: 2 * pi**2 * RISE * cos(2 * pi * x)
    length = sum(sqrt(1 + slope(x) ** 2) for x in np.linspace(0, 0.5, 2000, endpoint=False) + 1 / 8000) / 4000
    rate = lambda x: sqrt(1 + slope(x) ** 2)


    class Half(Elastica):
        def slope(self, x, whole):
            width = 1.01 - 0.02 * whole[6] / length
            self.bending = lambda p: width
            self.axial = lambda p: 12 / THICKNESS**2 * width
            return [*super().slope(x, whole[:6]), rate(x)]

    beam = Half(bending=None, curvature=lambda x: bend(x) / (1 + slope(x) ** 2) ** 1.5, rate=rate)

    def problem(d):
        def residual(u):
            end = beam.integrate([0, 0, 0, *u, 0], (0, 0.5))
            return np.array([end[0] - 0.5, end[1] - RISE * (1 - d), end[2]]) / RISE

        return residual

    roots = follow(problem, np.zeros(3), np.linspace(0, 2, 161)[1:], [1.0, 100.0, 1.0])
    rows = [[k / 160, RISE * SPAN * (1 - k / 80), u[2] * FORCE] for k, u in enumerate(roots, 1)]
    show(["load", "y", "force"], rows[3::4])


def published():
    """Eq. (39) of the paper, F3 = 8 pi^4 - 6 pi^4 D: the straight line of the third mode, D = 0.2 to 1.85 of the rise."""
    rows = []
    for d in np.arange(4, 38) / 20:
        rows.append([d / 2, RISE * SPAN * (1 - d), -(pi**4) * (8 - 6 * d) * RISE * FORCE / 2])
    show(["load", "y", "force"], rows)


CASES = {"shooting": shooting, "published": published}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: bistable.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
