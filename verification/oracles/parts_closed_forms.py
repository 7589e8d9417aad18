"""Closed forms of single parts: hubs, strings, foundations, masses, damping, travelling forces, fluids.

Each subcommand states its formula and prints one CSV table.

    python3 parts_closed_forms.py NAME
"""

import sys

from mpmath import mp, mpf, atan, cos, cosh, sin, sinh, sqrt, tan, tanh, exp, log, pi, besseljzero, findroot, acosh, asinh, nstr

mp.dps = 30


def table(columns, rows):
    print(",".join(columns))
    for row in rows:
        print(",".join(nstr(mpf(value), 15) for value in row))


def spin_up():
    """Steady rotation: EA r'' = -rho A Omega^2 r, r(0) = 0, r'(L) = 1, so r = sin(ks) / (k cos(kL)) at the angle of the hub."""
    length, speed, axial, mass, angle = mpf(10), mpf(6), mpf("2.8e7"), mpf("1.2"), 6 * mpf("12.5")
    k = speed * sqrt(mass / axial)
    rows = []
    for i in range(21):
        s = length * i / 20
        r = sin(k * s) / (k * cos(k * length))
        rows.append((s, r * cos(angle), r * sin(angle), cos(k * s) / cos(k * length) - 1))
    table(("s", "x", "y", "strain"), rows)


if __name__ == "__main__":
    globals()[sys.argv[1].replace("-", "_")]()
