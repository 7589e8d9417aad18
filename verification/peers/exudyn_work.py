"""How long Exudyn takes to solve a plain description of planar cables, under settings that are chosen.

The model is the one of `exudyn_scene.py`; what is set here beyond it is how Exudyn integrates over its elements, how Newton's
method iterates and when it is content, and which linear solver is used.

- Timed is the call into the compiled solver alone: no model is built in it, and nothing is written or drawn.
- In dynamics the nodes of probes are watched at the records; in statics nothing is, as the last state is asked for afterwards.
- Every repetition solves a model built anew, so that none starts from another's solution.
"""

import json
import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read once, while NumPy is imported

import numpy as np  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))
import exudyn_scene as scene  # noqa: E402

exu, item = scene.exu, scene.item

# Points for stretching / bending -> Exudyn's number for them
QUADRATURE = {"5/3": 0, "4/2": 1, "Lobatto": 2}


def settings_of(given, chosen):
    """Exudyn's settings for an analysis; what is not chosen is as in the comparison of numbers."""
    settings = scene.quiet()
    settings.solution.sensors.active = "dynamic" in given["analysis"]
    ((kind, question),) = given["analysis"].items()
    solver = settings.staticSolver if kind == "static" else settings.timeIntegration
    solver.adaptiveStep = False
    if kind == "static":
        solver.numberOfLoadSteps = question["steps"]
    else:
        solver.numberOfSteps, solver.endTime = question["steps"], question["steps"] * question["step"]
        settings.solution.sensors.writePeriod = question["every"] * question["step"]
        solver.generalizedAlpha.spectralRadius = question["spectral_radius"]
    for name, value in chosen.items():
        if name == "newton":
            solver.newton.useModifiedNewton = {"full": False, "modified": True}[value]
        elif name == "residual_mode":
            solver.newton.residualMode = int(value)
        elif name == "relative":
            solver.newton.relativeTolerance = float(value)
        elif name == "absolute":
            solver.newton.absoluteTolerance = float(value)
        elif name == "linear_solver":
            settings.linearSolver.solverType = getattr(exu.LinearSolverType, value)
        elif name == "reuse_pattern":
            settings.linearSolver.reuseAnalyzedPattern = bool(value)
        elif name == "adaptive":
            solver.adaptiveStep = bool(value)
        elif name != "quadrature":
            raise ValueError(f"no setting of Exudyn is called `{name}` here")
    return settings


def solve(given, chosen):
    """Seconds, counts, times of the records, places of the probes there, and the last coordinates of all nodes."""
    cables = scene.Cables(given)
    mbs = cables.mbs
    if "quadrature" in chosen:
        for number in range(mbs.systemData.NumberOfObjects()):
            if mbs.GetObject(number)["objectType"] == "ANCFCable2D":
                mbs.SetObjectParameter(number, "useReducedOrderIntegration", QUADRATURE[chosen["quadrature"]])
    dynamic = "dynamic" in given["analysis"]
    coordinates = exu.OutputVariableType.Coordinates
    watched = [cables.nodes[probe["beam"]][probe["node"]] for probe in given["probes"]]
    sensors = [
        mbs.AddSensor(
            item.SensorNode(nodeNumber=node, outputVariableType=coordinates, storeInternal=True, writeToFile=False)
        )
        for node in watched
        if dynamic
    ]
    mbs.Assemble()
    settings = settings_of(given, chosen)
    if not dynamic:
        solver = exu.MainSolverStatic()
    elif given["analysis"]["dynamic"]["spectral_radius"] == 1:
        solver = exu.MainSolverImplicitSecondOrder()
        exu_type = exu.DynamicSolverType.TrapezoidalIndex2
    else:
        solver = exu.MainSolverImplicitSecondOrder()
        exu_type = exu.DynamicSolverType.GeneralizedAlpha
    if dynamic:
        settings.timeIntegration.solverType = exu_type
        alpha = settings.timeIntegration.generalizedAlpha
        trapezoidal = exu_type == exu.DynamicSolverType.TrapezoidalIndex2
        alpha.useIndex2Constraints = alpha.useNewmark = trapezoidal
    start = time.perf_counter()
    done = solver.SolveSystem(mbs, settings)
    seconds = time.perf_counter() - start
    if not done:
        raise RuntimeError("the solver gave up")
    counts = {
        "steps": solver.it.currentStepIndex,
        "newton_iterations": solver.it.newtonStepsCount,
        "jacobians": solver.it.newtonJacobiCount,
        "rejected_steps": solver.it.rejectedModifiedNewtonSteps,
    }
    beams = [np.array([mbs.GetNodeOutput(node, coordinates) for node in nodes]) for nodes in cables.nodes]
    starts = [np.array([[*place, *beam["tangent"]] for place in beam["nodes"]]) for beam in given["beams"]]
    last = [start + change for start, change in zip(starts, beams)]
    parameter, tracks = [1.0], [[last[probe["beam"]][probe["node"]][:2]] for probe in given["probes"]]
    if dynamic:
        stored = [mbs.GetSensorStoredData(sensor) for sensor in sensors]
        parameter = list(stored[0][:, 0]) if stored else []
        tracks = [
            starts[probe["beam"]][probe["node"]][:2] + rows[:, 1:3] for probe, rows in zip(given["probes"], stored)
        ]
    return seconds, counts, parameter, tracks, [beam.tolist() for beam in last]


def answer(text):
    """From {description, settings, repeat} as JSON to what Exudyn finds and how long each repetition took, as JSON."""
    question = json.loads(text)
    given = question["description"]
    runs = [solve(given, question["settings"]) for _ in range(question["repeat"])]
    _, counts, parameter, tracks, nodes = runs[-1]
    probes = [
        {"name": probe["name"], "x": [float(p[0]) for p in track], "y": [float(p[1]) for p in track]}
        for probe, track in zip(given["probes"], tracks)
    ]
    found = {"seconds": [run[0] for run in runs], **counts, "parameter": [float(t) for t in parameter]}
    return json.dumps({**found, "probes": probes, "nodes": nodes}, allow_nan=False)
