"""Mechanisms of planar cables by Exudyn 1.13.6: hubs that turn by a law, hinges, sliders.

Every subcommand builds its mechanism from ANCFCable2D elements, whose strain and Gauss points are those of our ANCF with engineering
strain (5 points for stretching, 3 for bending), and moves it by the trapezoidal rule, which in a form of index 2 is our generalised-alpha
method with spectral radius 1. It prints places of points against time.

    python3 exudyn_mechanisms.py spin-up | double-pendulum | slider-crank
"""

import contextlib
import functools
import io
import math
import sys
import warnings

import numpy as np

warnings.simplefilter("ignore", DeprecationWarning)
with contextlib.redirect_stdout(io.StringIO()):
    import exudyn as exu
    import exudyn.itemInterface as item

exu.config.printToConsole = False


class Mechanism:
    """Cables, joints and loads in one system."""

    def __init__(self):
        self.container = exu.SystemContainer()  # kept, for the system lives in it
        self.mbs = self.container.AddSystem()
        self.ground = self.mbs.AddNode(item.NodePointGround())
        self.sensors = []

    def cable(self, start, end, elements, axial, bending, mass, gravity=(0, 0)):
        """Nodes of a straight beam of even elements, and its elements."""
        mbs = self.mbs
        start, end = np.array(start, float), np.array(end, float)
        length = np.linalg.norm(end - start)
        tangent = (end - start) / length
        places = [start + (end - start) * k / elements for k in range(elements + 1)]
        nodes = [mbs.AddNode(item.NodePoint2DSlope1(referenceCoordinates=[*p, *tangent])) for p in places]
        cables = [
            mbs.AddObject(
                item.ObjectANCFCable2D(
                    length=length / elements,
                    massPerLength=mass,
                    axialStiffness=axial,
                    bendingStiffness=bending,
                    nodeNumbers=[a, b],
                    useReducedOrderIntegration=0,
                )
            )
            for a, b in zip(nodes, nodes[1:])
        ]
        for cable in cables:
            if any(gravity):
                marker = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=cable))
                mbs.AddLoad(item.LoadMassProportional(markerNumber=marker, loadVector=[*gravity, 0]))
        return nodes, cables

    def hold(self, node, rows, offset):
        """Rows times the coordinates [x, y, x', y'] of a node, with their reference, are an offset."""
        rows = np.array(rows, float)
        markers = [
            self.mbs.AddMarker(item.MarkerNodeCoordinates(nodeNumber=self.ground)),
            self.mbs.AddMarker(item.MarkerNodeCoordinates(nodeNumber=node)),
        ]
        self.mbs.AddObject(
            item.ObjectConnectorCoordinateVector(
                markerNumbers=markers,
                scalingMarker0=np.zeros((len(rows), 0)),
                scalingMarker1=rows,
                offset=np.array(offset, float),
            )
        )

    def hub(self, node, speed, duration):
        """A node stays at the origin, and its gradient is a unit vector that turns by the law `spun_up`, from the x axis."""
        self.hold(node, np.eye(4)[:2], [0, 0])
        ground = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=self.ground, coordinate=0))
        # These constraints are on changes from the reference, (1, 0).
        law = functools.partial(spun_up, speed, duration)
        for k in range(2):
            marker = self.mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=2 + k))
            self.mbs.AddObject(
                item.ObjectConnectorCoordinate(
                    markerNumbers=[ground, marker],
                    offsetUserFunction=lambda mbs, t, i, offset, k=k: direction(*law(t))[k][0],
                    offsetUserFunction_t=lambda mbs, t, i, offset, k=k: direction(*law(t))[k][1],
                )
            )

    def hinge(self, first, second):
        """Two nodes are at one place."""
        markers = [self.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=n)) for n in (first, second)]
        self.mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=markers))

    def watch(self, *nodes):
        for node in nodes:
            self.sensors.append(
                self.mbs.AddSensor(
                    item.SensorNode(
                        nodeNumber=node,
                        outputVariableType=exu.OutputVariableType.Position,
                        storeInternal=True,
                        writeToFile=False,
                    )
                )
            )

    def settings(self):
        settings = exu.SimulationSettings()
        settings.solution.file.write = False
        settings.solution.solverInformationFileName = ""
        settings.linearSolver.solverType = exu.LinearSolverType.EigenSparse
        for solver in (settings.staticSolver, settings.timeIntegration):
            solver.verboseMode = 0
            solver.newton.residualMode = 1
            solver.newton.useModifiedNewton = False
        return settings

    def move(self, duration, step, every, method="TrapezoidalIndex2", tolerance=(1e-9, 1e-10)):
        """Times, and the places of what is watched [record, point, component]."""
        self.mbs.Assemble()
        settings = self.settings()
        time = settings.timeIntegration
        time.newton.relativeTolerance, time.newton.absoluteTolerance = tolerance
        time.numberOfSteps, time.endTime = round(duration / step), duration
        time.adaptiveStep = False
        settings.solution.sensors.writePeriod = every
        if not self.mbs.SolveDynamic(settings, solverType=getattr(exu.DynamicSolverType, method)):
            raise RuntimeError("the solver gave up")
        data = [self.mbs.GetSensorStoredData(s) for s in self.sensors]
        return data[0][:, 0], np.stack([d[:, 1:3] for d in data], axis=1)


def spun_up(speed, duration, t):
    """Angle and angular velocity of a hub that is brought to speed."""
    if t > duration:
        return speed * (t - duration / 2), speed
    turn = 2 * math.pi / duration
    angle = speed / duration * (t * t / 2 + (math.cos(turn * t) - 1) / turn**2)
    return angle, speed / duration * (t - math.sin(turn * t) / turn)


def direction(angle, rate):
    """Changes of a unit vector from the x axis, and their rates."""
    c, s = math.cos(angle), math.sin(angle)
    return [(c - 1, -s * rate), (s, c * rate)]


def table(names, times, places):
    columns = [f"{name}_{axis}" for name in names for axis in "xy"]
    print(",".join(["t", *columns]))
    for t, row in zip(times, places.reshape(len(times), -1)):
        print(",".join([f"{t:.10g}", *(f"{v:.12g}" for v in row)]))


def spin_up():
    """Simo & Vu-Quoc's beam of 10 m, whose gradient is held at the hub.

    By generalised-alpha with small steps: its waves along the axis are too fast for the trapezoidal rule.
    """
    m = Mechanism()
    nodes, _ = m.cable((0, 0), (10, 0), 10, 2.8e7, 1.4e4, 1.2)
    m.hub(nodes[0], 6, 15)
    m.watch(nodes[-1])
    times, places = m.move(20, 5e-4, 0.25, "GeneralizedAlpha", (1e-7, 1e-7))
    table(["tip"], times, places)


def double_pendulum():
    m = Mechanism()
    first, _ = m.cable((0, 0), (1, 0), 4, 1e4, 2, 1, (0, -9.81))
    second, _ = m.cable((1, 0), (1.8, 0), 4, 1e4, 1, 0.8, (0, -9.81))
    m.hold(first[0], np.eye(4)[:2], [0, 0])
    m.hinge(first[-1], second[0])
    m.watch(first[-1], second[-1])
    times, places = m.move(1.0, 1e-3, 0.02)
    table(["elbow", "tip"], times, places)


def slider_crank():
    """A stiff crank turned by a hub, a soft rod, and a slider on the x axis; no weight."""
    m = Mechanism()
    crank, _ = m.cable((0, 0), (0.2, 0), 2, 2e5, 400, 1)
    rod, _ = m.cable((0.2, 0), (0.8, 0), 6, 1e5, 4, 1)
    m.hub(crank[0], 20, 0.5)
    m.hinge(crank[-1], rod[0])
    m.hold(rod[-1], [[0, 1, 0, 0]], [0])
    m.watch(rod[3], rod[-1])
    times, places = m.move(1.0, 5e-4, 0.02)
    table(["middle", "slider"], times, places)


if __name__ == "__main__":
    {"spin-up": spin_up, "double-pendulum": double_pendulum, "slider-crank": slider_crank}[sys.argv[1]]()
