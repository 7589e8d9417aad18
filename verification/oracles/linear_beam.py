"""Eigenvalues of the linear Euler-Bernoulli beam, in 40-digit arithmetic.

    python3 linear_beam.py frequencies | euler-column
"""

import sys

from mpmath import mp, mpf, cos, cosh, tan, tanh, pi, sqrt, findroot, nstr

mp.dps = 40


def frequencies():
    """First five bending frequencies of the paper's beam [Hz]: f = (beta L)^2 / (2 pi L^2) sqrt(EI / rho A).

    clamped-free   cos z cosh z = -1         z near (k - 1/2) pi
    pinned-free    tan z = tanh z            z near (k + 1/4) pi
    """
    length = mpf("1.8")
    bending = mpf("68.95e9") * mpf("0.130e-8")
    mass = mpf("2766.67") * mpf("2.5e-4")
    print("support,mode,frequency")
    laws = {
        # divided by cosh, so that the function stays of order one
        "clamped-free": (lambda z: cos(z) + 1 / cosh(z), lambda k: (k - mpf(1) / 2) * pi + (mpf("0.3") if k == 1 else 0)),
        "pinned-free": (lambda z: tan(z) - tanh(z), lambda k: (k + mpf(1) / 4) * pi),
    }
    for support, (law, guess) in laws.items():
        for k in range(1, 6):
            z = findroot(law, guess(k))
            assert abs(z - guess(k)) < mpf("0.1")
            f = z**2 / (2 * pi * length**2) * sqrt(bending / mass)
            print(f"{support},{k},{nstr(f, 17)}")


def euler_column():
    """Critical compressive loads of an inextensible column, EI = L = 1.

    clamped-free ((k - 1/2) pi)^2, pinned-pinned (k pi)^2
    """
    print("support,mode,load")
    for support, factor in (("clamped-free", lambda k: (k - mpf(1) / 2)), ("pinned-pinned", lambda k: mpf(k))):
        for k in range(1, 4):
            print(f"{support},{k},{nstr((factor(k) * pi) ** 2, 17)}")


CASES = {"frequencies": frequencies, "euler-column": euler_column}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: linear_beam.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
