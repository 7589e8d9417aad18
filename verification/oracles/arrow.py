"""The flight of an arrow from a drawn bow: one limb and half of the string as a chain of rigid links, integrated by scipy.

The bow is that of bow.py, drawn by 45 cm. Limb and tip are rigid links with half of their masses at each end and torsion springs
EI/l between them, whose rest is the stress-free curvature; the string, 5 g/m, is links without springs; its end carries half of the
arrow's 24 g and moves along y = 0. Limb and string keep their lengths, and the arrow is rigid. The place of the nock errs by c/l^2, so that
two chains tell where it is.

    python3 arrow.py
"""

import sys

import bow
import numpy as np
from planar import show
from scipy.integrate import solve_ivp
from scipy.linalg import solve_banded
from scipy.optimize import root

DRAWN, ARROW, STRING_MASS = 0.45, 0.024, 0.005


def even(ends, part):
    return ends[0] + (ends[1] - ends[0]) * part


def chain(k, nock, times):
    """Place and speed of the nock, for 13 k links of 50/k mm in the limb and 7 k of 100/k mm in the string."""
    l, limb, stringy = 0.05 / k, 13 * k, 7 * k
    s = l * np.arange(limb + 1)
    inner = s <= bow.LOW + 1e-9
    bending = np.where(inner, even((50.0, 26.0), s / bow.LOW), even((26.0, 18.0), (s - bow.LOW) / bow.HIGH))
    middle = s[:-1] + l / 2
    mass = l * np.where(middle < bow.LOW, even((0.24, 0.15), middle / bow.LOW), even((0.15, 0.11), (middle - bow.LOW) / bow.HIGH))
    spring = bending[:-1] / l
    spring[0] *= 2
    rest = np.where(s[:-1] > bow.LOW + 1e-9, -2.0 * l, 0.0)
    rest[9 * k] = -2.0 * l / 2  # the tip begins at this joint
    rest[0] = 0.0

    # The drawn bow: the moment of the string's pull T about each joint is the spring's.
    def balance(u):
        angle, direction, pull = u[:limb], u[limb], u[limb + 1] * 100.0
        x, y = l * np.cumsum(np.cos(angle)), 0.1 + l * np.cumsum(np.sin(angle))
        fx, fy = pull * np.cos(direction), pull * np.sin(direction)
        before_x, before_y = np.append(0.0, x[:-1]), np.append(0.1, y[:-1])
        moment = (x[-1] - before_x) * fy - (y[-1] - before_y) * fx
        turned = np.diff(angle, prepend=np.pi / 2) - rest
        ends = [x[-1] + bow.STRING * np.cos(direction) - nock, y[-1] + bow.STRING * np.sin(direction)]
        return np.concatenate([(spring * turned - moment) / 50.0, ends])

    guess = np.concatenate([np.pi / 2 + np.minimum(1.9 * s[:-1], 0.9), [-2.0, 2.0]])
    found = root(balance, guess, tol=1e-13)
    assert np.abs(balance(found.x)).max() < 1e-9, found.message

    n = limb + stringy
    lengths = np.concatenate([np.full(limb, l), np.full(stringy, bow.STRING / stringy)])
    weights = np.concatenate([mass, np.full(stringy, STRING_MASS * bow.STRING / stringy)])
    lumps = (weights + np.append(weights[1:], 0.0)) / 2
    lumps[-1] += ARROW / 2
    inverse, unit = 1 / lumps, np.zeros((2, n))
    unit[1, -1] = 1.0

    def accelerations(state):
        angle, rate = state[:n], state[n:]
        e = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-e[1], e[0]])
        torque = np.zeros(n + 1)
        torque[:limb] = spring * (np.diff(angle[:limb], prepend=np.pi / 2) - rest)
        push = across * np.diff(torque) / lengths
        force = push.copy()
        force[:, :-1] -= push[:, 1:]
        turn = np.sum(e[:, 1:] * e[:, :-1], axis=0)
        bands = np.zeros((3, n))
        bands[1] = inverse
        bands[1, 1:] += inverse[:-1]
        bands[0, 1:] = bands[2, :-1] = -inverse[:-1] * turn
        right = [np.sum(e * np.diff(f * inverse, axis=1, prepend=0.0), axis=0) for f in (force, unit)]
        right[0] += lengths * rate**2
        tension = solve_banded((1, 1), bands, np.array(right).T).T

        def moved(f, pull):
            a = (f - e * pull) * inverse
            a[:, :-1] += e[:, 1:] * pull[1:] * inverse[:-1]
            return a

        free, guided = moved(force, tension[0]), moved(unit, tension[1])
        # The nock stays on y = 0, also against what round-off adds up to.
        y, vy = 0.1 + np.sum(lengths * e[1]), np.sum(lengths * rate * e[0])
        a = free - guided * (free[1, -1] + 1e3 * vy + 1e6 * y) / guided[1, -1]
        return np.sum(across * np.diff(a, axis=1, prepend=0.0), axis=0) / lengths

    start = np.concatenate([found.x[:limb], np.full(stringy, found.x[limb]), np.zeros(n)])
    slope = lambda _, state: np.concatenate([state[n:], accelerations(state)])
    path = solve_ivp(slope, (0.0, times[-1]), start, method="DOP853", rtol=1e-8, atol=1e-8, t_eval=times)
    assert path.success, path.message
    angle, rate = path.y[:n], path.y[n:]
    x = np.sum(lengths[:, None] * np.cos(angle), axis=0)
    return np.array([x, np.sum(-lengths[:, None] * np.sin(angle) * rate, axis=0)]).T


if __name__ == "__main__":
    rest = bow.at_rest()
    nock = bow.limb(rest)[0][0] - DRAWN
    times = np.linspace(0.0, 0.014, 29)
    chains = [chain(k, nock, times) for k in (1, 2, 4)]
    first, second = (b + (b - a) / 3 for a, b in zip(chains, chains[1:]))
    print("two extrapolations apart:", np.abs(second - first).max(axis=0), file=sys.stderr)
    show(["t", "x", "vx"], [[t, *row] for t, row in zip(times, second)])
