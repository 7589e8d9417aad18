"""Equilibria that are hard to compute, by shooting in 30-digit arithmetic with the beam of static_beam.py.

    python3 hard_statics.py NAME
"""

import sys

from mpmath import mpf, sin, cos, sqrt, pi, ellipk, ellipe, asin, lu_solve, matrix

from static_beam import Beam, SHAPE, derivative, newton, sampled, show


def slenderness():
    """Cantilever, EI = L = 1, dead tip force 10 downwards, EA L^2/EI from 1e2 to 1e14, from the free end."""
    rows, tip = [], mpf("-1.43")
    for power in range(14, 1, -1):
        beam = Beam(1, 1, mpf(10) ** power)
        back = lambda u: beam.integrate((mpf(0), mpf(0), u[0], mpf(0), mpf(0), -mpf(10)), -mpf(1))[-1]
        (tip,) = newton(lambda u: [back(u)[2]], [tip])
        x, y = back([tip])[:2]
        rows.append([mpf(power), -x, -y, tip])
    show(["power", "x", "y", "angle"], rows)


def follower_turns():
    """Cantilever, EA = 1e6, EI = L = 1, load q per length that follows the normal.

    From the free end, where the section is free of stress, an initial value problem in the frame of that end; the whole
    is then turned so that the clamp lies along x.
    """
    rows = []
    for load in (100, 1000, 4000):
        beam = Beam(1, 1, mpf(10) ** 6, follower=load)
        back = beam.integrate((mpf(0),) * 6, -mpf(1), 100)
        x, y, theta = back[-1][:3]
        c, s = cos(theta), sin(theta)
        turn = lambda a, b: (c * a + s * b, c * b - s * a)
        path = [(*turn(p[0] - x, p[1] - y), p[2] - theta, p[3], *turn(p[4], p[5])) for p in reversed(back)]
        rows += [[mpf(load)] + r for r in sampled(beam, path)]
    show(["load"] + SHAPE, rows)


def elastica_tip(angle):
    """P/P_cr and the tip of the inextensible clamped-free column whose end turns by `angle`, L = 1."""
    m = sin(angle / 2) ** 2
    k = ellipk(m)
    return (2 * k / pi) ** 2, 2 * ellipe(m) / k - 1, 2 * sqrt(m) / k


def column():
    """Column, clamped-free, EA = 1e9, EI = L = 1, under -P along x and 1e-4 P across, integrated from the free end.

    P is that at which the end of the perfect inextensible column turns by 20 to 140 degrees.
    """
    rows = []
    for degrees in (20, 40, 60, 80, 100, 120, 140):
        angle = mpf(degrees) * pi / 180
        ratio, x, y = elastica_tip(angle)
        load = ratio * pi**2 / 4
        beam = Beam(1, 1, mpf(10) ** 9)
        force = (-load, load / 10**4)
        back = lambda u, pieces=1: beam.integrate((mpf(0), mpf(0), u[0], mpf(0), *force), -mpf(1), pieces)
        (tip,) = newton(lambda u: [back(u)[-1][2]], [angle])
        end = back([tip])[-1]
        assert abs(tip - angle) < mpf("0.02"), (degrees, tip)
        assert abs(end[0] + x) < mpf("0.02") and abs(end[1] + y) < mpf("0.02"), (degrees, end, x, y)
        rows.append([mpf(degrees), ratio, load, -end[0], -end[1], tip, x, y])
    show(["degrees", "ratio", "load", "x", "y", "angle", "perfect_x", "perfect_y"], rows)


def shallow_arch():
    """Pinned circular arch of span 2 and rise 0.2, EI = 1, EA = 400, dead force P downwards at its crown: the symmetric path.

    Printed is its mirror image, a sagging beam whose lowest point, at height y, is pushed up by `factor` times 20.

    Half of the arch: at the crown the section keeps its direction and carries P/2. Unknowns u = (angle at the hinge, Fx,
    P); given is the height of the crown. Where dP/dy = 0 are the limit points.
    """
    rise = mpf("0.2")
    radius = (1 + rise**2) / (2 * rise)
    half = asin(1 / radius)
    beam = Beam(radius * half, 1, 400, curvature=-1 / radius)

    def at(height, guess):
        def residual(u):
            theta, fx, load = u
            end = beam.integrate((mpf(-1), mpf(0), theta, mpf(0), fx, -load / 2), beam.length)[-1]
            return [end[0], end[1] - height, end[2]]
        return newton(residual, guess), residual

    def slope(height, guess):
        """dP/dy: J du/dy = (0, 1, 0)."""
        u, residual = at(height, guess)
        return u, lu_solve(derivative(residual, u, residual(u)), matrix([0, 1, 0]))[2]

    u, rows, path = [half, mpf(0), mpf(0)], [], []
    for k in range(0, 15):
        height = rise * (1 - mpf(k) / 5)
        u, dp = slope(height, u)
        path.append((height, u, dp))
        rows.append(["path", -height, u[2] / 20])
    for name, sign in (("upper", -1), ("lower", 1)):
        # on the way down dP/dy is negative at first: the load grows
        k = next(k for k in range(1, 15) if path[k - 1][2] * sign > 0 and path[k][2] * sign <= 0)
        (a, ua, fa), (b, _, fb) = path[k - 1], path[k]
        for _ in range(60):  # regula falsi (Illinois)
            c = (a * fb - b * fa) / (fb - fa)
            uc, fc = slope(c, ua)
            if fc * fb < 0:
                a, fa, ua = b, fb, uc
            else:
                fa /= 2
            b, fb = c, fc
            if abs(fc) < mpf(10) ** -9:
                break
        # the load forgives the square of what is left of the slope
        rows.append([name, -b, uc[2] / 20])
    show(["point", "y", "factor"], rows)


CASES = {
    "slenderness": slenderness,
    "follower-turns": follower_turns,
    "column": column,
    "shallow-arch": shallow_arch,
}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: hard_statics.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
