"""Planar elastica by shooting with scipy: what the oracles of whole scenes share.

State (x, y, theta, M, fx, fy) over a parameter p with ds/dp = `rate(p)`, s the reference arc length: f is the force that what
lies beyond s exerts on what lies before it, M the moment,

    x' = g cos theta    y' = g sin theta    theta' = k0 + M/EI    M' = -g (fy cos theta - fx sin theta)    f' = -q

with g = 1 + N/EA, N = f . t, or g = 1 for a beam that keeps its length; q is the load per reference length.
No node or element occurs here.
"""

from math import cos, sin

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import root


class Elastica:
    """`bending`, `axial`, `curvature` and `rate` are functions of the parameter, `load` one of the parameter and the state.

    No step is longer than `longest`: what acts on less than a step could be missed.
    """

    def __init__(self, bending, axial=None, curvature=None, rate=None, load=None, longest=np.inf):
        self.bending, self.axial, self.longest = bending, axial, longest
        self.curvature = curvature or (lambda p: 0.0)
        self.rate = rate or (lambda p: 1.0)
        self.load = load or (lambda p, state: (0.0, 0.0))

    def slope(self, p, state):
        x, y, theta, moment, fx, fy = state
        c, s, r = cos(theta), sin(theta), self.rate(p)
        g = r if self.axial is None else r * (1.0 + (fx * c + fy * s) / self.axial(p))
        qx, qy = self.load(p, state)
        return [g * c, g * s, r * (self.curvature(p) + moment / self.bending(p)), -g * (fy * c - fx * s), -r * qx, -r * qy]

    def integrate(self, state, span, at=None):
        """The state at the end of `span`, or at all parameters `at`."""
        found = solve_ivp(self.slope, span, state, method="DOP853", rtol=1e-13, atol=1e-15, t_eval=at, max_step=self.longest)
        assert found.success, found.message
        return found.y[:, -1] if at is None else found.y.T


def solve(residual, guess, scale=None, within=1e-9):
    """Root of a vector function, unknowns and residuals in units of their own sizes."""
    scale = np.ones(len(guess)) if scale is None else np.asarray(scale, float)
    found = root(lambda u: residual(u * scale), np.asarray(guess, float) / scale, method="hybr", options={"xtol": 1e-14})
    left = np.max(np.abs(residual(found.x * scale)))
    assert left < within, (found.message, left)
    return found.x * scale


def follow(problem, guess, values, scale=None, start=0.0, within=1e-9):
    """Roots of problem(value) for one value after the other from `start` on, where the root is about `guess`.

    Each is guessed from the two before it; where that fails, by way of a value in between.
    """
    found, path = [], [(start, np.asarray(guess, float))]

    def reach(value, depth=0):
        here, root_here = path[-1]
        guess = root_here
        if len(path) > 1:
            before, root_before = path[-2]
            guess = root_here + (root_here - root_before) * (value - here) / (here - before)
        try:
            path.append((value, solve(problem(value), guess, scale, within)))
        except AssertionError:
            assert depth < 12, (value, root_here)
            reach((here + value) / 2, depth + 1)
            reach(value, depth + 1)

    for value in values:
        reach(value)
        found.append(path[-1][1])
    return found


def show(header, rows):
    print(",".join(header))
    for row in rows:
        print(",".join(v if isinstance(v, str) else f"{v:.13g}" for v in row))
