"""Scenes that the tests share."""

from __future__ import annotations

from typing import Any

import ancf
import pytest


def arm(**changes: Any) -> dict[str, Any]:
    """A cantilever of unit length and stiffness, with a moment of half a turn at its tip."""
    table: dict[str, Any] = {
        "beam": {
            "arm": {
                "start": [0, 0],
                "end": [1, 0],
                "axial_stiffness": 1e4,
                "bending_stiffness": 1.0,
                "mass_per_length": 1.0,
                "basis": {"ancf": {"elements": 8}},
            }
        },
        "support": [{"beam": "arm", "at": "start", "fix": ["x", "y", "angle"]}],
        "effect": {"moment": [{"beam": "arm", "at": "end", "value": 3.0}]},
        "probe": [{"name": "tip", "beam": "arm", "at": "end"}],
        "analysis": {"static": {}},
    }
    table.update(changes)
    return table


def falling(**changes: Any) -> dict[str, Any]:
    """A pendulum that falls for half a second."""
    table = arm(
        support=[{"beam": "arm", "at": "start", "fix": ["x", "y"]}],
        effect={"gravity": {"acceleration": [0, -9.81]}},
        analysis={"dynamic": {"duration": "0.5 s", "output_every": 0.05, "radau": {"stages": 3, "tolerance": 1e-5}}},
    )
    table.update(changes)
    return table


@pytest.fixture
def cantilever() -> ancf.Scene:
    return ancf.Scene(arm())


@pytest.fixture
def pendulum() -> ancf.Scene:
    return ancf.Scene(falling())
