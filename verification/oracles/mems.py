"""A bridge below an electrode, pulled in upon a stop that keeps it from the electrode, by shooting along its path.

The bridge of 400 um is clamped at both ends, 40 um wide, 2 um thick, of 160 GPa; the electrode 3 um above its upper face, from
100 um to 300 um; a stop with k = 1e8 N/m^2 at 2.4 um above its upper face. Load per reference length

    q_y = l e w V^2/(2 g^2) (1 + 0.65 g/w) - k <-gap to the stop>,    V = 40 V, l the load factor

Half of it, from the middle, where it is level. Along the path its deflection grows throughout: for each the moment, the axial
force and the load factor are shot.

    python3 mems.py path       load factor against the deflection of the middle, short of the stop
    python3 mems.py limits     pull-in, and the load factor at which it touches the stop and would come off
    python3 mems.py states     deflection of the middle: open at 85 % of the load, pulled in and held by 95 %
"""

import sys

import numpy as np
from planar import Elastica, follow, show, solve

UNIT = 400e-6
WIDTH, HEIGHT, GAP, STOP = 40e-6, 2e-6, 3e-6, 2.4e-6
MODULUS, VOLTAGE, PERMITTIVITY, FRINGE, PENALTY = 160e9, 40.0, 8.8541878128e-12, 0.65, 1e8
BENDING = MODULUS * WIDTH * HEIGHT**3 / 12
AXIAL = MODULUS * WIDTH * HEIGHT * UNIT**2 / BENDING
# Per length, in EI/UNIT^3.
PULL = PERMITTIVITY * WIDTH * VOLTAGE**2 / 2 * UNIT**3 / BENDING
STIFF = PENALTY * UNIT**4 / BENDING


def bridge(u):
    """From the middle (x = 0) to the clamp at x = 1/2, in units of UNIT and EI."""
    y, moment, fx, load = u

    def across(pull):
        def force(p, state):
            gap = GAP / UNIT - state[1]
            q = load * PULL * (1 / gap**2 + FRINGE * UNIT / WIDTH / gap) / UNIT**2 if pull else 0.0
            return 0.0, q - STIFF * max(0.0, state[1] - STOP / UNIT)

        return force

    beam = Elastica(bending=lambda p: 1.0, axial=lambda p: AXIAL)
    beam.load = across(True)
    inner = beam.integrate([0, y, 0, moment, fx, 0], (0, 0.25))
    beam.load = across(False)
    end = beam.integrate(inner, (0.25, 0.5))
    return np.array([end[0] - 0.5, end[1], end[2]]) / (HEIGHT / UNIT)


def at(y):
    """The other unknowns where the middle is at y."""
    return lambda rest: bridge([y, *rest])


SCALE = [0.1, 10.0, 1.0]
EVEN = STOP / UNIT * np.arange(1, 41) / 40


def free():
    return follow(at, np.zeros(3), EVEN, SCALE)


def show_path():
    show(["y", "load"], [[y * UNIT, u[2]] for y, u in zip(EVEN, free())][:-1])


def limits():
    roots = free()
    top = max(range(len(roots)), key=lambda k: roots[k][2])
    # The largest load factor by the polynomial through nine deflections around it.
    step = STOP / UNIT / 200
    near = [EVEN[top] + k * step for k in range(-4, 5)]
    loads = [solve(at(y), roots[top], SCALE)[2] for y in near]
    fit = np.polynomial.Polynomial.fit(near, loads, 8)
    place = min((r.real for r in fit.deriv().roots() if abs(r.imag) < 1e-9), key=lambda r: abs(r - EVEN[top]))
    show(["pull_in", "y", "release"], [[fit(place), place * UNIT, roots[-1][2]]])


def states():
    """The middle where the load factor is given: on the way to pull-in, and on the stop."""
    roots = free()
    to = lambda load: lambda u: bridge([u[0], u[1], u[2], load])
    scale = [1e-2, 0.1, 10.0]
    k = next(k for k, u in enumerate(roots) if u[2] > 0.85)
    opened = solve(to(0.85), [EVEN[k], *roots[k][:2]], scale)
    # From the stop on by deflections, to where the load factor is about what is wanted.
    upon = follow(at, roots[-1], EVEN[-1] + 1e-6 * np.arange(1, 18), SCALE, EVEN[-1])
    closed = solve(to(0.95), [EVEN[-1] + 17e-6, *upon[-1][:2]], [1e-4, 0.1, 10.0])
    show(["state", "load", "y"], [["open", 0.85, opened[0] * UNIT], ["held", 0.95, closed[0] * UNIT]])


CASES = {"path": show_path, "limits": limits, "states": states}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: mems.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
