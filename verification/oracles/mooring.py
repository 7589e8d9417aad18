"""A mooring chain on the seabed, by quadrature of its balance.

The chain, EA = 100 MN, weighs w = 1 kN per metre of its stress-free length in the water, which is 600 m, and lies from its anchor on
a seabed that yields: pressure per length k = 1e5 N/m^2 times the depth by which it sinks. With H the horizontal force, N the axial
force and f(y) = w y + k y^2/2 for y < 0, w y above, N + N^2/(2 EA) - f(y) is the same everywhere. The resting part lies at
-w/k, where the anchor is, with N = H. Where the chain leaves the ground, at y = 0, N follows from this; above, it is an extensible
catenary; below, x and s are quadratures over y.

    python3 mooring.py still       forces at the fairlead, 100 m above, where it is at x
    python3 mooring.py current     the same in a current of 1.5 m/s along x, by shooting: across the chain, each metre of its stress-free
                                   length resists by 100 N s^2/m^2 times the square of the velocity across
"""

import sys

import numpy as np
from mpmath import asinh, exp, findroot, log, mp, mpf, quad, sqrt
from scipy.integrate import solve_ivp
from scipy.optimize import root
from static_beam import show

mp.dps = 25
AXIAL, WEIGHT, LENGTH, GROUND = mpf("1e8"), mpf(1000), mpf(600), mpf("1e5")
REST = -WEIGHT / GROUND


def axial(invariant):
    """N of N + N^2/(2 EA)."""
    return AXIAL * (sqrt(1 + 2 * invariant / AXIAL) - 1)


def lift_off(h):
    """N at y = 0, the stress-free length between -w/k (1 - 1e-4) and y = 0, and the span that it lacks to lying."""
    base = h + h**2 / (2 * AXIAL) + WEIGHT**2 / (2 * GROUND)
    # With y = REST + t^2 what is integrated is smooth; the resting part is approached for ever, lacking less and less.
    def lack(t):
        y = REST + t * t
        n = axial(base + WEIGHT * y + GROUND * y * y / 2)
        rise = sqrt(n * n - h * h) / n * (1 + n / AXIAL)
        return (1 - h / n) / rise * 2 * t

    return axial(base), quad(lack, [mpf("1e-4"), sqrt(-REST)])


def balance(h, free):
    """Span and height of the fairlead, and the force there, for the horizontal force and the length that hangs."""
    low, lacking = lift_off(h)
    v0 = sqrt(low**2 - h**2)
    v1 = v0 + WEIGHT * free
    high = sqrt(h**2 + v1**2)
    x = h * free / AXIAL + h / WEIGHT * (asinh(v1 / h) - asinh(v0 / h))
    y = (high - low) / WEIGHT + (high**2 - low**2) / (2 * AXIAL * WEIGHT)
    return (LENGTH - free) * (1 + h / AXIAL) - lacking + x, y, v1, high


def fairlead(x, y, guess):
    miss = lambda u, free: [a - b for a, b in zip(balance(exp(u), free)[:2], (x, y))]
    u, free = findroot(miss, (log(guess[0]), guess[1]))
    h = exp(u)
    _, _, v, n = balance(h, free)
    return h, v, n, free


def still():
    rows, guess = [], (mpf(35000), mpf(130))
    for x in (540, 550, 560):
        h, v, n, free = fairlead(mpf(x), mpf(100), guess)
        guess = (h, free)
        rows.append([mpf(x), h, v, n, free])
    show(["x", "fx", "fy", "tension", "hanging"], rows)


def current(x=560.0, height=100.0, flow=1.5, drag=100.0):
    """Shooting from where the chain leaves the ground: the horizontal force there and the length that hangs.

    Upon the ground the chain is too flat to be pushed: 0.02 N/m at most against a weight of 1 kN/m.
    """
    weight, axial = float(WEIGHT), float(AXIAL)

    def hanging(u):
        h, free = u
        low, lacking = (float(v) for v in lift_off(mpf(h)))

        def slope(s, state):
            _, _, fx, fy = state
            n = np.hypot(fx, fy)
            across = flow * -fy / n  # of the flow, along the normal (-fy, fx)/n
            push = drag * abs(across) * across
            g = 1 / n + 1 / axial
            return [fx * g, fy * g, push * fy / n, -push * fx / n + weight]

        first = [(float(LENGTH) - free) * (1 + h / axial) - lacking, 0.0, h, np.sqrt(low**2 - h**2)]
        return solve_ivp(slope, (0.0, free), first, method="DOP853", rtol=1e-12, atol=1e-9).y[:, -1]

    h, _, _, free = (float(u) for u in fairlead(mpf(x), mpf(height), (mpf(100000), mpf(175))))
    found = root(lambda u: hanging(u)[:2] - [x, height], [h, free], tol=1e-13)
    end = hanging(found.x)
    assert np.hypot(end[0] - x, end[1] - height) < 1e-8, end
    show(["x", "fx", "fy"], [[mpf(x), mpf(end[2]), mpf(end[3])]])


CASES = {"still": still, "current": current}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: mooring.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
