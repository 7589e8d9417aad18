"""The pendulum whose beam cannot stretch, EA -> infinity, by its angle in Legendre polynomials and an explicit method of order 8.

    r(s) = int_0^s (cos theta, sin theta) ds      L T = int rho A |r_t|^2 / 2      U = int EI theta'^2 / 2      V = int rho A g y

theta(s, t) = sum_k q_k(t) P_k(2 s/L - 1). With the normal n and tangent t of the centreline, dr/dq_k = int_0^s P_k n, and the
equations are M(q) q'' = f with M_kl = int rho A dr/dq_k . dr/dq_l. Integrals over s up to a Gauss point are those of the
polynomial through the Gauss points. No axial stiffness occurs, so that nothing grows with slenderness.

    python3 inextensible.py
"""

import os

os.environ["OPENBLAS_NUM_THREADS"] = "1"

import numpy as np
from numpy.polynomial import legendre
from scipy.integrate import DOP853

LENGTH, MASS, BENDING, GRAVITY = 1.0, 1.0, 10.0, 9.81
TIMES = np.arange(1, 6) * 0.1


class Chain:
    def __init__(self, terms, points):
        x, w = legendre.leggauss(points)
        self.weights = w * LENGTH / 2
        self.shapes = legendre.legvander(x, terms - 1)
        slopes = np.array([legendre.legval(x, legendre.legder(np.eye(terms)[k])) for k in range(terms)]).T * 2 / LENGTH
        self.stiffness = BENDING * slopes.T @ (self.weights[:, None] * slopes)
        # values at the Gauss points -> Legendre coefficients -> integral from 0 to the Gauss points, and to the end
        to_coefficients = np.linalg.inv(legendre.legvander(x, points - 1))
        integral = np.array([legendre.legint(row, lbnd=-1) for row in np.eye(points)]) * LENGTH / 2
        self.upto = legendre.legvander(x, points) @ integral.T @ to_coefficients
        self.whole = integral.sum(axis=1) @ to_coefficients

    def kinematics(self, q):
        theta = self.shapes @ q
        return np.cos(theta), np.sin(theta)

    def acceleration(self, q, v):
        c, s = self.kinematics(q)
        rate = self.shapes @ v
        x, y = self.upto @ (-s[:, None] * self.shapes), self.upto @ (c[:, None] * self.shapes)
        ax, ay = self.upto @ (-c * rate**2), self.upto @ (-s * rate**2)
        weights = MASS * self.weights
        mass = x.T @ (weights[:, None] * x) + y.T @ (weights[:, None] * y)
        force = -self.stiffness @ q - x.T @ (weights * ax) - y.T @ (weights * (ay + GRAVITY))
        return np.linalg.solve(mass, force)

    def tip(self, q):
        c, s = self.kinematics(q)
        return self.whole @ c, self.whole @ s


def fall(terms, points):
    chain = Chain(terms, points)
    slope = lambda _, z: np.concatenate([z[terms:], chain.acceleration(z[:terms], z[terms:])])
    solver = DOP853(slope, 0.0, np.zeros(2 * terms), TIMES[-1], rtol=1e-11, atol=1e-12)
    tips, due = [], list(TIMES)
    while solver.status == "running":
        solver.step()
        between = solver.dense_output()
        while due and due[0] <= solver.t + 1e-12:
            tips.append(chain.tip(between(min(due.pop(0), solver.t))[:terms]))
    return np.array(tips)


if __name__ == "__main__":
    fine, coarse = fall(14, 40), fall(12, 36)
    defect = np.abs(fine - coarse).max()
    assert defect < 5e-6, defect  # of the coarser one
    print("t,x,y")
    for t, (x, y) in zip(TIMES, fine):
        print(f"{t:.1f},{x:.9f},{y:.9f}")
