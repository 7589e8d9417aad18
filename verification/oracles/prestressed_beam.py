"""Frequencies of slender beams under axial force, in 40-digit arithmetic; EI = L = rho A = 1.

    python3 prestressed_beam.py tension | hanging
"""

import sys

from mpmath import mp, mpf, pi, sqrt, findroot, nstr

mp.dps = 40


def tension():
    """Pinned-pinned beam, EA = 1e5, under a dead axial force N at its sliding end, first three frequencies [Hz].

    With the stretch c = 1 + N/EA (strain |r'| - 1) the angle of the section is w'/c, hence
        energy of a small deflection w(s)   1/2 int EI (w''/c)^2 + (N/c) w'^2 ds
        omega^2 = (n pi)^4 / c^2 + N (n pi)^2 / c
    """
    print("force,mode,frequency")
    for force in ("-9", "0", "10", "1000"):
        c = 1 + mpf(force) / mpf("1e5")
        for n in range(1, 4):
            k = n * pi
            print(f"{force},{n},{nstr(sqrt(k**4 / c**2 + mpf(force) * k**2 / c) / (2 * pi), 17)}")


def end_values(gamma, square):
    """Deflection and slope at the clamp x = 1 of the two solutions that are free of moment and shear force at x = 0.

    w'''' - gamma (x w')' = omega^2 w, w = sum a_n x^n:
        (n+4)(n+3)(n+2)(n+1) a_{n+4} = gamma (n+1)^2 a_{n+1} + omega^2 a_n
    """
    rows = []
    for start in ((1, 0), (0, 1)):
        a = [mpf(start[0]), mpf(start[1]), mpf(0), mpf(0)]
        n = 0
        while n < 40 or max(abs(v) for v in a[-4:]) > mpf(10) ** -(mp.dps + 5):
            a.append((gamma * (n + 1) ** 2 * a[n + 1] + square * a[n]) / ((n + 4) * (n + 3) * (n + 2) * (n + 1)))
            n += 1
        rows.append((sum(a), sum(k * v for k, v in enumerate(a))))
    return rows


def hanging():
    """Inextensible cantilever of weight gamma = rho A g L^3/EI, its free end below (gamma > 0) or above (< 0) [Hz]."""
    print("weight,mode,frequency")
    for weight in ("-7", "10", "100", "1000"):
        gamma = mpf(weight)

        def determinant(omega):
            (w0, d0), (w1, d1) = end_values(gamma, omega**2)
            return w0 * d1 - w1 * d0

        roots, omega, before = [], mpf(0), determinant(mpf(0))
        while len(roots) < 3:
            # Frequencies lie more than 1 apart, the lowest above 0.
            after = determinant(omega + mpf("0.25"))
            if before * after < 0:
                roots.append(findroot(determinant, (omega, omega + mpf("0.25")), solver="anderson"))
            omega, before = omega + mpf("0.25"), after
        for mode, root in enumerate(roots, 1):
            print(f"{weight},{mode},{nstr(root / (2 * pi), 17)}")


CASES = {"tension": tension, "hanging": hanging}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: prestressed_beam.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
