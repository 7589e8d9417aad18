"""A recurve bow, braced and drawn, by shooting of one limb.

The limb stands on the riser at (0, 0.1) m: straight for 450 mm, EI from 50 to 26 N m^2, then 200 mm with the radius 0.5 m away from
the archer, EI from 26 to 18; EA = 2 MN. Half of the string is straight, 700 mm long, and keeps its length; it pulls at the tip
along itself. By symmetry the nock moves along y = 0. From the riser the moment and the force there are shot, so that the tip has no
moment, the nock is at the string's length from it, and the force points there.

    python3 bow.py            pull of the hand, energy of the bow, and place of the upper tip over the nock
"""

import numpy as np
from planar import Elastica, follow, show, solve

LOW, HIGH, STRING, AXIAL = 0.45, 0.2, 0.7, 2e6


def limb(u, at=None):
    """Tip of the limb, whose forces at the riser are u = (M, fx, fy), and its energy."""
    energy = 0.0
    state = [0.0, 0.1, np.pi / 2, *u]
    for length, ends, curvature in ((LOW, (50.0, 26.0), 0.0), (HIGH, (26.0, 18.0), -2.0)):
        bending = lambda s: ends[0] + (ends[1] - ends[0]) * s / length
        beam = Counting(bending, lambda s: AXIAL, lambda s: curvature)
        *state, energy = beam.integrate([*state, energy], (0.0, length))
    return np.array(state), energy


class Counting(Elastica):
    """The seventh number of the state is the energy."""

    def slope(self, p, state):
        *here, _ = state
        axial = here[4] * np.cos(here[2]) + here[5] * np.sin(here[2])
        return [*super().slope(p, here), here[3] ** 2 / (2 * self.bending(p)) + axial**2 / (2 * AXIAL)]


def drawn(nock):
    def residual(u):
        (x, y, _, moment, fx, fy), _ = limb(u)
        to = np.array([nock - x, -y])
        return np.array([moment, np.hypot(*to) - STRING, (fx * to[1] - fy * to[0]) / 100.0])

    return residual


def braced(u):
    """No hand: the string is straight from tip to tip."""
    (x, y, _, moment, fx, fy), _ = limb(u)
    return np.array([moment, y - STRING, fx / 100.0])


SCALE = [10.0, 100.0, 100.0]


def at_rest():
    """Moment and force at the riser of the braced bow.

    The string's tension T bends the limb by its distance, some 0.2 m: the first guess that leads to a limb bent to the archer.
    """
    for tension in range(100, 900, 20):
        try:
            rest = solve(braced, [0.2 * tension, 0.0, -tension], SCALE)
        except AssertionError:
            continue
        if limb(rest)[0][0] < -0.1:
            return rest
    raise ArithmeticError("no braced bow")


if __name__ == "__main__":
    rest = at_rest()
    (x, *_), _ = limb(rest)
    rows = []
    values = x - 0.015 * np.arange(1, 31)
    for k, (nock, u) in enumerate(zip([x, *values], [rest, *follow(drawn, rest, values, SCALE, x)])):
        end, energy = limb(u)
        rows.append([nock, k / 30, 2 * end[4], 2 * energy, end[0], end[1]])
    show(["nock", "load", "fx", "stored", "x", "y"], rows)
