"""Cables on a disc by Exudyn 1.13.6: ObjectContactCircleCable2D, whose penalty is a stiffness per straight segment.

Exudyn cuts an element into n chords of equal reference length h, and pushes each at its point nearest to the disc's centre with the force
c <R - distance>. With c = k h this is a rule for the integral of the pressure k <R - |r - c|> over the reference length, which our beam has. Of the
chords to one side of the deepest point it takes their ends towards that point; the sum is therefore the trapezoidal rule's and h times
the largest pressure: an error of first order, of which two numbers of segments leave the second. Twelve is the largest number that an element may have.

Rows with a number of segments are what Exudyn finds; those with 0 segments are 2 (twelve) - (six).

    python3 exudyn_contact.py press | swing
"""

import sys

import numpy as np
from exudyn_mechanisms import Mechanism, exu, item

SEGMENTS = (3, 6, 12)


class Disc:
    """A round obstacle of the ground with a pressure per length and penetration."""

    def __init__(self, mechanism, centre, radius, stiffness, segments):
        self.mbs, self.radius, self.stiffness, self.segments = mechanism.mbs, radius, stiffness, segments
        ground = self.mbs.AddObject(item.ObjectGround(referencePosition=[*centre, 0]))
        self.marker = self.mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=ground, localPosition=[0, 0, 0]))

    def stops(self, cable, length):
        """An element of this reference length cannot pass."""
        mbs, n = self.mbs, self.segments
        shape = mbs.AddMarker(item.MarkerBodyCable2DShape(bodyNumber=cable, numberOfSegments=n))
        # Each segment remembers its gap, without contact at first.
        gaps = mbs.AddNode(item.NodeGenericData(initialCoordinates=[1.0] * n, numberOfDataCoordinates=n))
        mbs.AddObject(
            item.ObjectContactCircleCable2D(
                markerNumbers=[self.marker, shape],
                nodeNumber=gaps,
                numberOfContactSegments=n,
                contactStiffness=self.stiffness * length / n,
                circleRadius=self.radius,
            )
        )


class Settled(Mechanism):
    """A mechanism whose contacts open and close within a step until none contradicts its gap."""

    def settings(self):
        settings = super().settings()
        for solver in (settings.staticSolver, settings.timeIntegration):
            solver.newton.relativeTolerance, solver.newton.absoluteTolerance = 1e-9, 1e-10
            solver.discontinuous.iterationTolerance = 1e-9
            solver.discontinuous.maxIterations = 50
            solver.discontinuous.ignoreMaxIterations = False
            solver.adaptiveStep = False
        return settings


def press(segments):
    """Places of the nodes of a cantilever of 64 elements that a dead force of 8 at its tip, in 32 steps, bends around a disc."""
    m = Settled()
    nodes, cables = m.cable((0, 0), (1, 0), 64, 1e4, 1, 1)
    m.hold(nodes[0], np.eye(4)[[0, 1, 3]], [0, 0, 0])
    disc = Disc(m, (0.4, -0.25), 0.2, 1e4, segments)
    for cable in cables:
        disc.stops(cable, 1 / len(cables))
    tip = m.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=nodes[-1]))
    m.mbs.AddLoad(item.Force(markerNumber=tip, loadVector=[0, -8, 0]))
    m.mbs.Assemble()
    settings = m.settings()
    settings.staticSolver.numberOfLoadSteps = 32
    if not m.mbs.SolveStatic(settings):
        raise RuntimeError("the solver gave up")
    places = [m.mbs.GetNodeOutput(node, exu.OutputVariableType.Position)[:2] for node in nodes]
    return np.linspace(0, 1, len(nodes)), np.array(places)


def swing(segments):
    """Middle and tip of a beam of 32 elements that swings from the horizontal about a hinge and strikes a peg."""
    m = Settled()
    nodes, cables = m.cable((0, 0), (1, 0), 32, 1e4, 0.5, 1, (0, -9.81))
    m.hold(nodes[0], np.eye(4)[:2], [0, 0])
    peg = Disc(m, (0.3, -0.5), 0.1, 1e4, segments)
    for cable in cables:
        peg.stops(cable, 1 / len(cables))
    m.watch(nodes[16], nodes[-1])
    times, places = m.move(0.45, 5e-4, 0.01, tolerance=(1e-9, 1e-10))
    return times, places.reshape(len(times), -1)


def table(names, of):
    print(",".join(["segments", *names]))
    found = {n: of(n) for n in SEGMENTS}
    abscissa = found[12][0]
    rows = {n: values for n, (_, values) in found.items()} | {0: 2 * found[12][1] - found[6][1]}
    for segments, values in rows.items():
        for at, row in zip(abscissa, values):
            print(",".join([f"{segments}", f"{at:.10g}", *(f"{v:.12g}" for v in row)]))


if __name__ == "__main__":
    if sys.argv[1] == "press":
        table(["s", "x", "y"], press)
    else:
        table(["t", "middle_x", "middle_y", "tip_x", "tip_y"], swing)
