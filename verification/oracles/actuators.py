"""Strips and fingers that bend by themselves, by closed forms in 30-digit arithmetic.

    python3 actuators.py bimetal    two bonded metals, of which the lower one is warmed up more
    python3 actuators.py tendon     a finger with a tendon beside its centreline, which ends before its tip
"""

import sys

from mpmath import cos, mp, mpf, nstr, sin

mp.dps = 30


def show(header, rows):
    print(",".join(header))
    for row in rows:
        print(",".join(nstr(mpf(v), 17, min_fixed=-8, max_fixed=17) for v in row))


def bimetal():
    """100 mm long; below brass of 1 mm and 100 GPa, above invar of 0.8 mm and 145 GPa; brass would be longer by 1.7e-3.

    Timoshenko 1925: k = 6 e (1 + m)^2/(h (3 (1 + m)^2 + (1 + m n)(m^2 + 1/(m n)))), m = h1/h2, n = E1/E2, e the difference of
    the metals' strains, h the whole height. The strain of the centreline and the stresses follow from no force and no moment.
    """
    length, width = mpf("0.1"), mpf("0.005")
    e1, h1, e2, h2, free = mpf("100e9"), mpf("0.001"), mpf("145e9"), mpf("0.0008"), mpf("1.7e-3")
    h, m, n = h1 + h2, h1 / h2, e1 / e2
    curvature = 6 * free * (1 + m) ** 2 / (h * (3 * (1 + m) ** 2 + (1 + m * n) * (m**2 + 1 / (m * n))))
    # Layers from the lower face at -h/2; y1, y2 their middles. Strain e - k y; no force: the centreline's strain.
    y1, y2 = -h / 2 + h1 / 2, h / 2 - h2 / 2
    strain = (e1 * h1 * (free + curvature * y1) + e2 * h2 * curvature * y2) / (e1 * h1 + e2 * h2)
    stress = lambda e, y, own: e * (strain - curvature * y - own)
    # The moment about the centreline must vanish too: each layer's force at its middle, and its own bending.
    moment = sum(
        stress(e, y, own) * t * y - e * curvature * t**3 / 12 for e, t, y, own in ((e1, h1, y1, free), (e2, h2, y2, 0))
    )
    assert abs(moment) < mpf("1e-15"), moment
    rows = []
    for k in range(11):
        s = length * k / 10
        g = 1 + strain
        rows.append([s, g * sin(curvature * s) / curvature, g * (1 - cos(curvature * s)) / curvature, curvature * s, strain, curvature,
                     stress(e1, -h / 2, free), stress(e2, h / 2, 0)])
    show(["s", "x", "y", "angle", "strain", "curvature", "stress_bottom", "stress_top"], rows)


def tendon():
    """EA = 200 N, EI = 2e-3 N m^2, 100 mm long; a tendon 4 mm to the left of the centreline, from the foot to 80 mm, T = 8 N.

    Its potential T (g - e k) per length, with the stretch g and the curvature k, asks for EA (g - 1) = -T and EI k = T e:
    an arc, shortened by T/EA; beyond its end the finger is straight and as long as it was.
    """
    axial, bending, length, offset, end, tension = mpf(200), mpf("2e-3"), mpf("0.1"), mpf("0.004"), mpf("0.08"), mpf(8)
    curvature, g = tension * offset / bending, 1 - tension / axial
    rows = []
    for k in range(11):
        s = length * k / 10
        a = min(s, end)
        x, y, angle = g * sin(curvature * a) / curvature, g * (1 - cos(curvature * a)) / curvature, curvature * a
        rows.append([s, x + (s - a) * cos(angle), y + (s - a) * sin(angle), angle])
    show(["s", "x", "y", "angle"], rows)


CASES = {"bimetal": bimetal, "tendon": tendon}

if __name__ == "__main__":
    if len(sys.argv) != 2 or sys.argv[1] not in CASES:
        sys.exit(f"usage: actuators.py {' | '.join(CASES)}")
    CASES[sys.argv[1]]()
