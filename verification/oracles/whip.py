"""A whip as a chain of rigid links with elastic hinges, integrated by scipy, with ever more links.

The whip is 2 m long, 60 g/m at its handle and 3 g/m at its tip, EI from 0.4 to 4e-3 N m^2, both even in between. It lies along x. In
0.15 s the handle turns it to the left by 150 degrees, by 10 u^3 - 15 u^4 + 6 u^5. Nothing else acts.

A chain of N links has the masses of their halves on its joints and torsion springs EI/l on them; the first is held to the
handle over half a link. Its tip errs by c/N^2, so that two chains tell where the whip is.

    python3 whip.py
"""

import sys

import numpy as np
from planar import show
from scipy.integrate import solve_ivp
from scipy.linalg import solve_banded

LENGTH, MASS, BENDING, TURN, TIME = 2.0, (0.06, 0.003), (0.4, 4e-3), np.radians(150), 0.15


def even(ends, s):
    return ends[0] + (ends[1] - ends[0]) * s / LENGTH


def handle(t):
    u = min(t / TIME, 1.0)
    return TURN * (10 * u**3 - 15 * u**4 + 6 * u**5)


def chain(n, times):
    """Place and velocity of the tip of n links."""
    l = LENGTH / n
    s = l * np.arange(n + 1)
    # The mass between the middles of the links beside a joint; that of the half before the tip.
    edges = np.concatenate([[0.0], s[:-1] + l / 2, [LENGTH]])
    lumps = even(MASS, (edges[:-1] + edges[1:]) / 2) * np.diff(edges)
    mass, spring = lumps[1:], even(BENDING, s[:-1]) / l
    spring[0] *= 2

    def accelerations(t, angle, rate):
        e = np.array([np.cos(angle), np.sin(angle)])
        across = np.array([-e[1], e[0]])
        torque = spring * np.diff(angle, prepend=handle(t))  # of the hinge at the start of each link
        couple = np.append(torque[1:], 0.0) - torque  # on each link
        push = across * couple / l  # on its far end, and the opposite on its near end
        force = push.copy()
        force[:, :-1] -= push[:, 1:]
        # Tensions N keep the lengths: e.(a_i - a_(i-1)) = -l rate^2, m_i a_i = N_(i+1) e_(i+1) - N_i e_i + force_i.
        turn = np.sum(e[:, 1:] * e[:, :-1], axis=0)
        inverse = 1 / mass
        bands = np.zeros((3, n))
        bands[1] = inverse
        bands[1, 1:] += inverse[:-1]
        bands[0, 1:] = -inverse[:-1] * turn
        bands[2, :-1] = -inverse[:-1] * turn
        free = force * inverse
        right = np.sum(e * np.diff(free, axis=1, prepend=0.0), axis=0) + l * rate**2
        tension = solve_banded((1, 1), bands, right)
        pull = e * tension
        a = free - pull * inverse
        a[:, :-1] += pull[:, 1:] * inverse[:-1]
        return np.sum(across * np.diff(a, axis=1, prepend=0.0), axis=0) / l

    def slope(t, state):
        return np.concatenate([state[n:], accelerations(t, state[:n], state[n:])])

    found = solve_ivp(slope, (0.0, times[-1]), np.zeros(2 * n), method="DOP853", rtol=1e-9, atol=1e-9, t_eval=times)
    assert found.success, found.message
    angle, rate = found.y[:n], found.y[n:]
    place = l * np.array([np.cos(angle).sum(axis=0), np.sin(angle).sum(axis=0)])
    velocity = l * np.array([(-np.sin(angle) * rate).sum(axis=0), (np.cos(angle) * rate).sum(axis=0)])
    return np.concatenate([place, velocity]).T


if __name__ == "__main__":
    times = np.linspace(0.0, 0.34, 35)[1:]
    chains = [chain(n, times) for n in (80, 160, 320)]
    first, second = (b + (b - a) / 3 for a, b in zip(chains, chains[1:]))
    print("two extrapolations apart:", np.abs(second - first).max(axis=0), file=sys.stderr)
    show(["t", "x", "y", "vx", "vy"], [[t, *row] for t, row in zip(times, second)])
