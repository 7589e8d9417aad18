"""A cantilever that a dead tip force presses on a disc, by shooting.

The state (x, y, theta, M, Fx, Fy) and the penetration's energy obey, with g = 1 + F . t / EA and the pressure p = k <R - |r - c|>,

    x' = g cos(theta)    y' = g sin(theta)    theta' = M / EI    M' = -g (F . n)    F' = -p (r - c) / |r - c|    W' = p^2 / 2k

from a clamp, where F and M are the unknowns, to the tip, where F = (0, -P) and M = 0. The force is raised in steps.

    python3 contact.py
"""

import numpy as np
from scipy.integrate import solve_ivp

LENGTH, AXIAL, BENDING, PENALTY = 1.0, 1e4, 1.0, 1e4
CENTRE, RADIUS = np.array([0.4, -0.25]), 0.2
PLACES = np.linspace(0, LENGTH, 41)


def slope(_, state):
    x, y, angle, moment, fx, fy, _ = state
    c, s = np.cos(angle), np.sin(angle)
    g = 1 + (fx * c + fy * s) / AXIAL
    away = np.array([x, y]) - CENTRE
    distance = np.hypot(*away)
    pressure = PENALTY * max(RADIUS - distance, 0)
    px, py = pressure * away / distance
    return [g * c, g * s, moment / BENDING, g * (fx * s - fy * c), -px, -py, pressure**2 / (2 * PENALTY)]


def path(unknown, dense=False):
    """States at the places, or at the tip alone."""
    start = [0, 0, 0, unknown[0], unknown[1], unknown[2], 0]
    # The pressure has a kink where contact begins: short steps keep it from being missed.
    found = solve_ivp(
        slope, (0, LENGTH), start, "DOP853", PLACES if dense else None, rtol=1e-11, atol=1e-12, max_step=0.01
    )
    return found.y.T if dense else found.y[:, -1]


def equilibrium(force, unknown):
    def missed(z):
        tip = path(z)
        return np.array([tip[3], tip[4], tip[5] + force])

    for _ in range(30):
        steps = 1e-6 * np.maximum(1, np.abs(unknown))
        matrix = np.array([(missed(unknown + e) - missed(unknown - e)) / (2 * e.max()) for e in np.diag(steps)]).T
        change = np.linalg.solve(matrix, missed(unknown))
        unknown = unknown - change
        if np.abs(change).max() < 1e-9:
            return unknown
    raise RuntimeError(f"no equilibrium under {force}")


if __name__ == "__main__":
    unknown = np.array([-0.25, 0, -0.25])
    for force in np.arange(0.25, 8.01, 0.25):
        unknown = equilibrium(force, unknown)
    print("s,x,y,angle,bending_moment,clamp_x,clamp_y,stored")
    states = path(unknown, dense=True)
    for s, (x, y, angle, moment, *_, _) in zip(PLACES, states):
        print(
            ",".join(f"{v:.11g}" for v in (s, x, y, angle, moment, -unknown[1], -unknown[2], states[-1, 6]))
        )
