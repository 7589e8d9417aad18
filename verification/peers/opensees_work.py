"""How long OpenSees takes to solve a plain description of planar beams, under settings that are chosen.

Every element of the description is one of OpenSees' beam elements with the corotational transformation: engineering strain of the
chord, and bending that is small against it. `element` says which one.

- OpenSees has one model for the whole process: it is wiped before and after each repetition, so that none starts from another's.
- Timed is the call of `analyze`, or of `eigen`, alone. Nothing is recorded: nodes are asked between two calls.
- Its nodes have places and rotations and no gradients. That of a node is given the direction of its rotation, and as length the
  stretch of the elements beside it, in the mean: what an ANCF element through the same nodes would have.
- Welded nodes are one node, and those on a hinge share their displacements.
- The weight acts at the nodes, as OpenSees' load along an element turns with it. That and lumped mass err in the second order of an
  element's length, as the elements themselves do.
"""

import json
import os
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent))

try:
    import openseespy.opensees as ops
except Exception as error:  # it raises RuntimeError for what ImportError would be
    raise ImportError(f"OpenSees cannot be loaded (Debian: apt install libblas3 liblapack3 libgfortran5): {error}") from error

ops.logFile(os.devnull, "-noEcho")  # what does not converge is said by what it returns

X, Y, ANGLE = 1, 2, 3  # OpenSees counts degrees of freedom from one
TRANSFORMATION, SECTION, POINTS, LOAD = 1, 1, 1, 1  # tags, each of a kind of its own


def integrator(scheme, radius):
    """OpenSees' name and numbers of a method of second order in time, with the spectral radius that the description asks for."""
    if scheme == "newmark":
        if radius != 1:
            raise ValueError("Newmark's method of second order has a spectral radius of 1")
        return "Newmark", 1 / 2, 1 / 4
    if scheme == "generalized-alpha":
        inertia, force = (2 - radius) / (1 + radius), 1 / (1 + radius)  # parts of the new state, not of the old
        return "GeneralizedAlpha", inertia, force, 1 / 2 + inertia - force, (1 + inertia - force) ** 2 / 4
    if scheme == "hht":
        return "HHT", 2 * radius / (1 + radius)
    if scheme == "trbdf2":  # the radius of its second half is 0, whatever is asked for
        return ("TRBDF2",)
    raise ValueError(f"no method of OpenSees is called `{scheme}` here")


ALGORITHM = {
    "full": ["Newton"],
    "initial": ["Newton", "-initial"],
    "modified": ["ModifiedNewton"],
    "krylov": ["KrylovNewton"],
    "line-search": ["NewtonLineSearch"],
    "bfgs": ["BFGS"],
    "linear": ["Linear"],
}
DEFAULT = {
    "element": "elasticBeamColumn",
    "mass": "lumped",
    "scheme": "newmark",
    "newton": "full",
    "test": "NormDispIncr",
    "tolerance": "1e-8",
    "iterations": "50",
    "solver": "BandGeneral",
    "eigen": "-genBandArpack",
    "points": "2",
    "reference": "0",
}


class Beams:
    """The model in OpenSees, with its nodes by beam."""

    def __init__(self, given, chosen):
        unknown = chosen.keys() - DEFAULT.keys()
        if unknown:
            raise ValueError(f"no setting of OpenSees is called {sorted(unknown)} here")
        self.given, self.chosen = given, {**DEFAULT, **chosen}
        ops.wipe()
        ops.model("basic", "-ndm", 2, "-ndf", 3)
        ops.geomTransf("Corotational", TRANSFORMATION)
        self.nodes, self.elements = [], 0
        self.one, self.tags = {}, {}  # places that are the node of another place, and the nodes of all others
        for joint in given["joints"]:
            first, second = (self.place_of(joint[which]) for which in ("first", "second"))
            if joint["weld"] and first != second:
                self.one[second] = first
        for beam in given["beams"]:
            self.add_beam(beam)
        for joint in given["joints"]:
            if not joint["weld"]:
                ops.equalDOF(*(self.nodes[beam][node] for beam, node in (joint["first"], joint["second"])), X, Y)
        for support in given["supports"]:
            if support["moved"]:
                raise ValueError("supports must stay")
            angle = support["rotation"] != "free"
            ops.fix(self.node(support), int(support["x"]), int(support["y"]), int(angle))
        self.add_loads()

    def node(self, at):
        return self.nodes[at["beam"]][at["node"]]

    def add_beam(self, beam):
        if beam["axial_damping"] or beam["bending_damping"]:
            raise ValueError("beams must be without damping")
        if np.any(beam["velocities"]):
            raise ValueError("beams must start at rest")
        nodes, new = self.tags_of(len(self.nodes), len(beam["nodes"]))
        turn = np.radians(float(self.chosen["reference"]))
        places = np.array(beam["nodes"])
        turned = places[0] + (places - places[0]) @ [[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]]
        for tag, place in zip(nodes, turned):
            if tag in new:
                ops.node(tag, *place)
        element, section = self.chosen["element"], [1.0, beam["axial_stiffness"], beam["bending_stiffness"]]
        mass = ["-mass", beam["mass_per_length"]]
        if self.chosen["mass"] == "consistent":
            mass.append("-cMass")
        if element != "elasticBeamColumn":
            number = SECTION + len(self.nodes)
            ops.section("Elastic", number, *section)
            ops.beamIntegration("Legendre" if "disp" in element else "Lobatto", number, number, int(self.chosen["points"]))
            section = None
        for a, b in zip(nodes, nodes[1:]):
            self.elements += 1
            if section:
                # area 1, so that the modulus is EA and the second moment EI / EA
                _, stretch, bend = section
                ops.element(element, self.elements, a, b, 1.0, stretch, bend / stretch, TRANSFORMATION, *mass)
            else:
                ops.element(element, self.elements, a, b, TRANSFORMATION, number, *mass)
        # After the elements, which would take what they find for their undeformed state.
        for tag, back in zip(nodes, places - turned) if turn else ():
            for freedom, value in ((X, back[0]), (Y, back[1]), (ANGLE, -turn)):
                ops.setNodeDisp(tag, freedom, value, "-commit")
        self.nodes.append(nodes)

    def place_of(self, place):
        """Beam and node of the first place that is welded to this one."""
        place = tuple(place)
        while place in self.one:
            place = self.one[place]
        return place

    def tags_of(self, beam, count):
        """The nodes of a beam, and those among them that are not there yet."""
        nodes, new = [], set()
        for node in range(count):
            place = self.place_of((beam, node))
            if place not in self.tags:
                self.tags[place] = len(self.tags) + 1
                new.add(self.tags[place])
            nodes.append(self.tags[place])
        return nodes, new

    def add_loads(self):
        given = self.given
        held = {(self.node(s), freedom) for s in given["supports"] for freedom, on in ((X, s["x"]), (Y, s["y"])) if on}
        dynamic = "dynamic" in given["analysis"]
        ops.timeSeries("Constant" if dynamic else "Linear", LOAD)
        ops.pattern("Plain", LOAD, LOAD)
        for load in given["forces"] + given["moments"]:
            if load["factors"] or load.get("follower"):
                raise ValueError("loads must neither follow time nor turn")
        for force in given["forces"]:
            ops.load(self.node(force), *force["value"], 0.0)
        for moment in given["moments"]:
            ops.load(self.node(moment), 0.0, 0.0, moment["value"])
        for beam, nodes in zip(given["beams"], self.nodes):
            halves = np.array(beam["lengths"]) / 2
            for node, length in zip(nodes, np.append(halves, 0) + np.append(0, halves)):
                if any(given["gravity"]):
                    ops.load(node, *(beam["mass_per_length"] * length * g for g in given["gravity"]), 0.0)
                    # OpenSees starts without acceleration, which makes methods of second order err in the first.
                    for freedom, value in zip((X, Y), given["gravity"]):
                        if (node, freedom) not in held:
                            ops.setNodeAccel(node, freedom, value, "-commit")

    def prepare(self, *method):
        chosen = self.chosen
        ops.constraints("Plain")
        ops.numberer("RCM" if self.given["joints"] else "Plain")  # a chain is numbered well as it is
        ops.system(chosen["solver"])
        ops.test(chosen["test"], float(chosen["tolerance"]), int(chosen["iterations"]), 0)
        ops.algorithm(*ALGORITHM[chosen["newton"]])
        ops.integrator(*method)

    def go(self, *steps):
        """Seconds that OpenSees takes for these steps."""
        start = time.perf_counter()
        failed = ops.analyze(*steps)
        seconds = time.perf_counter() - start
        if failed:
            raise RuntimeError("the solver gave up")
        return seconds

    def place(self, node):
        return np.array(ops.nodeCoord(node)) + ops.nodeDisp(node)[:2]

    def gradients(self, beam, nodes):
        """Place and gradient of every node."""
        places = np.array([self.place(node) for node in nodes])
        stretch = np.hypot(*np.diff(places, axis=0).T) / beam["lengths"]
        stretch = (np.append(stretch[0], stretch) + np.append(stretch, stretch[-1])) / 2
        start = np.arctan2(*beam["tangent"][::-1]) + np.radians(float(self.chosen["reference"]))
        angles = start + [ops.nodeDisp(node, ANGLE) for node in nodes]
        return np.column_stack([places, stretch * np.cos(angles), stretch * np.sin(angles)])

    def equilibrium(self, steps):
        self.prepare("LoadControl", 1 / steps)
        ops.analysis("Static", "-noWarnings")
        seconds = self.go(steps)
        return seconds, [1.0], [self.record()]

    def motion(self, steps, step, every, spectral_radius):
        self.prepare(*integrator(self.chosen["scheme"], spectral_radius))
        ops.analysis("Transient", "-noWarnings")
        seconds, times, records = 0.0, [0.0], [self.record()]
        for _ in range(steps // every):
            seconds += self.go(every, step)
            times.append(ops.getTime())
            records.append(self.record())
        return seconds, times, records

    def record(self):
        return [self.place(self.node(probe)) for probe in self.given["probes"]]

    def frequencies(self, count):
        start = time.perf_counter()
        squares = ops.eigen(self.chosen["eigen"], count)
        seconds = time.perf_counter() - start
        return seconds, list(np.sqrt(np.maximum(squares, 0)) / (2 * np.pi))


def solve(given, chosen):
    """Seconds, and what is found."""
    beams = Beams(given, chosen)
    ((kind, question),) = given["analysis"].items()
    if kind == "modal":
        seconds, frequencies = beams.frequencies(**question)
        return seconds, {"frequencies": frequencies}
    seconds, parameter, records = beams.equilibrium(**question) if kind == "static" else beams.motion(**question)
    found = {
        "parameter": parameter,
        "steps": question["steps"],
        "probes": [
            {"name": probe["name"], "x": [float(r[k][0]) for r in records], "y": [float(r[k][1]) for r in records]}
            for k, probe in enumerate(given["probes"])
        ],
        "nodes": [beams.gradients(*both).tolist() for both in zip(given["beams"], beams.nodes)],
    }
    return seconds, found


def answer(text):
    """From {description, settings, repeat} as JSON to what OpenSees finds and how long each repetition took, as JSON."""
    question = json.loads(text)
    try:
        runs = [solve(question["description"], question["settings"]) for _ in range(question["repeat"])]
    finally:
        ops.wipe()
    return json.dumps({"seconds": [seconds for seconds, _ in runs], **runs[-1][1]}, allow_nan=False)
