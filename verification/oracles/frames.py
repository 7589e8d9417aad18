"""Equilibria of planar frames of extensible beams by shooting, in double precision with tolerances of 1e-13.

Along each member the state (x, y, theta, M, Fx, Fy) obeys

    x' = g cos(theta)    y' = g sin(theta)    theta' = M / EI    M' = -g (F . n)    g = 1 + F . t / EA

with the force F that the part beyond exerts. At a rigid corner theta jumps by the corner's angle and all else goes on; a load P lowers F by
P. Paths through limit points are followed in the unknowns of the start and the load together.

    python3 frames.py lee-frame | right-angle
"""

import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import minimize_scalar


class Member:
    """A straight piece of a frame."""

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


def lee(z):
    """Lee's frame: what is not met at the far hinge, and the loaded point; z is theta and F at the start, and P."""
    angle, fx, fy, load = z
    column, near, far = (Member(length, 4320, 1440) for length in (120, 24, 96))
    corner = column.end([0, 0, np.pi / 2 + angle, 0, fx, fy])
    corner[2] -= np.pi / 2
    loaded = near.end(corner)
    beyond = loaded.copy()
    beyond[5] += load
    end = far.end(beyond)
    return np.array([end[0] - 120, end[1] - 120, end[3]]) / 120, loaded


def lee_points():
    """Points of the path from the unloaded frame: unknowns and the loaded point."""
    z, tangent = np.zeros(4), np.array([0, 0, 0, 1.0])
    while True:
        direction = np.linalg.svd(jacobian(lambda w: lee(w)[0], z))[2][-1]
        tangent = direction if direction @ tangent > 0 else -direction
        yield z, lee(z)[1]
        guess = z + 0.1 * tangent
        z = newton(lambda w: np.append(lee(w)[0], (w - guess) @ tangent), guess)


def lee_frame():
    """The path until the loaded point is at x = 116, and the extrema of the load over x, which grows so far; the
    minimum with a point on either side."""
    print("kind,load,x,y")

    def row(kind, z, point):
        print(f"{kind},{z[3]:.11g},{point[0]:.11g},{point[1]:.11g}")

    points, wanted = [], [("maximum", 1), ("minimum", -1)]
    for z, point in lee_points():
        if point[0] > 116:
            return
        row("path", z, point)
        points.append((z, point))
        if wanted and len(points) > 2 and (z[3] - points[-2][0][3]) * wanted[0][1] < 0:
            kind, sign = wanted.pop(0)

            def at(x, near=points[-2][0]):
                return newton(lambda w: np.append(lee(w)[0], (lee(w)[1][0] - x) / 120), near)

            # The load is a parabola there, so that a place to 1e-4 gives the load to 1e-11.
            best = minimize_scalar(
                lambda x: -sign * at(x)[3],
                bounds=(points[-3][1][0], point[0]),
                method="bounded",
                options={"xatol": 1e-4},
            )
            for x in [best.x] if sign > 0 else [best.x - 1, best.x, best.x + 1]:
                row(kind, at(x), lee(at(x))[1])


def right_angle():
    """Column and arm of 1 m, EA = 1e5, EI = 1, clamped at the foot, under dead forces at the free end: the unknown is the foot's moment."""
    print("force,x,y,angle,moment")
    member, unknown = Member(1, 1e5, 1), np.zeros(1)
    for force in (0.5, 1, 2, 3):

        def end(z, force=force):
            corner = member.end([0, 0, np.pi / 2, z[0], 0, -force])
            corner[2] -= np.pi / 2
            return member.end(corner)

        unknown = newton(lambda z: end(z)[3:4], unknown)
        x, y, angle, *_ = end(unknown)
        # The clamp acts on the beam against what the beam beyond it transmits.
        print(f"{force},{x:.12g},{y:.12g},{angle:.12g},{-unknown[0]:.12g}")


if __name__ == "__main__":
    {"lee-frame": lee_frame, "right-angle": right_angle}[sys.argv[1]]()
