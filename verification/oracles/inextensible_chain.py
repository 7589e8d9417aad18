"""A heavy chain that neither bends nor stretches, between two hooks at one height: the catenary.

With the length L, the span h and the weight w per length, a = H/w solves 2 a sinh(h/2a) = L, and from the lowest point on
x = a asinh(s/a), y = sqrt(a^2 + s^2), T = w sqrt(a^2 + s^2).

    python3 inextensible_chain.py
"""

from mpmath import asinh, findroot, mp, mpf, nstr, sinh, sqrt

mp.dps = 30

LENGTH, SPAN, WEIGHT = mpf(1), mpf("0.6"), mpf("9.81")

a = findroot(lambda a: 2 * a * sinh(SPAN / (2 * a)) - LENGTH, mpf("0.15"))
bottom = sqrt(a**2 + (LENGTH / 2) ** 2)
print("s,x,y,tension,horizontal,vertical")
for i in range(41):
    s = LENGTH * i / 40
    t = s - LENGTH / 2
    row = (s, SPAN / 2 + a * asinh(t / a), sqrt(a**2 + t**2) - bottom, WEIGHT * sqrt(a**2 + t**2), WEIGHT * a, WEIGHT * LENGTH / 2)
    print(",".join(nstr(mpf(value), 15) for value in row))
