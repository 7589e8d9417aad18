"""Planar flexible beams by the absolute nodal coordinate formulation.

>>> import ancf
>>> scene = ancf.Scene({
...     "beam": {"arm": {"start": [0, 0], "end": [1, 0], "axial_stiffness": 1e4, "bending_stiffness": 2.0}},
...     "support": [{"beam": "arm", "at": "start", "fix": ["x", "y", "angle"]}],
...     "effect": {"moment": [{"beam": "arm", "at": "end", "value": "12.566 N m"}]},
...     "probe": [{"name": "tip", "beam": "arm", "at": "end"}],
...     "analysis": {"static": {"accuracy": 1e-4}},
... })
>>> tip = scene.run().probes["tip"]
>>> bool(abs(tip.x[-1]) < 1e-3 and abs(tip.y[-1]) < 1e-3)
True

A scene is what a scene file says, and every key, unit and message is that of the command line.
"""

from ._ancf import ComputationError, SceneError, State, SweepError, __version__, schema as _schema
from .result import Columns, Error, Mode, Probe, Probes, Result, Shape
from .scene import Progress, Scene, Step
from .sweeping import SweepTable, sweep

__all__ = [
    "Columns",
    "ComputationError",
    "Error",
    "Mode",
    "Probe",
    "Probes",
    "Progress",
    "Result",
    "Scene",
    "SceneError",
    "Shape",
    "State",
    "Step",
    "SweepError",
    "SweepTable",
    "__version__",
    "schema",
    "sweep",
]


def schema() -> dict[str, object]:
    """The JSON schema of scenes."""
    import json

    read: dict[str, object] = json.loads(_schema())
    return read
