"""A cantilever above an electrode, along its path through pull-in, by shooting in 30-digit arithmetic.

The beam is that of static_beam.py with the load per reference length

    q_y = -l e w V^2 / (2 g^2) (1 + b g / w)        g = y - y_e - h/2

on its centreline: l the load factor, y_e the electrode's height, h the beam's. From the tip, at a given deflection,
angle and load factor are shot so that the clamp is reached level and at its height.

    python3 switch.py electrostatic-switch
"""

from mpmath import cos, findroot, matrix, mp, mpf, sin
from static_beam import Beam, show, stretch

mp.dps = 30

LENGTH, WIDTH, HEIGHT, GAP = mpf("200e-6"), mpf("40e-6"), mpf("2e-6"), mpf("3e-6")
MODULUS, VOLTAGE, PERMITTIVITY, FRINGE = mpf("160e9"), mpf(20), mpf("8.8541878128e-12"), mpf("0.65")
# Lengths in units of the beam's, forces in EI/L^2.
BENDING = MODULUS * WIDTH * HEIGHT**3 / 12
AXIAL = MODULUS * WIDTH * HEIGHT * LENGTH**2 / BENDING
ATTRACTION = PERMITTIVITY * WIDTH * VOLTAGE**2 / 2 * LENGTH / BENDING


class Switch(Beam):
    factor = mpf(0)

    def slope(self, state):
        _, y, theta, moment, fx, fy = state
        c, s = cos(theta), sin(theta)
        g = stretch(fx * c + fy * s, AXIAL, "engineering")
        gap = y + GAP / LENGTH
        pull = self.factor * ATTRACTION * (1 / gap**2 + FRINGE * LENGTH / WIDTH / gap)
        return g * c, g * s, moment, -g * (fy * c - fx * s), mpf(0), pull


def path(deflections):
    """Tip deflections in gaps -> the same in metres and load factor; each point is guessed from the two before it."""
    beam = Switch(1, 1)

    def solve(deflection, guess):
        def miss(angle, factor):
            beam.factor = factor
            tip = (mpf(0), -deflection * GAP / LENGTH, angle, mpf(0), mpf(0), mpf(0))
            end = beam.integrate(tip, mpf(-1))[-1]
            return end[1], end[2]

        found = findroot(miss, guess, tol=mpf(10) ** -40, maxsteps=60)
        return [found[0], found[1]]

    points, rows = [[mpf(0), mpf(0)]], [[mpf(0), mpf(0), mpf(0)]]
    for deflection in deflections:
        # A tip that goes down by d turns by about 1.37 d/L at first.
        first = [mpf("-1.37") * deflection * GAP / LENGTH, mpf("0.1")]
        guess = first if len(points) == 1 else [2 * a - b for a, b in zip(points[-1], points[-2])]
        points.append(solve(deflection, guess))
        rows.append([deflection, deflection * GAP, points[-1][1]])
    return rows


if __name__ == "__main__":
    even = [mpf(k) / 20 for k in range(1, 15)]
    show(["part", "y", "load"], path(even))
