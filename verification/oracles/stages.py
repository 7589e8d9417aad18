"""What happens in stages, by closed forms in 30-digit arithmetic.

    python3 stages.py release     a cantilever that a small force has bent is let go
    python3 stages.py order       the end of a bar on rough ground, pulled and pressed in either order, and let go
    python3 stages.py ring        a straight rod bent into a ring and welded to itself
"""

import sys

from mpmath import cos, cosh, exp, findroot, mp, mpf, nstr, pi, sin, sqrt, tanh

mp.dps = 30


def show(header, rows):
    print(",".join(header))
    for row in rows:
        print(",".join(v if isinstance(v, str) else nstr(mpf(v), 17, min_fixed=-8, max_fixed=17) for v in row))


def release():
    """w(L, t) = sum over k of 4 F L^3/(EI b_k^4) cos(w_k t), cos b cosh b = -1, w_k = b_k^2 sqrt(EI/(m L^4)).

    The static line under the tip force F is the sum of the modes with these amplitudes; at rest, each goes on by its cosine.
    EI = L = m = 1, F = 3e-4.
    """
    force = mpf("3e-4")
    roots = []
    for k in range(400):
        middle = (k + mpf(1) / 2) * pi
        roots.append(findroot(lambda b: cos(b) + 1 / cosh(b), middle + (mpf("0.3") if k == 0 else 0)))
    total = sum(4 * force / b**4 for b in roots)
    assert abs(total - force / 3) < mpf("1e-13"), total
    rows = []
    for i in range(33):
        t = mpf(i) / 20
        rows.append([t, sum(4 * force / b**4 * cos(b * b * t) for b in roots)])
    show(["t", "y"], rows)


def pulled(force, limit, axial, stick, length):
    """Displacement of the end at which a bar in elastic-plastic ties is pulled, held at its other end.

    EA u'' = k u where k u < limit, else EA u'' = limit. From the held end: sinh up to the place where k u = limit, from
    there to the pulled end a parabola. The slip's length c makes the slopes meet.
    """
    a = sqrt(stick / axial)

    def slope(c):
        return limit / stick * a / tanh(a * (length - c)) + limit * c / axial - force / axial

    if slope(mpf(0)) > 0:  # nothing slips
        return force / axial * tanh(a * length) / a
    c = findroot(slope, (mpf(0), length * (1 - mpf(10) ** -6)), solver="anderson", tol=mpf(10) ** -50)
    return limit / stick + (force / axial) * c - limit * c**2 / (2 * axial)


def order():
    """EA = 1000, L = 1, weight 12 per length, mu = 0.5, k_t = 1e5; the end is pulled by F = 4, and let go.

    Pressed first, friction resists the pull: u = U(F, p); letting go is a pull by F that begins everywhere at the same
    friction and may turn it round, which takes twice the limit: -U(F, 2 p) (Masing's rule). Pulled first, nothing
    resists: F L/EA, and friction begins at zero when the bar is let go: -U(F, p).
    """
    axial, length, force, stick = mpf(1000), mpf(1), mpf(4), mpf("1e5")
    # The weight is carried by the ground and, beside it, by a foundation that keeps the free bar level.
    limit = mpf("0.5") * 12 * mpf("1e5") / (mpf("1e5") + mpf("1e-3"))
    first, last = pulled(force, limit, axial, stick, length), pulled(force, 2 * limit, axial, stick, length)
    free = force * length / axial
    rows = [
        ["press", mpf(1), length + first, length + first - last],
        ["pull", length + free, length + free, length + free - pulled(force, limit, axial, stick, length)],
    ]
    show(["first", "one", "two", "three"], rows)


def ring():
    """L = 2 pi, EI = 3, EA = 1e4, m = 0.5: R = 1. Energy EI L/(2 R^2), moment EI/R, and the frequencies in the plane.

    A moment that is the same everywhere does no work on a closed ring, whose turning stays 2 pi: the frequencies are those of
    a ring that is round without stress. With u along the ring and w inwards, strain u' - w/R and turning w' + u/R,
    waves with n periods obey  (EA n^2 + EI n^2/R^2 - m R^2 p) (EA + EI n^4/R^2 - m R^2 p) = (EA n + EI n^3/R^2)^2,  p the square of
    the angular frequency.
    """
    bending, axial, mass = mpf(3), mpf("1e4"), mpf("0.5")
    rows = []
    for n in (2, 3, 4):
        a, b, c = axial * n**2 + bending * n**2, axial + bending * n**4, axial * n + bending * n**3
        p = ((a + b) - sqrt((a - b) ** 2 + 4 * c**2)) / 2 / mass
        thin = n * (n**2 - 1) / sqrt(mpf(n) ** 2 + 1) * sqrt(bending / mass)
        assert abs(sqrt(p) / thin - 1) < mpf("0.02"), (sqrt(p), thin)
        rows.append([mpf(n), sqrt(p) / (2 * pi), pi * bending, bending, mpf(0), mpf(2), mpf(1)])
    show(["n", "frequency", "bend", "moment", "x", "y", "curvature"], rows)


CASES = {"release": release, "order": order, "ring": ring}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: stages.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
