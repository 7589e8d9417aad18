"""A fly rod that a fish bends, by shooting from its tip.

The rod of 2.7 m stands at 60 degrees; its round section tapers evenly from 11 mm to 2 mm, E = 38 GPa, 1900 kg/m^3. It carries its
weight and, at its tip, the fish's pull of 7 N, 50 degrees below the horizon.

    python3 fly_rod.py
"""

from math import pi

import numpy as np
from planar import Elastica, follow, show

LENGTH, MODULUS, DENSITY, GRAVITY = 2.7, 38e9, 1900.0, 9.81
PULL = 7.0 * np.array([np.cos(np.radians(50)), -np.sin(np.radians(50))])


def diameter(s):
    return 0.011 + (0.002 - 0.011) * s / LENGTH


def area(s):
    return pi * diameter(s) ** 2 / 4


def rod(part):
    return Elastica(
        lambda s: MODULUS * pi * diameter(s) ** 4 / 64,
        lambda s: MODULUS * area(s),
        load=lambda s, _: (0.0, -part * DENSITY * GRAVITY * area(s)),
    )


def clamp(part):
    return lambda u: np.array([rod(part).integrate([0, 0, u[0], 0, *(part * PULL)], (LENGTH, 0))[2] - pi / 3])


if __name__ == "__main__":
    angle = follow(clamp, [pi / 3], np.linspace(0, 1, 21)[1:])[-1][0]
    s = np.linspace(LENGTH, 0, 28)
    path = rod(1.0).integrate([0, 0, angle, 0, *PULL], (LENGTH, 0), s)[::-1]
    x, y = path[0][:2]
    rows = [[v, p[0] - x, p[1] - y, p[2], p[3]] for v, p in zip(s[::-1], path)]
    show(["s", "x", "y", "angle", "bending_moment"], rows)
