"""A plain description of a straight beam along x, solved as the linear beam of Euler and Bernoulli by scikit-fem.

The description is what `verification/src/peers/describe.rs` writes. Of it only deflections w across the beam are here: cubic
elements (ElementLineHermite), stiffness int EI v'' w'', mass int rho A v w. It is what our beam becomes as deflections
become small, and nothing more: whatever pulls along the beam is refused.

Motion goes by the trapezoidal rule (Newmark's method with beta = 1/4, gamma = 1/2), which ours is with a spectral radius of 1.
"""

import json

import numpy as np
import scipy.linalg
import skfem
from skfem.helpers import dd, ddot


class Beam:
    """Matrices and loads with the supports taken out."""

    def __init__(self, given):
        (self.beam,) = given["beams"]
        if given["joints"]:
            raise ValueError("beams must not be joined")
        if self.beam["tangent"] != [1, 0]:
            raise ValueError("the beam must be along x")
        if np.any(self.beam["velocities"]):
            raise ValueError("the beam must start at rest")
        if self.beam["axial_damping"] or self.beam["bending_damping"]:
            raise ValueError("the beam must be without damping")
        if any(load["factors"] for load in given["forces"] + given["moments"]):
            raise ValueError("loads must not follow time")
        if any(support["moved"] for support in given["supports"]):
            raise ValueError("supports must stay")
        self.places = np.array(self.beam["nodes"])
        basis = skfem.Basis(skfem.MeshLine(self.places[:, 0]), skfem.ElementLineHermite(), intorder=6)
        # deflection and slope of every node, from left to right
        self.order = basis.nodal_dofs.T
        stiffness = skfem.BilinearForm(lambda w, v, _: self.beam["bending_stiffness"] * ddot(dd(w), dd(v)))
        mass = skfem.BilinearForm(lambda w, v, _: self.beam["mass_per_length"] * w * v)
        along, across = given["gravity"]
        weight = skfem.LinearForm(lambda v, _: self.beam["mass_per_length"] * across * v)
        load = weight.assemble(basis)
        for force in given["forces"]:
            if force["value"][0] or along:
                raise ValueError("a linear beam feels no force along itself")
            load[self.order[force["node"], 0]] += force["value"][1]
        for moment in given["moments"]:
            load[self.order[moment["node"], 1]] += moment["value"]
        held = set()
        for support in given["supports"]:
            deflection, slope = self.order[support["node"]]
            held |= {deflection} if support["y"] else set()
            held |= {slope} if support["rotation"] != "free" else set()
        self.free = np.setdiff1d(np.arange(load.size), list(held))
        part = np.ix_(self.free, self.free)
        self.stiffness = stiffness.assemble(basis).toarray()[part]
        self.mass = mass.assemble(basis).toarray()[part]
        self.load = load[self.free]

    def nodal(self, free):
        """Deflection and slope of every node."""
        whole = np.zeros(self.order.size)
        whole[self.free] = free
        return whole[self.order]

    def rest(self):
        return [1.0], [np.linalg.solve(self.stiffness, self.load)]

    def motion(self, steps, step, every, spectral_radius):
        if spectral_radius != 1:
            raise ValueError("only a spectral radius of 1, the trapezoidal rule")
        w, v = np.zeros_like(self.load), np.zeros_like(self.load)
        a = np.linalg.solve(self.mass, self.load)
        factor = scipy.linalg.lu_factor(self.mass + step**2 / 4 * self.stiffness)
        times, states = [0.0], [w]
        for k in range(1, steps + 1):
            w, v = w + step * v + step**2 / 4 * a, v + step / 2 * a
            a = scipy.linalg.lu_solve(factor, self.load - self.stiffness @ w)
            w, v = w + step**2 / 4 * a, v + step / 2 * a
            if k % every == 0:
                times.append(k * step)
                states.append(w)
        return times, states

    def frequencies(self, count):
        squares = scipy.linalg.eigh(self.stiffness, self.mass, eigvals_only=True)[:count]
        return list(np.sqrt(np.maximum(squares, 0)) / (2 * np.pi))


def answer(text):
    """From the description as JSON to what the linear beam does, as JSON."""
    given = json.loads(text)
    beam = Beam(given)
    ((kind, question),) = given["analysis"].items()
    found = {"parameter": [], "probes": [], "energy": [], "nodes": [], "frequencies": []}
    if kind == "modal":
        found["frequencies"] = beam.frequencies(**question)
        return json.dumps(found, allow_nan=False)
    found["parameter"], states = beam.rest() if kind == "static" else beam.motion(**question)
    for probe in given["probes"]:
        x, y = beam.places[probe["node"]]
        heights = [y + beam.nodal(state)[probe["node"], 0] for state in states]
        found["probes"].append({"name": probe["name"], "x": [x] * len(heights), "y": heights})
    return json.dumps(found, allow_nan=False)
