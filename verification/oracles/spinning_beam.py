"""A free beam, L = 1, rho A = 1, EA = 1e6, that starts unstretched with 2 pi rad/s and 0.03, 0.01 m/s.

It vibrates about its centrifugally stretched state. With w(s) = rho A omega^2 (a^2 s/2 - s^3/6) / EA, a = L/2, the moment of inertia
is larger by the factor 1 + 2 int s w / int s^2 = 1 + 0.8 rho A omega^2 a^2 / EA in the mean, and the angular velocity smaller by it.

    python3 spinning_beam.py
"""

from mpmath import mp, mpf, pi, nstr

mp.dps = 30
SPEED, HALF, AXIAL = 2 * pi, mpf("0.5"), mpf(10) ** 6

if __name__ == "__main__":
    mean = SPEED * (1 - mpf("0.8") * SPEED**2 * HALF**2 / AXIAL)
    print("t,angle,x,y")
    for t in range(0, 1001, 50):
        print(f"{t},{nstr(mean * t, 15)},{nstr(t * mpf('0.03'), 15)},{nstr(t * mpf('0.01'), 15)}")
