"""Scenes: what they take, what they refuse, and where they say it."""

from __future__ import annotations

import copy
import math
import pickle
from pathlib import Path
from typing import Any

import ancf
import numpy as np
import pytest
from conftest import arm


def test_a_table_a_text_and_a_file_are_the_same_scene(cantilever: ancf.Scene, tmp_path: Path) -> None:
    path = tmp_path / "arm.toml"
    path.write_text(cantilever.text)
    loaded, parsed = ancf.Scene.load(path), ancf.Scene.parse(cantilever.text)
    assert loaded == parsed == cantilever
    assert (loaded.name, parsed.name, cantilever.name) == (str(path), "<text>", "<scene>")
    assert loaded.analysis == "static" and loaded.beams == {"arm": 1.0}
    tips = [scene.run().probes["tip"] for scene in (loaded, parsed, cantilever)]
    assert tips[0].x[-1] == tips[1].x[-1] == tips[2].x[-1]


def test_values_are_read_and_set_by_their_paths(cantilever: ancf.Scene) -> None:
    assert cantilever["effect.moment.0.value"] == 3.0
    cantilever["effect.moment.0.value"] = "2 N m"
    assert cantilever["effect.moment.0.value"] == "2 N m"
    cantilever["beam.arm.end"] = np.array([2.0, 0.0])
    assert cantilever["beam.arm.end"] == [2.0, 0.0] and cantilever.beams == {"arm": 2.0}
    cantilever["beam.arm.basis.ancf.elements"] = np.int64(4)
    cantilever["support.0"] = {"beam": "arm", "at": "start", "fix": ["x", "y", "angle"], "move": {"x": 0.5}}
    assert cantilever["support.0.move.x"] == 0.5
    assert "beam.arm.strain" not in cantilever and "beam.arm" in cantilever
    # κ L = M L/EI = 4: the tip is where a circle of radius EI/M = 1/2 ends, behind the clamp that has moved.
    tip = cantilever.run().probes["tip"]
    assert tip.x[-1] == pytest.approx(0.5 + math.sin(4.0) / 2.0, abs=2e-2)
    assert tip.y[-1] == pytest.approx((1.0 - math.cos(4.0)) / 2.0, abs=2e-2)


def test_a_copy_goes_its_own_way(cantilever: ancf.Scene) -> None:
    for other in (cantilever.copy(), copy.copy(cantilever), copy.deepcopy(cantilever), pickle.loads(pickle.dumps(cantilever))):
        assert other == cantilever
        other["effect.moment.0.value"] = 1.0
        assert other != cantilever and cantilever["effect.moment.0.value"] == 3.0


def test_what_leaves_nothing_open_is_not_solved_to_be_chosen() -> None:
    """A force that is asked for tells of a run."""
    table, asked = arm(), []
    named = table["beam"]["arm"].pop("basis")

    def force(x: float, y: float, angle: float) -> tuple[float, float]:
        asked.append(x)
        return 0.0, 0.0

    for analysis, basis, is_solved in [({}, named, False), ({"accuracy": 1e-3}, named, False), ({"accuracy": 1e-3}, None, True)]:
        table["analysis"] = {"static": analysis}
        table["beam"]["arm"].update({} if basis is None else {"basis": basis})
        scene = ancf.Scene(table)
        scene.add_force("arm", "end", force)
        assert "basis" in scene.chosen().text
        assert bool(asked) == is_solved
        table["beam"]["arm"].pop("basis", None)


def test_a_value_that_is_refused_changes_nothing(cantilever: ancf.Scene) -> None:
    before = cantilever.text
    with pytest.raises(ancf.SceneError, match="dimension") as caught:
        cantilever["effect.moment.0.value"] = "3 m"
    assert (caught.value.file, caught.value.line, caught.value.column) == ("--set", 1, 23)
    with pytest.raises(ancf.SceneError):
        cantilever.update({"title": "fine", "beam.leg.end": [1, 0]})
    assert cantilever.text == before


def test_errors_name_file_line_and_column() -> None:
    with pytest.raises(ancf.SceneError, match=r"arm.toml:2:1: unknown key `radius`") as caught:
        ancf.Scene.parse("[beam.arm]\nradius = 3", "arm.toml")
    assert (caught.value.file, caught.value.line, caught.value.column) == ("arm.toml", 2, 1)
    assert isinstance(caught.value, ValueError)
    with pytest.raises(ancf.SceneError, match="cannot read the scene") as caught:
        ancf.Scene.load("/nowhere/arm.toml")
    assert caught.value.line is None


def test_a_table_with_a_fault_names_the_key() -> None:
    table = arm()
    table["beam"]["arm"]["stif"] = 3
    with pytest.raises(ancf.SceneError, match="unknown key `stif` in `beam.arm`"):
        ancf.Scene(table)


@pytest.mark.parametrize(
    ("table", "error", "message"),
    [
        (3, TypeError, "a table"),
        ({"title": None}, TypeError, "title: expected a number, text, a list or a table, found None"),
        ({"beam": {"a b": {"end": [0, float("nan")]}}}, ValueError, r"beam\.a b\.end\.1: expected a finite number, found nan"),
        ({"beam": {"a": {"end": np.array([0, np.inf])}}}, ValueError, r"beam\.a\.end\.1: expected a finite"),
        ({"beam": {3: {}}}, TypeError, "beam: the keys of a table are text, found 3"),
        ({"beam": {"a": {1, 2}}}, TypeError, "beam.a: expected .* found a value of type set"),
        ({"beam": {"a": 1j}}, TypeError, "found a value of type complex"),
    ],
)
def test_what_is_no_value_of_a_scene_is_refused_with_its_place(table: Any, error: type[Exception], message: str) -> None:
    with pytest.raises(error, match=message):
        ancf.Scene(table)


def test_unknown_paths_are_refused(cantilever: ancf.Scene) -> None:
    with pytest.raises(KeyError, match="has no `beam.arm.length`"):
        cantilever["beam.arm.length"]
    with pytest.raises(KeyError):
        cantilever["effect.moment.7.value"]
    with pytest.raises(ancf.SceneError, match="no entry `7`"):
        cantilever["effect.moment.7.value"] = 1
    with pytest.raises(ancf.SceneError, match="not a path"):
        cantilever["a..b"]
    with pytest.raises(TypeError, match="a path is text"):
        cantilever[0]  # type: ignore[index]


def test_texts_with_anything_in_them_arrive(cantilever: ancf.Scene) -> None:
    for title in ['say "hi" \\ there', "Prüfung 🙂", "line\nline", "tab\tbell\x07 del\x7f", "a=b#c"]:
        cantilever["title"] = title
        assert cantilever["title"] == title
        assert ancf.Scene(arm(title=title))["title"] == title


def test_what_would_be_built_is_told(cantilever: ancf.Scene) -> None:
    assert "bend" in cantilever.inspect()
    schema = ancf.schema()
    assert "beam" in schema["properties"]  # type: ignore[operator]
