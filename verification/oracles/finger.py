"""A soft finger that closes upon a disc, by shooting from its tip.

The finger stands at (34 mm, 0) and is 110 mm long, EI = 2e-3 N m^2, EA = 400 N, 6 mm thick. From 15 mm on it would like to bend
to the left with the curvature k0, an actuation; a disc of radius 25 mm about (0, 70 mm) is in its way, with a pressure per length of
1e5 N/m^2 times the depth to which the finger's surface is in it. From the tip, which is free, its place and angle are shot so that the
foot is where it is.

    python3 finger.py
"""

from math import hypot, pi

import numpy as np
from planar import Elastica, follow, show

FOOT, LENGTH, START = np.array([0.034, 0.0]), 0.11, 0.015
BENDING, AXIAL, HALF = 2e-3, 400.0, 3e-3
CENTRE, RADIUS, PENALTY = (0.0, 0.07), 0.025, 1e5


def press(p, state):
    x, y = state[0] - CENTRE[0], state[1] - CENTRE[1]
    distance = hypot(x, y)
    q = PENALTY * max(0.0, RADIUS + HALF - distance) / distance
    return q * x, q * y


def foot(tip, curvature, whole=False):
    """What is missed at the foot, the finger integrated from its tip down; or its state there."""
    beam = Elastica(lambda p: BENDING, lambda p: AXIAL, load=press, longest=LENGTH / 300)
    beam.curvature = lambda p: curvature
    upper = beam.integrate([*tip, 0.0, 0.0, 0.0], (LENGTH, START))
    beam.curvature = lambda p: 0.0
    end = beam.integrate(upper, (START, 0.0))
    return end if whole else np.array([*(end[:2] - FOOT) / LENGTH, end[2] - pi / 2])


if __name__ == "__main__":
    values = 30.0 * np.arange(1, 37) / 36
    tips = follow(lambda k0: lambda u: foot(u, k0), [FOOT[0], LENGTH, pi / 2], values, [0.1, 0.1, 1.0], within=1e-7)
    rows = []
    for curvature, tip in list(zip(values, tips))[2::3]:
        end = foot(tip, curvature, whole=True)
        rows.append([curvature / 30, *tip, -end[4], -end[5], -end[3]])
    show(["load", "x", "y", "angle", "fx", "fy", "moment"], rows)
