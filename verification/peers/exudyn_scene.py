"""A plain description of planar cables, solved by Exudyn's ANCFCable2D.

The description is what `verification/src/peers/describe.rs` writes: nodes with position and tangent, stiffnesses,
supports and loads at nodes, and one analysis. Nothing is decided here that is not in it, except how Exudyn is told.

- A support is one linear constraint on the four coordinates [x, y, x', y'] of a node, so that the direction of a
  gradient can be held at any inclination of the beam: n . r' = 0 with n across the beam. The constraint is on the
  coordinates themselves, reference included, although those of Exudyn's nodes are counted from the reference.
- A hinge is two linear constraints on the coordinates of both nodes; a weld is Exudyn's joint between the frames of both nodes, which
  turn with the directions of their gradients.
- A follower's components are along and across the tangent; ours are those of the fixed frame in the undeformed state.
- A moment acts through the node's orientation, atan2(y', x'), as ours does.
- Loads grow with the load factor, in statics only; in a motion they are multiplied by the factors
  that are given for the start and for the end of every step, and so are supports moved. Index 3 asks
  for what is held at no other time.
- Exudyn starts with loose tolerances of Newton's method; here the residual is absolute and small.
"""

import contextlib
import io
import json
import sys
import warnings

import numpy as np
import scipy.linalg

sys.exudynFast = True  # the library without range checks; read once, while it is imported
warnings.simplefilter("ignore", DeprecationWarning)
with contextlib.redirect_stdout(io.StringIO()):
    import exudyn as exu
    import exudyn.itemInterface as item

exu.config.printToConsole = False

# Gauss points for stretching and bending -> Exudyn's number for them
QUADRATURE = {(5, 3): 0, (4, 2): 1}


class Cables:
    """The model in Exudyn, with its nodes by beam."""

    def __init__(self, given):
        self.given = given
        self.container = exu.SystemContainer()  # kept, for the system lives in it
        self.mbs = self.container.AddSystem()
        self.nodes = []
        for beam in given["beams"]:
            self.add_beam(beam)
        for support in given["supports"]:
            self.add_support(**support)
        for joint in given["joints"]:
            self.add_joint(**joint)
        for force in given["forces"]:
            self.add_force(force)
        for moment in given["moments"]:
            self.add_load(item.Torque, moment, [0, 0, moment["value"]])

    def add_beam(self, beam):
        mbs = self.mbs
        nodes = [
            mbs.AddNode(
                item.NodePoint2DSlope1(referenceCoordinates=[*position, *beam["tangent"]], initialVelocities=velocity)
            )
            for position, velocity in zip(beam["nodes"], beam["velocities"])
        ]
        for a, b, length in zip(nodes, nodes[1:], beam["lengths"]):
            cable = mbs.AddObject(
                item.ObjectANCFCable2D(
                    length=length,
                    massPerLength=beam["mass_per_length"],
                    axialStiffness=beam["axial_stiffness"],
                    bendingStiffness=beam["bending_stiffness"],
                    axialDamping=beam["axial_damping"],
                    bendingDamping=beam["bending_damping"],
                    nodeNumbers=[a, b],
                    useReducedOrderIntegration=QUADRATURE[tuple(beam["gauss_points"])],
                )
            )
            mass = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=cable))
            mbs.AddLoad(item.LoadMassProportional(markerNumber=mass, loadVector=[*self.given["gravity"], 0]))
        self.nodes.append(nodes)

    def add_support(self, beam, node, x, y, rotation, moved):
        given = self.given["beams"][beam]
        place, tangent = given["nodes"][node], given["tangent"]

        def held(by):
            """Rows and an offset, which they times the coordinates are; moved by x, y and an angle."""
            c, s = np.cos(by[2]), np.sin(by[2])
            along = [c * tangent[0] - s * tangent[1], s * tangent[0] + c * tangent[1]]
            rows, offset = [], []
            if x:
                rows, offset = [[1, 0, 0, 0]], [place[0] + by[0]]
            if y:
                rows, offset = [*rows, [0, 1, 0, 0]], [*offset, place[1] + by[1]]
            if rotation == "angle":
                rows, offset = [*rows, [0, 0, -along[1], along[0]]], [*offset, 0]
            if rotation == "gradient":
                rows, offset = [*rows, [0, 0, 1, 0], [0, 0, 0, 1]], [*offset, *along]
            return np.array(rows, float), np.array(offset, float)

        mbs = self.mbs
        ground = mbs.AddNode(item.NodePointGround())
        markers = [
            mbs.AddMarker(item.MarkerNodeCoordinates(nodeNumber=ground)),
            mbs.AddMarker(item.MarkerNodeCoordinates(nodeNumber=self.nodes[beam][node])),
        ]
        rows, offset = held([0, 0, 0])
        none = np.zeros((len(rows), 0))
        options = {"scalingMarker0": none, "scalingMarker1": rows, "offset": offset}
        if moved is not None:
            now = [held(by) for by in moved]

            def missed(mbs, t, number, q, q_t, velocity_level):
                rows, offset = now[self.step_at(t)]
                return rows @ q - offset

            def rows_then(mbs, t, number, q, q_t, velocity_level):
                return now[self.step_at(t)][0]

            options = {
                "scalingMarker0": np.zeros((len(rows), 1)),
                "constraintUserFunction": missed,
                "jacobianUserFunction": rows_then,
            }
        mbs.AddObject(item.ObjectConnectorCoordinateVector(markerNumbers=markers, **options))

    def add_joint(self, first, second, weld):
        mbs = self.mbs
        nodes = [self.nodes[beam][node] for beam, node in (first, second)]
        if not weld:
            markers = [mbs.AddMarker(item.MarkerNodeCoordinates(nodeNumber=node)) for node in nodes]
            rows = np.eye(2, 4)
            options = {"scalingMarker0": rows, "scalingMarker1": rows, "offset": np.zeros(2)}
            mbs.AddObject(item.ObjectConnectorCoordinateVector(markerNumbers=markers, **options))
            return
        markers = [mbs.AddMarker(item.MarkerNodeRigid(nodeNumber=node)) for node in nodes]
        a, b = (self.given["beams"][beam]["tangent"] for beam, _ in (first, second))
        along, across = np.dot(a, b), b[0] * a[1] - b[1] * a[0]  # what turns the second frame into the first
        turn = [[along, -across, 0], [across, along, 0], [0, 0, 1]]
        mbs.AddObject(item.GenericJoint(markerNumbers=markers, constrainedAxes=[1, 1, 0, 0, 0, 1], rotationMarker1=turn))

    def step_at(self, time):
        """Number of the step that ends at a time."""
        return round(time / self.given["analysis"]["dynamic"]["step"])

    def add_force(self, force):
        along, across = self.given["beams"][force["beam"]]["tangent"]
        x, y = force["value"]
        if force["follower"]:
            x, y = along * x + across * y, along * y - across * x
        self.add_load(item.Force, force, [x, y, 0], bodyFixed=force["follower"])

    def add_load(self, kind, load, vector, **options):
        factors = load["factors"]
        if factors is not None:

            def then(mbs, t, whole):
                return factors[self.step_at(t)] * np.array(whole)

            options["loadVectorUserFunction"] = then
        marker = self.mbs.AddMarker(item.MarkerNodeRigid(nodeNumber=self.nodes[load["beam"]][load["node"]]))
        self.mbs.AddLoad(kind(markerNumber=marker, loadVector=vector, **options))

    def watch(self, kind):
        """Sensors that keep a kind of coordinates of every node, beam by beam."""
        return [
            [
                self.mbs.AddSensor(
                    item.SensorNode(
                        nodeNumber=node, outputVariableType=kind, storeInternal=True, writeToFile=False
                    )
                )
                for node in nodes
            ]
            for nodes in self.nodes
        ]

    def seen(self, sensors):
        """Times, and per beam an array [record, node, coordinate]."""
        beams = [np.array([self.mbs.GetSensorStoredData(sensor) for sensor in nodes]) for nodes in sensors]
        return beams[0][0, :, 0], [beam[:, :, 1:].transpose(1, 0, 2) for beam in beams]

    def solve(self):
        """Load factors or times, and per beam the coordinates' changes and rates [record, node, coordinate]."""
        ((kind, question),) = self.given["analysis"].items()
        kinds = exu.OutputVariableType
        places, rates = self.watch(kinds.Coordinates), self.watch(kinds.Coordinates_t)
        self.mbs.Assemble()
        settings = quiet()
        if kind == "static":
            settings.staticSolver.numberOfLoadSteps = question["steps"]
            settings.solution.sensors.writePeriod = 1
            done = self.mbs.SolveStatic(settings)
        else:
            time, step = settings.timeIntegration, question["step"]
            time.numberOfSteps, time.endTime = question["steps"], question["steps"] * step
            time.adaptiveStep = False
            settings.solution.sensors.writePeriod = question["every"] * step
            radius = question["spectral_radius"]
            time.generalizedAlpha.spectralRadius = radius
            methods = exu.DynamicSolverType
            method = methods.TrapezoidalIndex2 if radius == 1 else methods.GeneralizedAlpha
            done = self.mbs.SolveDynamic(settings, solverType=method)
        if not done:
            raise RuntimeError("the solver gave up")
        parameter, moved = self.seen(places)
        return parameter, moved, self.seen(rates)[1]

    def frequencies(self, count):
        """The lowest, from Exudyn's mass and stiffness matrices, in which the supports are projected out."""
        self.mbs.Assemble()
        mass, stiffness, *_ = self.mbs.ComputeLinearizedSystem(quiet(), projectIntoConstraintNullspace=True)
        squares = scipy.linalg.eigh((stiffness + stiffness.T) / 2, mass, eigvals_only=True)
        squares[squares < np.finfo(float).eps * squares[-1]] = 0  # round-off of what nothing resists
        return list(np.sqrt(squares[:count]) / (2 * np.pi))


def quiet():
    """Settings that write nothing and ask Newton's method for what double precision gives."""
    settings = exu.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.solverInformationFileName = ""
    settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
    for solver in (settings.staticSolver, settings.timeIntegration):
        solver.verboseMode = 0
        solver.newton.residualMode = 1
        solver.newton.relativeTolerance, solver.newton.absoluteTolerance = 1e-9, 1e-10
        solver.newton.useModifiedNewton = False
    return settings


def field(element, length, points, order):
    """Weights, and a field derived `order` times by arc length, at Gauss points of an element with these coordinates."""
    places, weights = np.polynomial.legendre.leggauss(points)
    x, h = np.polynomial.Polynomial([0, 1]), length
    hermite = [1 - 3 * x**2 + 2 * x**3, h * x * (1 - x) ** 2, 3 * x**2 - 2 * x**3, h * x**2 * (x - 1)]
    rows = np.array([(f.deriv(order) if order else f)((places + 1) / 2) for f in hermite]).T / h**order
    return weights * length / 2, rows @ element.reshape(4, 2)


def energies(beam, gravity, place, change, rate):
    """Stretch, bend, kinetic energy and that of the weight, from the coordinates [node, coordinate]."""
    totals = np.zeros(4)
    stretch_points, bend_points = beam["gauss_points"]
    for k, length in enumerate(beam["lengths"]):
        q, u, v = (state[k : k + 2] for state in (place, change, rate))
        weights, slope = field(q, length, stretch_points, 1)
        totals[0] += beam["axial_stiffness"] / 2 * weights @ (np.hypot(*slope.T) - 1) ** 2
        weights, slope = field(q, length, bend_points, 1)
        _, second = field(q, length, bend_points, 2)
        cross = slope[:, 0] * second[:, 1] - slope[:, 1] * second[:, 0]
        totals[1] += beam["bending_stiffness"] / 2 * weights @ (cross / (slope**2).sum(axis=1)) ** 2
        weights, velocity = field(v, length, 4, 0)
        totals[2] += beam["mass_per_length"] / 2 * weights @ (velocity**2).sum(axis=1)
        weights, displacement = field(u, length, 4, 0)
        totals[3] -= beam["mass_per_length"] * weights @ (displacement @ gravity)
    return totals


def answer(text):
    """From the description as JSON to what Exudyn finds, as JSON."""
    given = json.loads(text)
    cables = Cables(given)
    found = {"parameter": [], "probes": [], "energy": [], "nodes": [], "frequencies": []}
    if "modal" in given["analysis"]:
        found["frequencies"] = cables.frequencies(given["analysis"]["modal"]["count"])
        return json.dumps(found, allow_nan=False)
    parameter, changes, rates = cables.solve()
    start = [np.array([[*place, *beam["tangent"]] for place in beam["nodes"]]) for beam in given["beams"]]
    states = [s + c for s, c in zip(start, changes)]
    for probe in given["probes"]:
        x, y = states[probe["beam"]][:, probe["node"], :2].T
        found["probes"].append({"name": probe["name"], "x": list(x), "y": list(y)})
    names = "stretch", "bend", "kinetic", "weight"
    for k in range(len(parameter)):
        parts = zip(given["beams"], states, changes, rates)
        total = sum(energies(beam, given["gravity"], q[k], c[k], v[k]) for beam, q, c, v in parts)
        found["energy"].append(dict(zip(names, total)))
    found["parameter"] = list(parameter)
    found["nodes"] = [state[-1].tolist() for state in states]
    return json.dumps(found, allow_nan=False)
