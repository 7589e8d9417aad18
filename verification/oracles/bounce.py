"""A rod that falls flat on a plane by penalty, with and without regularised friction.

Above the plane y'' = -g; below it y'' = -g - w^2 y with w^2 = k / rho A, so that a contact that begins with the speed v lasts
(2 pi - 2 phi) / w with phi = atan2(v w, g) and ends with the speed -v: every bounce is like the first. Friction slides
throughout: it takes mu times the impulse y' + v + g t of the contact from the speed along the plane. Its springs, as stiff as the contact, hold
k (mu <-y>)^2 / 2 of that; the rest is lost. A flat rod stays flat: all of it has one depth and one speed.

    python3 bounce.py
"""

from mpmath import atan2, cos, floor, mp, mpf, nstr, pi, sin, sqrt

mp.dps = 30

GRAVITY, HEIGHT, STIFFNESS, MASS = mpf("9.81"), mpf("0.2"), mpf(10000), mpf(1)
ALONG, FRICTION = mpf(2), mpf("0.1")

OMEGA = sqrt(STIFFNESS / MASS)
SPEED = sqrt(2 * GRAVITY * HEIGHT)
PHASE = atan2(SPEED * OMEGA, GRAVITY)
CONTACT = (2 * pi - 2 * PHASE) / OMEGA
FALL = SPEED / GRAVITY
IMPULSE = 2 * SPEED + GRAVITY * CONTACT


def normal(t):
    """Height, speed, and all impulse per mass of the contacts until t."""
    if t < FALL:
        return HEIGHT - GRAVITY * t**2 / 2, -GRAVITY * t, mpf(0)
    period = CONTACT + 2 * FALL
    count = floor((t - FALL) / period)
    t = t - FALL - count * period
    if t < CONTACT:
        depth, largest = GRAVITY / OMEGA**2, sqrt(GRAVITY**2 / OMEGA**2 + SPEED**2) / OMEGA
        y = largest * cos(OMEGA * t + PHASE) - depth
        v = -largest * OMEGA * sin(OMEGA * t + PHASE)
        return y, v, count * IMPULSE + v + SPEED + GRAVITY * t
    t = t - CONTACT
    return SPEED * t - GRAVITY * t**2 / 2, SPEED - GRAVITY * t, (count + 1) * IMPULSE


if __name__ == "__main__":
    print("ground,t,y,vy,vx,lost")
    for ground, friction in (("smooth", mpf(0)), ("rough", FRICTION)):
        for i in range(51):
            t = mpf(i) / 50
            y, vy, impulse = normal(t)
            vx = ALONG - friction * impulse
            held = STIFFNESS * (friction * max(-y, mpf(0))) ** 2 / 2
            lost = MASS * (ALONG**2 - vx**2) / 2 - held
            print(",".join([ground, *(nstr(value, 15) for value in (t, y, vy, vx, lost))]))
