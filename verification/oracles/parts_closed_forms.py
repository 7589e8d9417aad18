"""Closed forms of single parts: hubs, strings, foundations, masses, springs, damping, travelling forces, fluids, actuation.

Each subcommand states its formula and prints one CSV table.

    python3 parts_closed_forms.py NAME
"""

import sys

from mpmath import (
    asinh, besselj, besseljzero, cos, cosh, exp, findroot, log, lu_solve, matrix, mp, mpc, mpf, nstr, pi, sin,
    sinh, sqrt, tanh,
)

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


def hanging_cable():
    """Elastic catenary between hooks at one height: x = H s/EA + H/w (asinh(V/H) - asinh((V - w s)/H)), V = wL/2."""
    length, span, weight, axial = mpf(1), mpf("0.6"), mpf("9.81"), mpf(100)
    half = weight * length / 2

    def x(s, h):
        return h * s / axial + h / weight * (asinh(half / h) - asinh((half - weight * s) / h))

    h = findroot(lambda h: x(length, h) - span, 1.5)
    rows = []
    for i in range(41):
        s = length * i / 40
        v = half - weight * s
        y = -(half * s - weight * s**2 / 2) / axial - (sqrt(h**2 + half**2) - sqrt(h**2 + v**2)) / weight
        rows.append((s, x(s, h), y, sqrt(h**2 + v**2), h, half))
    table(("s", "x", "y", "tension", "horizontal", "vertical"), rows)


def swinging_chain():
    """A chain of 1 m that hangs and is turned about its hook with the angular velocity r: with the zeros j of J0 and w = j sqrt(g/L)/2
    the tip moves by the sum of 8 L r / (j^3 J1(j)) sin(w t) / w, from the modes J0(j sqrt(1 - s/L))."""
    rate = mpf("1e-4")
    zeros = [besseljzero(0, n) for n in range(1, 100)]
    parts = [(8 * rate / (j**3 * besselj(1, j)), j * sqrt(mpf("9.81")) / 2) for j in zeros]
    table(("t", "x"), [(mpf(i) / 20, sum(a * sin(w * i / 20) / w for a, w in parts)) for i in range(41)])


def chain_modes():
    """Frequencies j sqrt(g/L) / 4 pi of a hanging chain of 1 m that does not stretch, with the zeros j of J0."""
    table(("mode", "frequency"), [(n, besseljzero(0, n) * sqrt(mpf("9.81")) / (4 * pi)) for n in range(1, 5)])


def elastic_foundation():
    """A pinned beam on an elastic foundation under a force P at its middle (Hetenyi): EI u'''' + k u = 0 on either side, by the
    complex roots of r^4 = -k/EI, with u' = 0 and EI u''' = P/2 at the middle, u = u'' = 0 at the end."""
    bending, k, half, force = mpf(1), mpf(40000), mpf("0.5"), mpf("-1e-4")
    b = (k / (4 * bending)) ** mpf("0.25")
    roots = [b * mpc(x, y) for x in (1, -1) for y in (1, -1)]

    def basis(x, order):
        return [r**order * exp(r * x) for r in roots]

    system = matrix([basis(0, 1), basis(0, 3), basis(half, 0), basis(half, 2)])
    c = lu_solve(system, matrix([0, force / (2 * bending), 0, 0]))
    rows = []
    for i in range(21):
        u, curvature = (sum(a * v for a, v in zip(c, basis(abs(mpf(i) / 20 - half), order))).real for order in (0, 2))
        rows.append((mpf(i) / 20, u, bending * curvature))
    table(("s", "y", "bending_moment"), rows)


def tip_mass():
    """Cantilever with a mass m, a rotary inertia J, a spring k across and a torsion spring c at its tip, EI = rho A = L = 1, w = b^2:
    u = A (cosh - cos) + B (sinh - sin) with u'' = (J b^4 - c) u' and u''' = (k - m b^4) u at the tip."""
    rows = []
    for words in ["0.5 0 0 0", "2 0 0 0", "1 0.1 0 0", "0 0 20 0", "0 0 0 3", "0 0 20 3"]:
        m, j, k, torsion = map(mpf, words.split())

        def determinant(b):
            c, s, ch, sh = cos(b), sin(b), cosh(b), sinh(b)
            turn, shift = j * b**3 - torsion / b, m * b - k / b**3
            first = ch + c - turn * (sh + s), sh + s - turn * (ch - c)
            second = sh - s + shift * (ch - c), ch + c + shift * (sh - s)
            return first[0] * second[1] - first[1] * second[0]

        found, b, step = [], mpf("0.1"), mpf("0.05")
        while len(found) < 3:
            if determinant(b) * determinant(b + step) < 0:
                found.append(findroot(determinant, (b, b + step), solver="anderson"))
            b += step
        rows += [(m, j, k, torsion, n + 1, root**2 / (2 * pi)) for n, root in enumerate(found)]
    table(("mass", "inertia", "spring", "torsion", "mode", "frequency"), rows)


def moving_force():
    """A pinned beam of EI = rho A = L = 1 under a force P that crosses it with speed v (Krylov, Timoshenko): modes n with W = n pi v,
    w = (n pi)^2, q = 2P / (w^2 - W^2) (sin(W t) - W/w sin(w t)); the middle while the force is on the beam. Damped by alpha and
    eta, with 2 c = alpha + eta w^2, q'' + 2 c q' + w^2 q = 2P sin(W t) from rest."""
    force, speed = mpf("-1e-4"), mpf("0.5")
    rows = []
    for i in range(41):
        t = mpf(i) / 20
        row = [t]
        for alpha, eta in [(mpf(0), mpf(0)), (mpf("0.8"), mpf("0.01"))]:
            total = mpf(0)
            for n in range(1, 200, 2):
                drive, own = n * pi * speed, (n * pi) ** 2
                # Im of A e^(iWt) + B e^(r t) + C e^(r' t), r and r' the roots of r^2 + 2 c r + w^2
                c = (alpha + eta * own**2) / 2
                root = sqrt(mpc(c**2 - own**2, 0))
                first, second = -c + root, -c - root
                a = 2 * force / (own**2 - drive**2 + 2j * c * drive)
                # The imaginary part of A e^(iWt) and its rate at 0 are taken away by the free vibration.
                place, rate = a.imag, (1j * drive * a).imag
                p = (-rate + second * place) / (first - second)
                q = -place - p
                value = (a * exp(1j * drive * t)).imag + (p * exp(first * t) + q * exp(second * t)).real
                total += sin(n * pi / 2) * value
            row.append(total)
        rows.append(row)
    table(("t", "undamped", "damped"), rows)


def terminal_speed():
    """A rod of mass m that falls across itself in a fluid: m v' = (m - m_f) g - C v^2, so v = u tanh(r t), y = u/r log cosh(r t) with
    u^2 = (m - m_f) g / C, r = C u / m."""
    m, lift, g, c = mpf(1), mpf("0.2"), mpf("9.81"), mpf(2)
    u = sqrt((m - lift) * g / c)
    r = c * u / m
    times = [mpf(i) / 10 for i in range(21)]
    table(("t", "y", "vy"), [(t, -u / r * log(cosh(r * t)), -u * tanh(r * t)) for t in times])


def actuation():
    """A free-ended beam that would by itself be stretched by e and curved by k: x = (1 + e) sin(k s)/k, y = (1 + e) (1 - cos(k s))/k."""
    rows = []
    for curvature, strain in [("1", "0"), ("3", "0.1")]:
        k, e = mpf(curvature), mpf(strain)
        for i in range(21):
            s = mpf(i) / 20
            rows.append((k, e, s, (1 + e) * sin(k * s) / k, (1 + e) * (1 - cos(k * s)) / k))
    table(("curvature", "strain", "s", "x", "y"), rows)


if __name__ == "__main__":
    globals()[sys.argv[1].replace("-", "_")]()
