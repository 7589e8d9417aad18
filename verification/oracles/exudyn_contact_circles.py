"""Exudyn's cable on two circles, ANCFcontactCircleTest, by Exudyn 1.13.6, and with finer segments.

A cantilever of 2 m, 1 mm square, E = 207 GPa, is pressed upon two discs by its weight in a field of
80 m/s^2: in the test by dead forces at its nodes, half of them at the ends, with the finer elements
as the weight itself. Exudyn's contact is a stiffness c per straight segment of an element. Here
c = k h with the segment's length h and the k of the test's own 8 elements of 4 segments with
c = 1 kN/m, 16 kN/m^2, so that finer segments tend to a pressure per length.

    python3 exudyn_contact_circles.py
"""

import numpy as np

from exudyn_contact import Disc, Settled, exu, item

LENGTH, AXIAL, BENDING, MASS, FIELD = 2.0, 2.07e5, 2.07e11 * 1e-12 / 12, 7.8e-3, 80
DISCS = (((0.5, -0.15), 0.1), ((1.5, -0.5), 0.2))
PRESSURE = 16e3
LOAD_STEPS = 200


def pressed(elements, segments, at_nodes=False):
    """Arc lengths and places of the nodes."""
    m = Settled()
    field = (0, 0 if at_nodes else -FIELD)
    nodes, cables = m.cable((0, 0), (LENGTH, 0), elements, AXIAL, BENDING, MASS, field)
    m.hold(nodes[0], np.eye(4)[[0, 1, 3]], [0, 0, 0])
    for centre, radius in DISCS:
        disc = Disc(m, centre, radius, PRESSURE, segments)
        for cable in cables:
            disc.stops(cable, LENGTH / elements)
    for k, node in enumerate(nodes if at_nodes else []):
        weight = FIELD * MASS * LENGTH / elements * (0.5 if k in (0, elements) else 1.0)
        marker = m.mbs.AddMarker(item.MarkerNodePosition(nodeNumber=node))
        m.mbs.AddLoad(item.Force(markerNumber=marker, loadVector=[0, -weight, 0]))
    m.mbs.Assemble()
    settings = m.settings()
    static = settings.staticSolver
    static.numberOfLoadSteps = LOAD_STEPS
    static.loadStepGeometric, static.loadStepGeometricRange = True, 1e4
    static.newton.maxIterations = 30
    static.stabilizerODE2term = 2
    if not m.mbs.SolveStatic(settings):
        raise RuntimeError(f"{elements} elements of {segments} segments: the solver gave up")
    places = [m.mbs.GetNodeOutput(node, exu.OutputVariableType.Position)[:2] for node in nodes]
    return np.linspace(0, LENGTH, elements + 1), np.array(places)


def show(elements, segments, arc, places):
    for s, (x, y) in zip(arc, places):
        print(f"{elements},{segments},{s:.10g},{x:.12g},{y:.12g}")


if __name__ == "__main__":
    print("elements,segments,s,x,y")
    show(8, 4, *pressed(8, 4, at_nodes=True))
    for elements, segments in ((32, 3), (32, 6), (32, 12), (64, 12)):
        show(elements, segments, *pressed(elements, segments))
