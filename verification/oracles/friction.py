"""Closed forms of dry friction whose contact sticks by springs, elastic slip e = mu p / k_t at most.

Each subcommand states its formula and prints one CSV table.

    python3 friction.py NAME
"""

import sys

from mpmath import asin, cos, mp, mpf, nstr, sin, sqrt

mp.dps = 30


def table(columns, rows):
    print(",".join(columns))
    for row in rows:
        print(",".join(nstr(mpf(value), 15) for value in row))


def sliding():
    """A rod of 1 kg/m starts with 2 m/s on rough ground, mu = 0.4, k_t = 1000 N/m^2. First the springs are stretched, x = v0/w sin(w t), until x = e; it slides with
    x'' = -mu g until it stands; then it swings on the springs, x = X - e + e cos(w (t - T)). Lost is mu m g times the way that it slides."""
    speed, stiffness, mass, gravity, friction = mpf(2), mpf(1000), mpf(1), mpf("9.81"), mpf("0.4")
    w, e = sqrt(stiffness / mass), friction * mass * gravity / stiffness
    grip = asin(e * w / speed) / w
    after = speed * cos(w * grip)
    stop = grip + after / (friction * gravity)
    reach = e + after**2 / (2 * friction * gravity)
    rows = []
    for i in range(41):
        t = mpf(i) / 50
        if t < grip:
            x, v, slid = speed / w * sin(w * t), speed * cos(w * t), mpf(0)
        elif t < stop:
            x = e + after * (t - grip) - friction * gravity * (t - grip) ** 2 / 2
            v, slid = after - friction * gravity * (t - grip), x - e
        else:
            x, v, slid = reach - e + e * cos(w * (t - stop)), -e * w * sin(w * (t - stop)), reach - e
        rows.append((t, x, v, friction * mass * gravity * slid))
    table(("t", "x", "vx", "lost"), rows)


if __name__ == "__main__":
    globals()[sys.argv[1].replace("-", "_")]()
