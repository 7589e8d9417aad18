"""A clamped-free beam of L = EI = rho A = 1 that is damped and starts from its straight shape with a velocity.

The modes phi_j = cosh bs - cos bs - sigma (sinh bs - sin bs), of norm 1, cos b cosh b = -1, w = b^2, stay apart under both kinds of damping:

    q'' + (alpha + eta w^2) q' + w^2 q = 0

with alpha of the force -alpha rho A v and eta of the moment EI (kappa + eta kappa'). The velocity V (6 s^2 - 4 s^3 + s^4) / 3, the shape under an even
load, gives mode j the velocity 16 V sigma / b^5 at first, since it satisfies the ends' conditions, its fourth derivative is 8 V, and the integral
of phi_j is 2 sigma / b. At the tip phi_j is 2, -2, 2, ...

    python3 damped_beam.py
"""

from mpmath import cos, cosh, exp, findroot, mp, mpf, nstr, pi, sin, sinh, sqrt

mp.dps = 40

VELOCITY, MODES = mpf("1e-4"), 60
DAMPINGS = {"curvature": (mpf(0), mpf("0.02")), "mass": (mpf("0.25"), mpf(0)), "both": (mpf("0.25"), mpf("0.02"))}


def modes():
    for j in range(MODES):
        b = findroot(lambda x: cos(x) + 1 / cosh(x), (j + mpf(1) / 2) * pi + (mpf("0.3") if j == 0 else 0))
        sigma = (cosh(b) + cos(b)) / (sinh(b) + sin(b))
        yield b, 32 * VELOCITY * (-1) ** j * sigma / b**5


def tip(parts, alpha, eta, t):
    """Deflection of the tip."""
    place = mpf(0)
    for b, rate in parts:
        half = (alpha + eta * b**4) / 2
        # The frequency is imaginary where a mode creeps.
        w = sqrt(b**4 - half**2 + mpf(0) * 1j)
        place += rate * exp(-half * t) * (sin(w * t) / w).real
    return place


if __name__ == "__main__":
    parts = list(modes())
    print("damping,t,y")
    for name, (alpha, eta) in DAMPINGS.items():
        for i in range(121):
            t = mpf(i) / 20
            print(",".join([name, *(nstr(value, 15) for value in (t, tip(parts, alpha, eta, t)))]))
