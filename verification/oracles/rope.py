"""A rope whose axial law is a table, under its weight, in 30-digit arithmetic.

The horizontal force H is the same everywhere, the vertical one is known, V(s) = w (s - L/2), and the
strain follows from T = sqrt(H^2 + V^2) by the law turned round:

    x = int (1 + e) H/T ds      y = int (1 + e) V/T ds

H is the root of x(L) = the distance of the ends. Where T passes a corner of the law, the integrals are divided.

    python3 rope.py rope-without-compression
"""

from mpmath import findroot, mp, mpf, quad, sqrt
from static_beam import show

mp.dps = 30

LENGTH, WEIGHT = mpf(10), mpf("0.4") * mpf("9.81")
STRAIN, FORCE = [mpf(0), mpf("0.02"), mpf("0.1")], [mpf(0), mpf(2000), mpf(30000)]


def strain(tension):
    piece = 0 if tension <= FORCE[1] else 1
    slope = (FORCE[piece + 1] - FORCE[piece]) / (STRAIN[piece + 1] - STRAIN[piece])
    return STRAIN[piece] + (tension - FORCE[piece]) / slope


def half(horizontal, end):
    """x and y at s = end of the first half; V falls upwards from the left end, where the rope is held."""
    start = -WEIGHT * LENGTH / 2
    vertical = lambda s: start + WEIGHT * s
    places = [mpf(0), mpf(end)]
    if FORCE[1] > horizontal:
        # |V| at which T is at the corner of the law.
        corner = (-sqrt(FORCE[1] ** 2 - horizontal**2) - start) / WEIGHT
        if 0 < corner < end:
            places.insert(1, corner)

    def along(direction):
        def density(s):
            tension = sqrt(horizontal**2 + vertical(s) ** 2)
            return (1 + strain(tension)) * direction(s) / tension

        return quad(density, places)

    return along(lambda s: horizontal), along(vertical)


def rope(apart, guess):
    residual = lambda h: 2 * half(h, LENGTH / 2)[0] - apart
    horizontal = findroot(residual, guess, solver="secant", tol=mpf(10) ** -24)
    rows = []
    for k in range(1, 6):
        x, y = half(horizontal, LENGTH * k / 10)
        vertical = WEIGHT * LENGTH * (mpf(k) / 10 - mpf(1) / 2)
        rows.append([LENGTH * k / 10, x, y, horizontal, sqrt(horizontal**2 + vertical**2)])
    return rows


if __name__ == "__main__":
    table = [["slack", *row] for row in rope(mpf("9.5"), (mpf(40), mpf(45)))]
    table += [["taut", *row] for row in rope(mpf("10.3"), (mpf(5500), mpf(5600)))]
    show(["state", "s", "x", "y", "horizontal", "tension"], table)
