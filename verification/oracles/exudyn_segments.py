"""Exudyn's finite segment method, finiteSegmentMethod, by Exudyn 1.13.6: rigid bars and springs.

A beam of L = 2 m, EI = 1 N m^2, 1 kg/m, hinged at the origin, falls from the horizontal. It is cut
into n bars of equal length without moment of inertia, with a torsion spring EI/h at every hinge
between two of them, and moved by generalised-alpha. Such a chain keeps its length, and comes closer
to the beam with the square of h; rows with 0 segments are (4 (2 n) - n)/3 of the two finest.

    python3 exudyn_segments.py
"""

import numpy as np
from exudyn_mechanisms import Mechanism, exu, item

LENGTH, BENDING, MASS, GRAVITY = 2.0, 1.0, 1.0, 9.81
SEGMENTS = (32, 64, 128)
STEP, EVERY, DURATION = 2.5e-4, 0.02, 0.6


def fall(segments):
    """Times, and places of the tip."""
    m = Mechanism()
    mbs, h = m.mbs, LENGTH / segments
    body = mbs.AddObject(item.ObjectGround())

    def marker(body, x):
        return mbs.AddMarker(item.MarkerBodyPosition(bodyNumber=body, localPosition=[x, 0, 0]))

    before, turned = marker(body, 0), None
    for k in range(segments):
        node = mbs.AddNode(item.NodeRigidBody2D(referenceCoordinates=[(k + 0.5) * h, 0, 0]))
        bar = mbs.AddObject(
            item.ObjectRigidBody2D(physicsMass=MASS * h, physicsInertia=0, nodeNumber=node)
        )
        weight = mbs.AddMarker(item.MarkerBodyMass(bodyNumber=bar))
        mbs.AddLoad(item.LoadMassProportional(markerNumber=weight, loadVector=[0, -GRAVITY, 0]))
        ends = [marker(bar, -h / 2), marker(bar, h / 2)]
        mbs.AddObject(item.ObjectJointRevolute2D(markerNumbers=[before, ends[0]]))
        turn = mbs.AddMarker(item.MarkerNodeCoordinate(nodeNumber=node, coordinate=2))
        if turned is not None:
            mbs.AddObject(
                item.ObjectConnectorCoordinateSpringDamper(
                    markerNumbers=[turned, turn], stiffness=BENDING / h
                )
            )
        before, turned = ends[1], turn
    m.sensors.append(
        mbs.AddSensor(
            item.SensorMarker(
                markerNumber=before,
                outputVariableType=exu.OutputVariableType.Position,
                storeInternal=True,
                writeToFile=False,
            )
        )
    )
    times, places = m.move(DURATION, STEP, EVERY, "GeneralizedAlpha", (1e-8, 1e-9))
    return times, places[:, 0]


if __name__ == "__main__":
    found = {n: fall(n) for n in SEGMENTS}
    times = found[SEGMENTS[0]][0]
    rows = {n: places for n, (_, places) in found.items()}
    rows[0] = (4 * rows[SEGMENTS[-1]] - rows[SEGMENTS[-2]]) / 3
    print("segments,t,x,y")
    for segments, places in rows.items():
        for t, (x, y) in zip(times, places):
            print(f"{segments},{t:.10g},{x:.12g},{y:.12g}")
