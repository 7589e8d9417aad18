"""Equilibria of planar frames of extensible beams by shooting, in 30-digit arithmetic with the beam of static_beam.py.

At a rigid corner theta jumps by the corner's angle and all else goes on; a load P lowers F by P. Paths through limit
points are followed in the unknowns of the start and the load together, in double precision by an integrator of
SciPy; every point of them, and every extremum, is then solved again in 30 digits, which must move it by less than 1e-8.
That takes two minutes.

    python3 frames.py lee-frame | right-angle
"""

import sys

import numpy as np
from mpmath import mpf, nstr, pi
from scipy.integrate import solve_ivp

import static_beam


class Member:
    """A straight piece of a frame, in double precision."""

    def __init__(self, length, axial, bending):
        self.length, self.axial, self.bending = length, axial, bending

    def end(self, state):
        def slope(_, y):
            c, s = np.cos(y[2]), np.sin(y[2])
            g = 1 + (y[4] * c + y[5] * s) / self.axial
            return [g * c, g * s, y[3] / self.bending, g * (y[4] * s - y[5] * c), 0, 0]

        found = solve_ivp(slope, (0, self.length), state, method="DOP853", rtol=1e-13, atol=1e-13)
        return found.y[:, -1]


def jacobian(function, z, h=1e-5):
    """Central differences."""
    steps = h * np.maximum(1, np.abs(z))
    return np.array([(function(z + e) - function(z - e)) / (2 * e.max()) for e in np.diag(steps)]).T


def newton(function, z, tolerance=1e-11):
    z = np.array(z, float)
    for _ in range(30):
        step = np.linalg.solve(jacobian(function, z), function(z))
        z = z - step
        if np.abs(step).max() < tolerance:
            return z
    raise RuntimeError(f"no equilibrium near {z}")


class Exact(Member):
    """The same in 30 digits."""

    def end(self, state):
        beam = static_beam.Beam(self.length, self.bending, self.axial)
        return list(beam.integrate(tuple(mpf(v) for v in state), beam.length)[-1])


def lee(z, kind=Member):
    """Lee's frame: what is not met at the far hinge, and the loaded point; z is theta and F at the start, and P."""
    angle, fx, fy, load = z
    column, near, far = (kind(length, 4320, 1440) for length in (120, 24, 96))
    right = pi / 2 if kind is Exact else np.pi / 2
    corner = column.end([0, 0, right + angle, 0, fx, fy])
    corner[2] -= right
    loaded = near.end(corner)
    beyond = loaded.copy()
    beyond[5] += load
    end = far.end(beyond)
    missed = [(end[0] - 120) / 120, (end[1] - 120) / 120, end[3] / 120]
    return missed if kind is Exact else np.array(missed), loaded


def exact(z, condition):
    """The point of the path near z at which condition(z, loaded point) is zero too."""

    def residual(w):
        missed, loaded = lee(w, Exact)
        return missed + [condition(w, loaded)]

    found = static_beam.newton(residual, z)
    assert max(abs(a - b) for a, b in zip(found, z)) < 1e-8 * (1 + max(abs(v) for v in z)), (found, z)
    return found, lee(found, Exact)[1]


def lee_points():
    """Points of the path from the unloaded frame: unknowns and the loaded point."""
    z, tangent = np.zeros(4), np.array([0, 0, 0, 1.0])
    while True:
        direction = np.linalg.svd(jacobian(lambda w: lee(w)[0], z))[2][-1]
        tangent = direction if direction @ tangent > 0 else -direction
        yield z, lee(z)[1]
        guess = z + 0.1 * tangent
        z = newton(lambda w: np.append(lee(w)[0], (w - guess) @ tangent), guess)


def at(x, near):
    """The point of the path where the loaded point is at x: first near another one, then in 30 digits."""
    z = newton(lambda w: np.append(lee(w)[0], (lee(w)[1][0] - float(x)) / 120), near)
    return exact(z, lambda w, loaded: (loaded[0] - mpf(x)) / 120)


def extremum(a, b, c, near):
    """The place where the load is stationary, by parabolas through three points about it, of which each has a hundredth of
    the width of the one before; the last leaves 1e-8 in place, and the square of that in the load."""
    x = [mpf(v) for v in (a, b, c)]
    for width in ("0.1", "0.001", "0.001"):
        p = [at(v, near)[0][3] for v in x]
        left, right = (p[1] - p[0]) / (x[1] - x[0]), (p[2] - p[1]) / (x[2] - x[1])
        second = (right - left) / (x[2] - x[0])
        middle = (x[0] + x[1]) / 2 - left / (2 * second)
        x = [middle - mpf(width), middle, middle + mpf(width)]
    return x[1]


def lee_frame():
    """The path until the loaded point is at x = 116, and the extrema of the load over x, which grows so far; the
    minimum with a point on either side."""
    print("kind,load,x,y")

    def row(kind, z, point):
        print(",".join([kind] + [nstr(v, 15, min_fixed=-8) for v in (z[3], point[0], point[1])]))

    points, tangent, wanted = [], None, [("maximum", 1), ("minimum", -1)]
    for z, point in lee_points():
        if point[0] > 116:
            return
        tangent = z - points[-1][0] if points else None
        if tangent is None:
            row("path", [mpf(0)] * 4, [mpf(24), mpf(120)])
        else:
            row("path", *exact(z, lambda w, _: sum((a - b) * t for a, b, t in zip(w, z, tangent))))
        points.append((z, point))
        if wanted and len(points) > 2 and (z[3] - points[-2][0][3]) * wanted[0][1] < 0:
            kind, sign = wanted.pop(0)
            near = points[-2][0]
            best = extremum(points[-3][1][0], points[-2][1][0], point[0], near)
            for x in [best] if sign > 0 else [best - 1, best, best + 1]:
                row(kind, *at(x, near))


def right_angle():
    """Column and arm of 1 m, EA = 1e5, EI = 1, clamped at the foot, under dead forces at the free end: the unknown is the foot's moment."""
    print("force,x,y,angle,moment")
    member, unknown = Exact(1, 100000, 1), [mpf(0)]
    for force in (0.5, 1, 2, 3):

        def end(z, force=force):
            corner = member.end([0, 0, pi / 2, z[0], 0, -force])
            corner[2] -= pi / 2
            return member.end(corner)

        unknown = static_beam.newton(lambda z: [end(z)[3]], unknown)
        x, y, angle, *_ = end(unknown)
        # The clamp acts on the beam against what the beam beyond it transmits.
        print(",".join([str(force)] + [nstr(v, 15) for v in (x, y, angle, -unknown[0])]))


if __name__ == "__main__":
    {"lee-frame": lee_frame, "right-angle": right_angle}[sys.argv[1]]()
