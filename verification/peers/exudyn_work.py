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


# Name of a setting -> where it goes in Exudyn's settings of the solver, and what its text means
NEWTON = {
    "newton": ("useModifiedNewton", lambda text: {"full": False, "modified": True}[text]),
    "residual_mode": ("residualMode", int),
    "relative": ("relativeTolerance", float),
    "absolute": ("absoluteTolerance", float),
}
LINEAR = {
    "linear_solver": ("solverType", lambda text: getattr(exu.LinearSolverType, text)),
    "reuse_pattern": ("reuseAnalyzedPattern", lambda text: bool(int(text))),
}


def solver_for(analysis, chosen):
    """Exudyn's solver and its settings for an analysis; what is not chosen is as in the comparison of numbers."""
    settings = scene.quiet()
    ((kind, question),) = analysis.items()
    if kind == "static":
        solver, own = exu.MainSolverStatic(), settings.staticSolver
        own.numberOfLoadSteps = question["steps"]
        settings.solution.sensors.active = False
    else:
        solver, own = exu.MainSolverImplicitSecondOrder(), settings.timeIntegration
        own.numberOfSteps, own.endTime = question["steps"], question["steps"] * question["step"]
        settings.solution.sensors.writePeriod = question["every"] * question["step"]
        own.generalizedAlpha.spectralRadius = question["spectral_radius"]
        # what exu.SolveDynamic does for TrapezoidalIndex2
        trapezoidal = question["spectral_radius"] == 1
        own.generalizedAlpha.useIndex2Constraints = own.generalizedAlpha.useNewmark = trapezoidal
    own.adaptiveStep = False
    for name, text in chosen.items():
        for known, place in ((NEWTON, own.newton), (LINEAR, settings.linearSolver)):
            if name in known:
                attribute, meaning = known[name]
                setattr(place, attribute, meaning(text))
        if name not in {*NEWTON, *LINEAR, "quadrature"}:
            raise ValueError(f"no setting of Exudyn is called `{name}` here")
    return solver, settings


def solve(given, chosen):
    """Seconds, counts, times of the records, places of the probes there, and the last coordinates of all nodes."""
    cables = scene.Cables(given)
    mbs = cables.mbs
    if "quadrature" in chosen:
        for number in range(mbs.systemData.NumberOfObjects()):
            if mbs.GetObject(number)["objectType"] == "ANCFCable2D":
                mbs.SetObjectParameter(number, "useReducedOrderIntegration", QUADRATURE[chosen["quadrature"]])
    dynamic = "dynamic" in given["analysis"]
    kind = exu.OutputVariableType.Coordinates
    options = {"outputVariableType": kind, "storeInternal": True, "writeToFile": False}
    places = [(probe["beam"], probe["node"]) for probe in given["probes"]]
    watched = [cables.nodes[beam][node] for beam, node in places if dynamic]
    sensors = [mbs.AddSensor(item.SensorNode(nodeNumber=node, **options)) for node in watched]
    mbs.Assemble()
    solver, settings = solver_for(given["analysis"], chosen)

    start = time.perf_counter()
    done = solver.SolveSystem(mbs, settings)
    seconds = time.perf_counter() - start
    if not done:
        raise RuntimeError("the solver gave up")

    counts = {
        "steps": solver.it.currentStepIndex - 1,
        "newton_iterations": solver.it.newtonStepsCount,
        "jacobians": solver.it.newtonJacobiCount,
        "rejected_steps": solver.it.rejectedModifiedNewtonSteps,
    }
    starts = [np.array([[*place, *beam["tangent"]] for place in beam["nodes"]]) for beam in given["beams"]]
    changes = [np.array([mbs.GetNodeOutput(node, kind) for node in nodes]) for nodes in cables.nodes]
    last = [start + change for start, change in zip(starts, changes)]
    if not dynamic:
        return seconds, counts, [1.0], [[last[beam][node]] for beam, node in places], last
    stored = [mbs.GetSensorStoredData(sensor) for sensor in sensors]
    times = list(stored[0][:, 0]) if stored else []
    return seconds, counts, times, [starts[b][n] + rows[:, 1:] for (b, n), rows in zip(places, stored)], last


def answer(text):
    """From {description, settings, repeat} as JSON to what Exudyn finds and how long each repetition took, as JSON."""
    question = json.loads(text)
    given = question["description"]
    runs = [solve(given, question["settings"]) for _ in range(question["repeat"])]
    _, counts, times, tracks, nodes = runs[-1]
    found = {
        "seconds": [run[0] for run in runs],
        **counts,
        "parameter": [float(t) for t in times],
        "probes": [
            {"name": probe["name"], "x": [float(p[0]) for p in track], "y": [float(p[1]) for p in track]}
            for probe, track in zip(given["probes"], tracks)
        ],
        "nodes": [beam.tolist() for beam in nodes],
    }
    return json.dumps(found, allow_nan=False)
