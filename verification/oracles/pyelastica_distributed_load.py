"""Tip of a cantilever under an even load q per length, dead or following the normal, by shooting.

PyElastica ships the loads q L^3/EI = 1, 3, ... 25 with a table of tips. Here they are boundary value
problems in 30-digit arithmetic, by the equations and the integrator of `static_beam.py`: of the
elastica, which keeps its length, and of PyElastica's rod without its shear, E = 12 MPa, 10 mm square,
L = 0.5 m, so EA L^2/EI = 30000, with the load per length of the undeformed rod. Lengths are in L;
y counts in the direction of the load.

    python3 pyelastica_distributed_load.py
"""

from mpmath import mpf

from static_beam import Beam, newton, show

LOADS = range(1, 26, 2)
EXTENSIBLE = 30000


def tips(kind, axial):
    """(load, x, y, angle) of the tip; each root starts from the one before, the first from 0."""
    angle = [mpf(0)]
    for load in LOADS:
        beam = Beam(1, 1, axial, **{kind: (0, load) if kind == "dead" else load})
        # The end is free: nothing but its angle is unknown, and at the clamp the beam lies along x.
        back = lambda u: beam.integrate((mpf(0), mpf(0), u[0], mpf(0), mpf(0), mpf(0)), -mpf(1))[-1]
        angle = newton(lambda u: [back(u)[2]], angle)
        x, y = back(angle)[:2]
        yield mpf(load), -x, -y, angle[0]


if __name__ == "__main__":
    rows = []
    for kind in ("dead", "follower"):
        for axial in (None, EXTENSIBLE):
            word = "elastica" if axial is None else "extensible"
            rows += [[kind, word, *tip] for tip in tips(kind, axial)]
    show(["kind", "beam", "load", "x", "y", "angle"], rows)
