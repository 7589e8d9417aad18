"""Lag of a rotating cantilever under a small force across its tip that turns with it, by modes of the linear equation.

In the rotating frame, EI = rho A = L = 1, the deflection obeys  u'''' - (T u')' - W^2 u + u_tt = 0  with the tension
T = W^2 (1 - s^2) / 2 of the centrifugal force, whose part across the beam is W^2 u: the squares of the frequencies are smaller by W^2 than those of
flapping. Modes by Galerkin's method with the polynomials s^2 ... s^(N+1), integrated exactly in 60 digits, N = 24.
The flapping frequency at W = 6 is the 7.3604 of A. D. Wright et al., J. Appl. Mech. 49, 1982, 197-202, to its digits.

    python3 rotating_beam.py
"""

from mpmath import cholesky, cos, eigsy, inverse, matrix, mp, mpf, nstr, sqrt

mp.dps = 60
SPEED, FORCE, COUNT = mpf(6), mpf("3e-3"), 24


def modes():
    """Squares of the frequencies, and values and slopes at the tip of modes of unit mass."""
    stiffness, mass = matrix(COUNT, COUNT), matrix(COUNT, COUNT)
    for i in range(COUNT):
        for j in range(COUNT):
            p, q = i + 2, j + 2
            bending = mpf(p * (p - 1) * q * (q - 1)) / (p + q - 3)
            tension = SPEED**2 / 2 * p * q * (mpf(1) / (p + q - 1) - mpf(1) / (p + q + 1))
            mass[i, j] = mpf(1) / (p + q + 1)
            stiffness[i, j] = bending + tension - SPEED**2 * mass[i, j]
    root = inverse(cholesky(mass))
    squares, vectors = eigsy(root * stiffness * root.T)
    vectors = root.T * vectors
    for k in range(COUNT):
        yield squares[k], sum(vectors[:, k]), sum((i + 2) * vectors[i, k] for i in range(COUNT))


if __name__ == "__main__":
    found = sorted(modes())
    flap = sqrt(found[0][0] + SPEED**2)
    assert abs(flap - mpf("7.3604")) < mpf("5e-5"), flap
    print("t,angle")
    for i in range(81):
        t = mpf(i) / 40
        turned = sum(FORCE * tip * slope / square * (1 - cos(sqrt(square) * t)) for square, tip, slope in found)
        print(f"{nstr(t, 6)},{nstr(SPEED * t + turned, 14)}")
