"""Equilibria of the planar extensible Euler-Bernoulli beam by shooting, in 30-digit arithmetic.

The beam is treated as a boundary value problem of ordinary differential equations in the reference arc
length s, so nothing here shares an idea with a discretisation by nodes:

    x' = g cos(theta)      y' = g sin(theta)      theta' = kappa_0 + M / EI
    M' = -g (F . n)        F' = -q                n = (-sin(theta), cos(theta))

F is the force that the part beyond s exerts, q the distributed load per reference length, and g = |r'| follows
from the axial law  dW/dg = F . t  with  W = EA e(g)^2 / 2:

    engineering   e = g - 1               EA (g - 1) = F . t
    green         e = (g^2 - 1) / 2       EA (g^2 - 1) g / 2 = F . t

A concentrated force P at s_j lowers F by P; at a free end F and M are what is applied there.
The initial value problems are integrated by Gragg's modified midpoint rule, extrapolated to order 24 in
h (Bulirsch-Stoer, fixed steps); the last two extrapolants must agree to 1e-20. Unknown starting values come
from Newton's method. Every subcommand prints one CSV table; numbers have 17 significant digits.

    python3 static_beam.py NAME
"""

import sys

from mpmath import mp, mpf, matrix, sin, cos, sqrt, pi, ellipk, ellipf, ellipe, findroot, lu_solve, nstr

mp.dps = 30
COLUMNS = 11  # of the extrapolation table: order 2 * (COLUMNS + 1) = 24 in the step


def stretch(force, axial_stiffness, measure):
    """g = |r'| under the tangential force F . t."""
    if axial_stiffness is None:
        return mpf(1)
    ratio = force / axial_stiffness
    if measure == "engineering":
        return 1 + ratio
    g = 1 + ratio
    while True:  # g^3 - g - 2 ratio = 0, from the engineering value
        step = (g**3 - g - 2 * ratio) / (3 * g**2 - 1)
        g -= step
        if abs(step) < mpf(10) ** -28:
            return g


class Beam:
    """Section, stress-free curvature and loads between the ends."""

    def __init__(self, length, bending, axial=None, measure="engineering", curvature=0, dead=(0, 0), follower=0):
        self.length, self.bending, self.measure = mpf(length), mpf(bending), measure
        self.axial = None if axial is None else mpf(axial)
        self.curvature = mpf(curvature)
        self.dead = (mpf(dead[0]), mpf(dead[1]))  # load per length along x and y
        self.follower = mpf(follower)  # load per length along n

    def slope(self, state):
        """Right-hand side; the state is (x, y, theta, M, Fx, Fy)."""
        _, _, theta, moment, fx, fy = state
        c, s = cos(theta), sin(theta)
        g = stretch(fx * c + fy * s, self.axial, self.measure)
        return (
            g * c,
            g * s,
            self.curvature + moment / self.bending,
            -g * (fy * c - fx * s),
            -self.dead[0] + self.follower * s,
            -self.dead[1] - self.follower * c,
        )

    def strain(self, state):
        _, _, theta, _, fx, fy = state
        g = stretch(fx * cos(theta) + fy * sin(theta), self.axial, self.measure)
        return g - 1 if self.measure == "engineering" else (g * g - 1) / 2

    def midpoint(self, state, step, parts):
        """Gragg's rule over `step` in `parts` (even) pieces; its error is a series in h^2."""
        h = step / parts
        before, here = state, tuple(a + h * b for a, b in zip(state, self.slope(state)))
        for _ in range(parts - 1):
            before, here = here, tuple(a + 2 * h * b for a, b in zip(before, self.slope(here)))
        return tuple((a + b + h * c) / 2 for a, b, c in zip(before, here, self.slope(here)))

    def advance(self, state, step):
        """One extrapolated step (Aitken-Neville in h^2)."""
        rows = []
        for j in range(COLUMNS + 1):
            row = [self.midpoint(state, step, 2 * (j + 1))]
            for k in range(1, j + 1):
                ratio = (mpf(j + 1) / (j + 1 - k)) ** 2 - 1
                row.append(tuple(a + (a - b) / ratio for a, b in zip(row[k - 1], rows[j - 1][k - 1])))
            rows.append(row)
        defect = max(abs(a - b) / (1 + abs(a)) for a, b in zip(rows[-1][-1], rows[-1][-2]))
        return rows[-1][-1], defect

    def integrate(self, state, span, pieces=1):
        """The state at the end of `span` (negative: backwards) and at `pieces` even places on the way."""
        path = [state]
        for _ in range(pieces):
            path.append(self.leap(path[-1], span / pieces))
        return path

    def leap(self, state, span):
        result, defect = self.advance(state, span)
        if defect > mpf(10) ** -20:
            return self.leap(self.leap(state, span / 2), span / 2)
        return result


def derivative(residual, unknown, value):
    """Jacobian by one-sided differences: 14 of the 30 digits are right."""
    n = len(unknown)
    jacobian = matrix(n, n)
    for j in range(n):
        h = mpf(10) ** -14 * (1 + abs(unknown[j]))
        moved = list(unknown)
        moved[j] += h
        for i, v in enumerate(residual(moved)):
            jacobian[i, j] = (v - value[i]) / h
    return jacobian


def newton(residual, guess):
    """Root of a vector function by Newton's method with differences at 30 digits."""
    unknown = [mpf(v) for v in guess]
    value = residual(unknown)
    for _ in range(60):
        jacobian = derivative(residual, unknown, value)
        step = lu_solve(jacobian, -matrix(value))
        size, scale = max(abs(v) for v in step), mpf(1)
        while True:
            trial = [u + scale * d for u, d in zip(unknown, step)]
            new = residual(trial)
            if max(map(abs, new)) < max(map(abs, value)) or scale < mpf(1) / 64 or size < mpf(10) ** -12:
                break
            scale /= 2
        unknown, value = trial, new
        if scale == 1 and size < mpf(10) ** -21 * (1 + max(map(abs, unknown))):
            return unknown
    raise ArithmeticError(f"Newton's method does not converge from {guess}: residual {value}")


def grow(problem, guess, steps):
    """Follow the root of problem(factor) from factor 0 to 1."""
    for k in range(1, steps + 1):
        guess = newton(problem(mpf(k) / steps), guess)
    return guess


def digits(value):
    """17 significant digits; what is zero but for round-off and the defect of the root is written as zero."""
    return "0" if abs(value) < mpf(10) ** -18 else nstr(value, 17, min_fixed=-8, max_fixed=17)


def show(header, rows):
    print(",".join(header))
    for row in rows:
        print(",".join(v if isinstance(v, str) else digits(v) for v in row))


SHAPE = ["s", "x", "y", "angle", "curvature", "strain"]


def sampled(beam, path, start=0, span=None):
    """Rows of SHAPE; kappa is the curvature itself, not its change."""
    span = beam.length if span is None else span
    return [
        [start + span * k / (len(path) - 1), p[0], p[1], p[2], beam.curvature + p[3] / beam.bending, beam.strain(p)]
        for k, p in enumerate(path)
    ]


def dead_tip(beam, force, steps, pieces=20):
    """Cantilever from the origin along x under dead loads: integrated from the tip, whose angle is unknown."""
    tip = lambda angle, factor: (mpf(0), mpf(0), angle, mpf(0), factor * force[0], factor * force[1])

    def problem(factor):
        part = Beam(beam.length, beam.bending, beam.axial, beam.measure, 0, [factor * q for q in beam.dead])
        return lambda u: [part.integrate(tip(u[0], factor), -beam.length)[-1][2]]

    angle = grow(problem, [mpf(0)], steps)[0]
    # a load to one side bends the whole beam to that side, by less than a right angle: no other equilibrium
    assert abs(angle) < pi / 2, angle
    back = beam.integrate(tip(angle, mpf(1)), -beam.length, pieces)
    x, y = back[-1][:2]
    return [(p[0] - x, p[1] - y, *p[2:]) for p in reversed(back)]


def inextensible_tip(load):
    """Bisshopp and Drucker by elliptic integrals, L = EI = 1: (theta_tip, x_tip, y_tip), downwards.

    With k^2 = (1 + sin theta_0)/2 and sin(phi_0) = 1/(k sqrt 2):  sqrt(P) = K(k) - F(phi_0, k).
    """
    load = mpf(load)

    def defect(theta):
        m = (1 + sin(theta)) / 2
        return ellipk(m) - ellipf(mp.asin(1 / sqrt(2 * m)), m) - sqrt(load)

    theta = findroot(defect, (mpf("0.05"), mpf("1.55")), solver="anderson", tol=mpf(10) ** -50)
    m = (1 + sin(theta)) / 2
    phi = mp.asin(1 / sqrt(2 * m))
    x = sqrt(2 * sin(theta) / load)
    y = 1 - 2 * (ellipe(m) - ellipe(phi, m)) / sqrt(load)
    return theta, x, y


def elastica():
    """Tip of the inextensible cantilever, PL^2/EI = 1, 5, 10, by elliptic integrals; shooting must agree to 1e-19."""
    rows = []
    for load in (1, 5, 10):
        theta, x, y = inextensible_tip(load)
        tip = dead_tip(Beam(1, 1), (mpf(0), -mpf(load)), 4, pieces=1)[-1]
        assert max(abs(tip[0] - x), abs(tip[1] + y), abs(tip[2] + theta)) < mpf(10) ** -19, (load, tip, theta, x, y)
        rows.append([mpf(load), x, -y, -theta])
    show(["load", "x", "y", "angle"], rows)


def tip_load():
    """The same with EA = 1e6 and EI = L = 1, both strain measures, along the beam."""
    rows = []
    for measure in ("engineering", "green"):
        for load in (1, 5, 10):
            beam = Beam(1, 1, mpf(10) ** 6, measure)
            rows += [[measure, mpf(load)] + r for r in sampled(beam, dead_tip(beam, (mpf(0), -mpf(load)), 4))]
    show(["measure", "load"] + SHAPE, rows)


def extensible_cantilever():
    """L = 2 m, E = 2.07e11 Pa, 0.1 m x 0.1 m, dead tip force 3 EI/L^2 downwards."""
    bending, axial = mpf("2.07e11") * mpf("1e-4") / 12, mpf("2.07e9")
    rows = []
    for measure in ("engineering", "green"):
        beam = Beam(2, bending, axial, measure)
        path = dead_tip(beam, (mpf(0), -3 * bending / 4), 4)
        rows += [[measure] + r for r in sampled(beam, path)]
    show(["measure"] + SHAPE, rows)


def follower_tip():
    """Cantilever, EA = 1e6, EI = L = 1, force P normal to the end section.

    Seen from the end section the load is fixed and the moment zero: an initial value problem, integrated from the
    tip to the clamp and then turned so that the clamp lies along x.
    """
    rows = []
    for load in (1, 5, 15):
        for measure in ("engineering", "green"):
            beam = Beam(1, 1, mpf(10) ** 6, measure)
            back = beam.integrate((mpf(0), mpf(0), mpf(0), mpf(0), mpf(0), mpf(load)), -mpf(1), 20)
            x, y, theta = back[-1][:3]
            c, s = cos(theta), sin(theta)
            turn = lambda a, b: (c * a + s * b, c * b - s * a)
            path = []
            for p in reversed(back):
                path.append((*turn(p[0] - x, p[1] - y), p[2] - theta, p[3], *turn(p[4], p[5])))
            rows += [[measure, mpf(load)] + r for r in sampled(beam, path)]
    show(["measure", "load"] + SHAPE, rows)


def distributed():
    """Cantilever, EA = 1e6, EI = L = 1, load q per length: dead downwards, and following the normal."""
    rows = []
    for load in (5, 20):
        beam = Beam(1, 1, mpf(10) ** 6, dead=(0, -load))
        rows += [["dead", mpf(load)] + r for r in sampled(beam, dead_tip(beam, (mpf(0), mpf(0)), 5))]
    for load in (5, 20):
        def problem(factor):
            beam = Beam(1, 1, mpf(10) ** 6, follower=factor * load)
            # the end is free: its angle alone is unknown, so integrate from there; the clamp must lie along x
            end = lambda u: (mpf(0), mpf(0), u[0], mpf(0), mpf(0), mpf(0))
            return lambda u: [beam.integrate(end(u), -mpf(1))[-1][2]]

        angle = grow(problem, [mpf(0)], 5)[0]
        beam = Beam(1, 1, mpf(10) ** 6, follower=load)
        back = beam.integrate((mpf(0), mpf(0), angle, mpf(0), mpf(0), mpf(0)), -mpf(1), 20)
        x, y = back[-1][:2]
        path = [(p[0] - x, p[1] - y, *p[2:]) for p in reversed(back)]
        rows += [["follower", mpf(load)] + r for r in sampled(beam, path)]
    show(["kind", "load"] + SHAPE, rows)


def gravity():
    """The cantilever of the roll-up with E = 689.5 MPa under its own weight, Green strain, g = 9.81 m/s^2."""
    modulus, area, second, density = mpf("689.5e6"), mpf("2.5e-4"), mpf("0.130e-8"), mpf("2766.67")
    beam = Beam(mpf("1.8"), modulus * second, modulus * area, "green", dead=(0, -density * area * mpf("9.81")))
    show(SHAPE, sampled(beam, dead_tip(beam, (mpf(0), mpf(0)), 30)))


def midspan_support():
    """Cantilever, EA = 1e6, EI = L = 1, held in y at s = 0.4 (free to slide in x), dead tip force 10 downwards."""
    place, load = mpf("0.4"), mpf(10)
    beam = Beam(1, 1, mpf(10) ** 6)

    def march(u, factor, pieces=(1, 1)):
        moment, reaction = u
        first = beam.integrate((mpf(0), mpf(0), mpf(0), moment, mpf(0), reaction - factor * load), place, pieces[0])
        held = first[-1]
        second = beam.integrate((*held[:5], held[5] - reaction), 1 - place, pieces[1])
        return first, second

    def problem(factor):
        def residual(u):
            first, second = march(u, factor)
            return [first[-1][1], second[-1][3]]
        return residual

    u = grow(problem, [mpf(0), mpf(0)], 5)
    first, second = march(u, mpf(1), (8, 12))
    rows = sampled(beam, first, 0, place)[:-1] + sampled(beam, second, place, 1 - place)
    show(["reaction"] + SHAPE, [[u[1]] + r for r in rows])


def prescribed_end():
    """Clamped at the origin; the other end is lifted to y = 0.3 L and turned by 120 degrees, free in x. EA = 1e4, EI = L = 1."""
    beam = Beam(1, 1, mpf(10) ** 4)

    def problem(factor):
        def residual(u):
            end = beam.integrate((mpf(0), mpf(0), mpf(0), u[0], mpf(0), u[1]), mpf(1))[-1]
            return [end[1] - factor * mpf("0.3"), end[2] - factor * 2 * pi / 3]
        return residual

    moment, fy = grow(problem, [mpf(0)] * 2, 12)
    path = beam.integrate((mpf(0), mpf(0), mpf(0), moment, mpf(0), fy), mpf(1), 20)
    show(["fy", "moment"] + SHAPE, [[fy, moment] + r for r in sampled(beam, path)])


def deep_arch():
    """Circular arch of 215 degrees, clamped at its start, hinged at its end, dead load P downwards at the crown.

    R = EI = 1, EA = 1e6, engineering strain. The path in the unknowns u = (M, Fx, Fy at the clamp, P) is followed in
    steps of equal length along its tangent; from the last point before the first maximum of P, the maximum along the
    tangent's parameter t is where dP/dt = 0.
    """
    half = mpf(215) / 2 * pi / 180
    beam = Beam(2 * half, 1, mpf(10) ** 6, curvature=-1)
    left, right = (-sin(half), cos(half)), (sin(half), cos(half))

    def march(u):
        moment, fx, fy, load = u
        first = beam.integrate((*left, half, moment, fx, fy), half)[-1]
        second = beam.integrate((*first[:5], first[5] + load), half)[-1]
        return first, second

    def constraint(base, tangent, t):
        """Zero at the point of the path whose projection on the tangent through `base` is t."""
        def residual(u):
            _, end = march(u)
            along = sum((a - b) * c for a, b, c in zip(u, base, tangent)) - t
            return [end[0] - right[0], end[1] - right[1], end[3], along]
        return residual

    def at(base, tangent, t, guess=None):
        return newton(constraint(base, tangent, t), guess or [b + t * c for b, c in zip(base, tangent)])

    def unit(v):
        size = sqrt(sum(a * a for a in v))
        return [a / size for a in v]

    record = [[mpf(0)] * 4]
    tangent = [mpf(0), mpf(0), mpf(0), mpf(1)]
    while len(record) < 3 or record[-1][3] > record[-2][3]:
        record.append(at(record[-1], tangent, mpf(1)))
        tangent = unit([a - b for a, b in zip(record[-1], record[-2])])
        crown = march(record[-1])[0]
        print(f"crown at ({nstr(crown[0], 5)}, {nstr(crown[1], 5)}): P = {nstr(record[-1][3], 8)}", file=sys.stderr)

    base = record[-3]
    tangent = unit([a - b for a, b in zip(record[-1], base)])
    place = {"u": record[-2]}

    def slope(t):
        """dP/dt by the implicit function theorem: J du/dt = (0, 0, 0, 1)."""
        place["u"] = at(base, tangent, t, place["u"])
        residual = constraint(base, tangent, t)
        return lu_solve(derivative(residual, place["u"], residual(place["u"])), matrix([0, 0, 0, 1]))[3]

    low, high = mpf(0), sum((a - b) * c for a, b, c in zip(record[-1], base, tangent))
    values = slope(low), slope(high)
    for _ in range(40):  # regula falsi (Illinois); the load forgives the square of what is left
        t = (low * values[1] - high * values[0]) / (values[1] - values[0])
        v = slope(t)
        print(f"dP/dt = {nstr(v, 5)}", file=sys.stderr)
        if abs(v) < mpf(10) ** -12:
            break
        if v * values[1] < 0:
            low, values = high, (values[1], v)
        else:
            values = (values[0] / 2, v)
        high = t
    limit = at(base, tangent, t, place["u"])
    crown = march(limit)[0]
    place = [nstr(v, 12) for v in crown[:3]]  # of first order in what is left of the slope
    show(["load", "factor", "crown_x", "crown_y", "crown_angle"], [[limit[3], limit[3] / 10, *place]])


CASES = {
    "elastica": elastica,
    "tip-load": tip_load,
    "extensible-cantilever": extensible_cantilever,
    "follower-tip-load": follower_tip,
    "distributed-load": distributed,
    "gravity": gravity,
    "midspan-support": midspan_support,
    "prescribed-end": prescribed_end,
    "deep-arch": deep_arch,
}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: static_beam.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
