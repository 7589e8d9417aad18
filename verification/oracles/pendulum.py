"""Flexible pendulums that fall under their own weight, by an explicit Runge-Kutta method of order 8.

A beam of L = 1.8 m, A = 2.5 cm^2, I = 0.130 cm^4, 2766.67 kg/m^3 is pinned at the origin and let go, straight and
horizontal, under g = 9.81 m/s^2 (Chen, Zhang & Li 2018, Section 4.2):

    T = int rho A |r_t|^2 / 2 ds     U = int EA eps^2 / 2 + EI kappa^2 / 2 ds     V = int rho A g y ds
    eps = |r'| - 1 (engineering) or (|r'|^2 - 1) / 2 (green)                      kappa = (r' x r'') / |r'|^2

The beam is cut into even elements with Hermite cubics for r and r' at their ends. Two bubbles make them quintic, for the
limit of many elements, which they approach much faster; without them an element is the one of ANCF, so that another
integrator can be asked for the very same numbers. Points of the plane are complex numbers. The mass matrix is consistent and
inverted once. Nothing damps: energy is kept to 1e-10 J, so that what is left is the error of the mesh.

    python3 pendulum.py soft | elements | shape | energies | stiff
"""

import os
import sys
import time

os.environ["OPENBLAS_NUM_THREADS"] = "1"  # the matrices are too small for more

import numpy as np
from numpy.polynomial import Polynomial
from scipy.integrate import DOP853

LENGTH, AREA, SECOND, DENSITY, GRAVITY = 1.8, 2.5e-4, 0.130e-8, 2766.67, 9.81
SOFT, STIFF = 68.95e6, 68.95e9  # Young's moduli
TIMES = [0.5, 1.0, 1.5, 2.0, 2.5]


class Mesh:
    """Even elements. Their coefficients, node by node: r, r' and the factors of the bubbles in the element that follows."""

    def __init__(self, elements, degree=5):
        self.elements, self.degree, self.size = elements, degree, LENGTH / elements
        self.stride = degree - 1  # coefficients from one node to the next
        self.count = elements * self.stride + 2
        self.index = np.arange(degree + 1)[:, None] + self.stride * np.arange(elements)
        x, h = Polynomial([0, 1]), self.size
        bubbles = [x ** (k + 2) * (1 - x) ** 2 for k in range(degree - 3)]
        left, right = [1 - 3 * x**2 + 2 * x**3, h * x * (1 - x) ** 2], [3 * x**2 - 2 * x**3, h * x**2 * (x - 1)]
        self.functions = [*left, *bubbles, *right]

    def rows(self, places, derivative=0):
        """An element's functions, derived by s, at some places in it (from 0 to 1): one place per row."""
        functions = [f.deriv(derivative) if derivative else f for f in self.functions]
        return np.array([f(places) for f in functions]).T / self.size**derivative

    def gauss(self, points):
        """Places in an element, and weights."""
        x, w = np.polynomial.legendre.leggauss(points)
        return (x + 1) / 2, w / 2 * self.size

    def linear(self, offset, slope):
        """Coefficients of r(s) = offset + slope s."""
        r = np.zeros((self.elements + 1, self.stride), complex)
        r[:, 0], r[:, 1] = offset + slope * np.linspace(0, LENGTH, self.elements + 1), slope
        return r.ravel()[: self.count]

    def local(self, r):
        """The coefficients of every element, one element per column."""
        return r[self.index]

    def total(self, local):
        """The transpose of `local`: what elements share is added."""
        total = np.zeros((self.elements + 1, self.stride), complex)
        total[:-1] = local[: self.stride].T
        total[1:, :2] += local[self.stride :].T
        return total.ravel()[: self.count]

    def mass(self):
        """int N N^T ds."""
        places, weights = self.gauss(self.degree + 1)
        rows = self.rows(places)
        mass = np.zeros((self.count, self.count))
        for first in range(0, self.count - 2, self.stride):
            part = slice(first, first + self.degree + 1)
            mass[part, part] += (rows.T * weights) @ rows
        return mass


def cross(a, b):
    return a.real * b.imag - a.imag * b.real


def square(a):
    return a.real**2 + a.imag**2


class Pendulum:
    """The semi-discrete system. `points`: Gauss points in an element for stretching and for bending."""

    def __init__(self, mesh, modulus, strain="engineering", points=None):
        self.mesh, self.strain = mesh, strain
        self.axial, self.bending = modulus * AREA, modulus * SECOND
        self.mass = DENSITY * AREA * mesh.mass()
        inverse = np.zeros_like(self.mass)
        inverse[1:, 1:] = np.linalg.inv(self.mass[1:, 1:])  # the first coefficient is the pin
        self.inverse = inverse
        self.weight = GRAVITY * self.mass @ mesh.linear(1, 0).real
        self.fall = -1j * inverse @ self.weight

        # r' where stretching is summed, r' and r'' where bending is, one below the other; and back from there to coefficients
        n, m = points or (mesh.degree + 1, mesh.degree + 1)
        (s, self.stretch_weights), (b, self.bend_weights) = mesh.gauss(n), mesh.gauss(m)
        rows = np.vstack([mesh.rows(s, 1), mesh.rows(b, 1), mesh.rows(b, 2)])
        weights = np.concatenate([self.stretch_weights, self.bend_weights, self.bend_weights])
        self.forward, self.backward = rows + 0j, -weights * rows.T + 0j
        self.parts = slice(0, n), slice(n, n + m), slice(n + m, n + 2 * m)

    def fields(self, r):
        """r' at the points of stretching; r', r'' at those of bending."""
        fields = self.forward @ self.mesh.local(r)
        return (fields[part] for part in self.parts)

    def acceleration(self, r):
        slope, tangent, second = self.fields(r)
        g2 = square(slope)
        strain = 1 - 1 / np.sqrt(g2) if self.strain == "engineering" else (g2 - 1) / 2
        stretching = self.axial * strain * slope
        g2 = square(tangent)
        kappa = cross(tangent, second) / g2
        moment = self.bending / g2 * kappa
        # the gradient of a x b by a is -i b, by b it is i a
        turning = 1j * moment
        bending = -2 * moment * kappa * tangent - turning * second, turning * tangent
        force = self.mesh.total(self.backward @ np.concatenate([stretching, *bending]))
        return (self.inverse @ force.view(float).reshape(-1, 2)).view(complex)[:, 0] + self.fall

    def highest_frequency(self):
        """Of the straight beam [rad/s], from differences of the acceleration along the beam and across it."""
        straight, step = self.mesh.linear(0, 1), 1e-6 * self.mesh.size
        squares = []
        for direction, part in ((1, np.real), (1j, np.imag)):
            moved = direction * step * np.eye(self.mesh.count)[1:]
            stiffness = [part(self.acceleration(straight - d) - self.acceleration(straight + d))[1:] for d in moved]
            squares += list(np.linalg.eigvals(np.array(stiffness) / (2 * step)).real)
        return max(squares) ** 0.5

    def motion(self, times):
        """r and its rate at some times, from rest."""

        def rate(_, state):
            r, v = state.view(complex).reshape(2, -1)
            return np.concatenate([v, self.acceleration(r)]).view(float)

        start, clock = self.mesh.linear(0, 1), time.perf_counter()
        state = np.concatenate([start, 0 * start]).view(float)
        # Stability limits the step, not accuracy: a hundredth of these tolerances moves the tip by 3e-9 m.
        # Much closer to that limit one step in four would be tried in vain.
        solver = DOP853(rate, 0, state, times[-1], max_step=3.5 / self.highest_frequency(), rtol=1e-7, atol=1e-9)
        states = []
        for t in times:
            while solver.t < t:
                solver.step()
            states.append((solver.dense_output()(t) if t else state).view(complex).reshape(2, -1))
        drift = abs(sum(self.energies(*states[-1])))
        print(
            f"{self.mesh.elements} elements of degree {self.mesh.degree}, EA = {self.axial:.3e} N, {self.strain}: "
            f"{solver.nfev} evaluations, {time.perf_counter() - clock:.0f} s, energy {drift:.0e} J",
            file=sys.stderr,
        )
        assert drift < 1e-9
        return states

    def energies(self, r, v):
        """Kinetic, stretch, bend, potential [J]."""
        slope, tangent, second = self.fields(r)
        g = abs(slope)
        strain = g - 1 if self.strain == "engineering" else (g * g - 1) / 2
        kappa = cross(tangent, second) / square(tangent)
        return (
            (v.conj() @ self.mass @ v).real / 2,
            self.axial / 2 * (self.stretch_weights @ strain**2).sum(),
            self.bending / 2 * (self.bend_weights @ kappa**2).sum(),
            self.weight @ r.imag,
        )

    def curve(self, r, pieces):
        """s, r and kappa at the ends of even pieces of the beam; between two elements, of the one on the right."""
        whole, part = np.divmod(np.arange(pieces + 1) * self.mesh.elements, pieces)
        whole[-1], part[-1] = self.mesh.elements - 1, pieces
        own = self.mesh.local(r)[:, whole].T
        r, tangent, second = ((self.mesh.rows(part / pieces, k) * own).sum(axis=1) for k in range(3))
        return np.linspace(0, LENGTH, pieces + 1), r, cross(tangent, second) / square(tangent)

    def tips(self):
        return np.array([r[-2] for r, _ in self.motion(TIMES)])


def show(header, rows):
    """A CSV table."""
    print(header)
    for row in rows:
        print(",".join(f"{v:.8f}" if isinstance(v, float) else str(v) for v in row))


def soft():
    """Tip of the soft pendulum; error: how far a coarser mesh is from it (48 elements, in two minutes more, half as far)."""
    rows = []
    for strain in ("engineering", "green"):
        coarse, fine = (Pendulum(Mesh(elements), SOFT, strain).tips() for elements in (24, 32))
        rows += [(strain, t, z.real, z.imag, abs(z - c)) for t, z, c in zip(TIMES, fine, coarse)]
    show("strain,t,x,y,error", rows)


def elements():
    """Tip of the soft pendulum by ANCF elements, 5 Gauss points for stretching and 3 for bending."""
    rows = []
    for count in (13, 17, 23, 30):
        tips = Pendulum(Mesh(count, degree=3), SOFT, points=(5, 3)).tips()
        rows += [(count, t, z.real, z.imag) for t, z in zip(TIMES, tips)]
    show("elements,t,x,y", rows)


def shape():
    """The soft pendulum at 2.5 s; error: how far the curvature of a coarser mesh is from its own."""
    curves = []
    for count in (24, 32):
        pendulum = Pendulum(Mesh(count), SOFT)
        curves.append(pendulum.curve(pendulum.motion([2.5])[-1][0], 200))
    (_, _, coarse), (s, r, kappa) = curves
    show("s,x,y,curvature,error", zip(s, r.real, r.imag, kappa, abs(kappa - coarse)))


def energies():
    """Energies of the soft pendulum every 50 ms."""
    pendulum, times = Pendulum(Mesh(24), SOFT), [k / 20 for k in range(51)]
    rows = [(t, *pendulum.energies(*state)) for t, state in zip(times, pendulum.motion(times))]
    show("t,kinetic,stretch,bend,potential", rows)


def stiff():
    """Tip of the stiff pendulum; error: its distance from the same by the coarser mesh alone.

    Axial waves would force the explicit method to steps of 1e-5 s, though the beam stretches by a few 1e-6 only. As long as
    they are much faster than bending, the tip is linear in the axial compliance 1/EA: it is computed with a 16th of EA, and
    led back to the whole of it along the line through a 16th and a 32nd, found with a coarser mesh. For
    twelve elements of degree 5 this line missed a run with the whole EA by 3e-8 m.
    """

    def softened(count, factor):
        pendulum = Pendulum(Mesh(count), STIFF)
        pendulum.axial /= factor
        return pendulum.tips()

    fine, coarse, softer = softened(8, 16), softened(5, 16), softened(5, 32)
    tips = fine + 15 / 16 * (coarse - softer)
    show("t,x,y,error", [(t, z.real, z.imag, abs(f - c)) for t, z, f, c in zip(TIMES, tips, fine, coarse)])


CASES = {"soft": soft, "elements": elements, "shape": shape, "energies": energies, "stiff": stiff}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: pendulum.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
