"""Beams whose sections vary along them or consist of layers.

    python3 varying_sections.py tapered-cantilever | tapered-frequencies | stepped-beam | bimetal | laminate

tapered-cantilever   the boundary value problem of static_beam.py with EI(s) and EA(s), by the same integrator
tapered-frequencies  Bessel's functions: a cantilever of constant width whose height falls linearly, and one of
                     circular sections whose diameter does (Kirchhoff 1879); 30 digits
stepped-beam         exact waves a cos bs + b sin bs + c cosh bs + d sinh bs in each of two pieces; 30 digits
bimetal              Timoshenko, J. Opt. Soc. Am. 11 (1925) 233-255, equation 4
laminate             force and couple at the end of two bonded layers: N and M are the same in every section
"""

import sys

from mpmath import mp, mpf, matrix, sin, cos, sinh, cosh, besselj, bessely, besseli, besselk, det, findroot, pi, sqrt
from static_beam import Beam, grow, show, stretch

mp.dps = 30


class VaryingBeam(Beam):
    """EA and EI are functions of s, which is the seventh entry of a state."""

    def slope(self, state):
        *_, theta, moment, fx, fy, s = state
        c, sn = cos(theta), sin(theta)
        g = stretch(fx * c + fy * sn, self.stretch(s), "engineering")
        return g * c, g * sn, moment / self.bend(s), -g * (fy * c - fx * sn), mpf(0), mpf(0), mpf(1)


def tapered_cantilever():
    """L = 1 m, E = 70 GPa, 20 mm wide, 4 mm high at the clamp and 2 mm at the tip, 3 N down at the tip."""
    length, modulus, width = mpf(1), mpf("70e9"), mpf("0.02")
    height = lambda s: mpf("0.004") - mpf("0.002") * s
    beam = VaryingBeam(length, 1)
    beam.stretch = lambda s: modulus * width * height(s)
    beam.bend = lambda s: modulus * width * height(s) ** 3 / 12
    tip = lambda angle, factor: (mpf(0), mpf(0), angle, mpf(0), mpf(0), -3 * factor, length)
    problem = lambda factor: lambda u: [beam.integrate(tip(u[0], factor), -length)[-1][2]]
    angle = grow(problem, [mpf(0)], 4)[0]
    path = beam.integrate(tip(angle, 1), -length, 20)[::-1]
    x0, y0 = path[0][0], path[0][1]
    rows = []
    for k, (x, y, theta, moment, fx, fy, _) in enumerate(path):
        s = length * k / 20
        force = fx * cos(theta) + fy * sin(theta)
        area, resistance = width * height(s), width * height(s) ** 2 / 6
        faces = [force / area + moment / resistance, force / area - moment / resistance]
        rows.append([s, x - x0, y - y0, theta, force, moment, *faces])
    show(["s", "x", "y", "angle", "axial_force", "bending_moment", "stress_bottom", "stress_top"], rows)


def tapered_frequencies():
    """The tip is 0.4 times as high as the clamp; L = 0.5 m, clamp 10 mm high, E = 210 GPa, rho = 7850 kg/m^3.

    With z the distance from the point where the taper would end, EI = c z^(n+2) and rho A = m z^n, n = 1 for constant
    width and 2 for circles: w = z^(-n/2) Z_n(2 k sqrt(z)), Z = J, Y, I, K, k^4 = m w^2 / c.
    """
    length, modulus, density, ratio = mpf("0.5"), mpf("210e9"), mpf(7850), mpf("0.4")
    root = length / (1 - ratio)  # z of the clamp
    tip = ratio * root
    rows = []
    for name, n in (("wedge", 1), ("cone", 2)):
        slope = mpf("0.01") / root  # height or diameter per z
        squared = modulus * slope**2 / density / (12 if n == 1 else 16)  # EI / (rho A z^2)

        def condition(k):
            # d/dz z^(-n/2) Z_n = -+ k z^(-(n+1)/2) Z_(n+1), d/dz z^(n/2) Z_n = +- k z^((n-1)/2) Z_(n-1), x = 2 k sqrt(z).
            lines = []
            for f, down, up in ((besselj, -1, 1), (bessely, -1, 1), (besseli, 1, 1), (besselk, -1, -1)):
                at = lambda order, z, f=f: f(order, 2 * k * sqrt(z))
                lines.append([
                    root ** (-mpf(n) / 2) * at(n, root),
                    down * k * root ** (-mpf(n + 1) / 2) * at(n + 1, root),
                    tip ** (mpf(n + 2) / 2) * at(n + 2, tip),
                    up * k * tip ** (mpf(n + 1) / 2) * at(n + 1, tip),
                ])
            # Columns of the same size, so that the determinant does not overflow.
            return det(matrix([[value / max(map(abs, line)) for value in line] for line in lines]))

        roots, k, step = [], mpf("0.2") / sqrt(length), mpf("0.25") / sqrt(length)
        before = condition(k)
        while len(roots) < 4:
            k += step
            here = condition(k)
            if before * here < 0:
                roots.append(findroot(condition, (k - step, k), solver="anderson", tol=mpf(10) ** -40, verify=False))
            before = here
        for mode, k in enumerate(roots, 1):
            rows.append([name, str(mode), sqrt(squared) * k**2 / (2 * pi)])
    show(["section", "mode", "frequency"], rows)


def stepped_beam():
    """A cantilever of two pieces: EI = 40 and 5 N m^2, rho A = 2 and 0.5 kg/m, joined at 0.35 m of 1 m."""
    pieces = [(mpf("0.35"), mpf(40), mpf(2)), (mpf("0.65"), mpf(5), mpf("0.5"))]

    def carry(omega):
        """Shear force and moment at the tip for w'' = 1 and w''' = 1 at the clamp."""
        columns = []
        for start in ([0, 0, 1, 0], [0, 0, 0, 1]):  # w, w', M, Q = M'
            w, slope, moment, shear = map(mpf, start)
            for length, bending, mass in pieces:
                b = (mass * omega**2 / bending) ** mpf("0.25")
                c, s, ch, sh = cos(b * length), sin(b * length), cosh(b * length), sinh(b * length)
                k0, k1, k2, k3 = (ch + c) / 2, (sh + s) / (2 * b), (ch - c) / (2 * b**2), (sh - s) / (2 * b**3)
                q, r = moment / bending, shear / bending
                b4 = b**4
                w, slope, moment, shear = (
                    k0 * w + k1 * slope + k2 * q + k3 * r,
                    b4 * k3 * w + k0 * slope + k1 * q + k2 * r,
                    bending * (b4 * k2 * w + b4 * k3 * slope + k0 * q + k1 * r),
                    bending * (b4 * k1 * w + b4 * k2 * slope + b4 * k3 * q + k0 * r),
                )
            columns.append((moment, shear))
        (a, b), (c, d) = columns
        return a * d - b * c

    rows, omega, step = [], mpf(1), mpf(1)
    before = carry(omega)
    while len(rows) < 4:
        omega += step
        here = carry(omega)
        if before * here < 0:
            root = findroot(carry, (omega - step, omega), solver="anderson", verify=False)
            rows.append([str(len(rows) + 1), root / (2 * pi)])
        before = here
    show(["mode", "frequency"], rows)


def layers(rows):
    """EA, EB and EI of (E, bottom, top) per width, with EB = -integral of E y."""
    power = lambda n: sum(e * (top ** (n + 1) - bottom ** (n + 1)) / (n + 1) for e, bottom, top in rows)
    return power(0), -power(1), power(2)


def bimetal():
    """Two strips of E = 140 and 210 GPa, 0.8 and 0.5 mm thick, of which the first grows by 1.2e-3 more."""
    e1, e2, a1, a2, grown = mpf("140e9"), mpf("210e9"), mpf("0.0008"), mpf("0.0005"), mpf("0.0012")
    h, m, n = a1 + a2, a1 / a2, e1 / e2
    curvature = 6 * grown * (1 + m) ** 2 / (h * (3 * (1 + m) ** 2 + (1 + m * n) * (m**2 + 1 / (m * n))))
    show(["curvature"], [[curvature]])


def laminate():
    """Layers of E = 70 and 210 GPa, 1 and 2 mm high, 20 mm wide, L = 1 m; the end is pulled by nothing and bent by 1 N m.

    N = 0 and M = 1 N m everywhere: an arc of the curvature of the compliance, stretched evenly.
    """
    width, length = mpf("0.02"), mpf(1)
    rows = [(mpf("70e9") * width, mpf("-0.0015"), mpf("-0.0005")), (mpf("210e9") * width, mpf("-0.0005"), mpf("0.0015"))]
    ea, eb, ei = layers(rows)
    strain, curvature = -eb / (ea * ei - eb**2), ea / (ea * ei - eb**2)
    g = 1 + strain  # |r'|; the curvature is the angle per reference length
    faces = [(e / width) * (strain - z * curvature) for (e, *ends), z in ((rows[0], rows[0][1]), (rows[1], rows[1][2]))]
    lines = []
    for k in range(11):
        s = length * k / 10
        angle = curvature * s
        lines.append([s, g * sin(angle) / curvature, g * (1 - cos(angle)) / curvature, angle, strain, *faces])
    show(["s", "x", "y", "angle", "strain", "stress_bottom", "stress_top"], lines)


CASES = {
    "tapered-cantilever": tapered_cantilever,
    "tapered-frequencies": tapered_frequencies,
    "stepped-beam": stepped_beam,
    "bimetal": bimetal,
    "laminate": laminate,
}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: varying_sections.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
