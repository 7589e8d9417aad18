"""Forces by functions, beside the same ones by the scene's own words."""

from __future__ import annotations

import math
import pickle
from typing import Any

import ancf
import numpy as np
import pytest
from conftest import arm, falling

PULL = {"force": [{"beam": "arm", "at": "end", "value": [0.0, 2.0]}]}


def tip(scene: ancf.Scene) -> list[float]:
    probe = scene.run().probes["tip"]
    return [probe.x[-1], probe.y[-1], probe.angle[-1]]


def test_a_dead_force() -> None:
    own = ancf.Scene(arm(effect={}))
    own.add_force("arm", "end", lambda x, y, angle: (0.0, 2.0))
    assert tip(own) == pytest.approx(tip(ancf.Scene(arm(effect=PULL))), abs=1e-10)


@pytest.mark.parametrize("differentiated", [False, True])
def test_a_spring(differentiated: bool) -> None:
    spring = {"spring": [{"beam": "arm", "at": "end", "stiffness": 5.0, "anchor": [1.0, 1.0], "length": 1.0}]}
    named = ancf.Scene(arm(effect={**PULL, **spring}))
    own = ancf.Scene(arm(effect=PULL))

    def force(x: float, y: float, angle: float) -> np.ndarray:
        along = np.array([1.0 - x, 1.0 - y])
        pull: np.ndarray = 5.0 * (1.0 - 1.0 / np.hypot(*along)) * along
        return pull

    def derivative(x: float, y: float, angle: float) -> np.ndarray:
        along = np.array([1.0 - x, 1.0 - y])
        length = np.hypot(*along)
        by_place = -5.0 * ((1.0 - 1.0 / length) * np.eye(2) + np.outer(along, along) / length**3)
        return np.column_stack((by_place, np.zeros(2)))

    # A function's force grows with the load factor, and a spring's does not; at its end both are whole.
    own.add_force("arm", 1.0, force, derivative=derivative if differentiated else None)
    assert tip(own) == pytest.approx(tip(named), abs=1e-9)


def test_a_couple_and_a_follower_force() -> None:
    own = ancf.Scene(arm(effect={}))
    own.add_force("arm", "end", lambda x, y, angle: (0.0, 0.0, 3.0))
    assert tip(own) == pytest.approx(tip(ancf.Scene(arm())), abs=1e-9)
    follower = {"force": [{"beam": "arm", "at": "end", "value": [0.0, 4.0], "follower": True}]}
    own = ancf.Scene(arm(effect={}))
    own.add_force("arm", "end", lambda x, y, angle: (-4.0 * math.sin(angle), 4.0 * math.cos(angle)))
    assert tip(own) == pytest.approx(tip(ancf.Scene(arm(effect=follower))), abs=1e-8)


def test_a_dashpot_resists_in_motions_alone() -> None:
    def scene(**effect: Any) -> ancf.Scene:
        return ancf.Scene(falling(effect={"gravity": {"acceleration": [0, -9.81]}, **effect}))

    own, without = scene(), scene()
    own.add_force("arm", "end", lambda x, y, angle, vx, vy, rate: (-3.0 * vx, -3.0 * vy), rates=True)
    result = own.run()
    # What the dashpot takes, ∫ 3 v² dt by the trapezoidal rule over fine records, is what the balance of energy lacks.
    fine = scene()
    fine["analysis.dynamic.output_every"] = 1e-3
    fine.add_force("arm", "end", lambda x, y, angle, vx, vy, rate: (-3.0 * vx, -3.0 * vy), rates=True)
    fine_result = fine.run()
    probe = fine_result.probes["tip"]
    power = 3.0 * (probe.vx**2 + probe.vy**2)
    lost = float(((power[1:] + power[:-1]) / 2.0).sum() * 1e-3)
    assert fine_result.energy.lost[-1] == pytest.approx(lost, rel=1e-4)
    assert result.energy.lost[-1] == pytest.approx(lost, rel=1e-4)
    assert without.run().energy.lost[-1] == 0.0


def test_a_change_of_the_scene_keeps_its_functions(cantilever: ancf.Scene) -> None:
    cantilever.add_force("arm", "end", lambda x, y, angle: (0.0, 1.0))
    with_both = tip(cantilever)
    cantilever["effect.moment.0.value"] = 0.0
    assert tip(cantilever) != with_both and tip(cantilever)[1] > 0.1


@pytest.mark.parametrize(
    ("force", "error", "message"),
    [
        (lambda x, y, angle: 1 / 0, ZeroDivisionError, "division"),
        (lambda x, y, angle: None, TypeError, "returns \\(fx, fy\\)"),
        (lambda x, y, angle: (1.0,), ValueError, "found 1 number"),
        (lambda x, y, angle: (1.0, float("nan")), ValueError, "no forces"),
        (lambda x: (0.0, 0.0), TypeError, "positional argument"),
        (lambda x, y, angle: "ab", TypeError, "returns"),
    ],
)
def test_what_a_function_raises_is_raised(cantilever: ancf.Scene, force: Any, error: type[Exception], message: str) -> None:
    cantilever.add_force("arm", "end", force)
    with pytest.raises(error, match=message):
        cantilever.run()


def test_wrong_places_and_derivatives_are_refused(cantilever: ancf.Scene) -> None:
    def nothing(x: float, y: float, angle: float) -> tuple[float, float]:
        return 0.0, 0.0

    with pytest.raises(KeyError, match="the beams are: arm"):
        cantilever.add_force("leg", "end", nothing)
    for place in (1.5, -0.1, "middle", float("nan")):
        with pytest.raises(ValueError, match="an arc length from 0 to 1"):
            cantilever.add_force("arm", place, nothing)
    with pytest.raises(TypeError, match="functions"):
        cantilever.add_force("arm", "end", 3)  # type: ignore[arg-type]
    cantilever.add_force("arm", "end", nothing, derivative=lambda x, y, angle: [[1.0]])
    with pytest.raises(ValueError, match="2 or 3 rows of 3 numbers"):
        cantilever.run()
    other = ancf.Scene(arm())
    other.add_force("arm", "end", nothing, derivative=lambda x, y, angle: [[1.0, 0.0, 0.0], [1.0]])
    with pytest.raises(ValueError, match="found rows of \\[3, 1\\]"):
        other.run()


def test_a_couple_within_the_span_has_a_node() -> None:
    """The curvature jumps there, between the nodes of the mesh."""
    moment = {"moment": [{"beam": "arm", "at": 0.3, "value": 3.0}]}
    own = ancf.Scene(arm(effect={}))
    own.add_force("arm", 0.3, lambda x, y, angle: (0.0, 0.0, 3.0))
    assert tip(own) == pytest.approx(tip(ancf.Scene(arm(effect=moment))), abs=1e-9)


def test_a_scene_with_functions_stays_in_its_process(cantilever: ancf.Scene) -> None:
    """Its text does not say them: nothing is computed without them in silence."""
    cantilever.add_force("arm", "end", lambda x, y, angle: (0.0, 1.0))
    with pytest.raises(ValueError, match="cannot be sent to another process"):
        pickle.dumps(cantilever)
    with pytest.raises(ValueError, match="cannot be swept"):
        ancf.sweep(cantilever, {"effect.moment.0.value": [1.0]})
    assert cantilever == cantilever and cantilever != cantilever.copy()
    assert "python_force" in cantilever.inspect()


def test_what_was_chosen_says_that_functions_are_missing() -> None:
    table = arm(analysis={"static": {"accuracy": 1e-4}})
    del table["beam"]["arm"]["basis"]
    scene = ancf.Scene(table)
    assert not (scene.run().chosen or "").startswith("#")
    scene.add_force("arm", "end", lambda x, y, angle: (0.0, 1.0))
    result = scene.run()
    assert result.chosen is not None and result.chosen.startswith("# Without what was added to the scene by code: 1 of its parts.")
    assert tip(scene.chosen()) == tip(scene)


def test_tangents_of_functions_lead_as_fast_as_those_of_the_scene() -> None:
    """With a wrong tangent Newton's method ends at the same place, but takes more iterations."""
    # With and without a pull that lengthens the bar by a quarter, so that r' is no unit vector.
    pull = {"force": [{"beam": "arm", "at": "end", "value": [5.0, 0.0]}]}
    for stiffness, more in [(1e4, {}), (20.0, pull)]:
        force = {"beam": "arm", "at": "end", "value": [-1.0, 4.0], "follower": True}
        moment = {"moment": [{"beam": "arm", "at": "end", "value": 2.2}]}

        def scene(effect: dict[str, Any], stiffness: float = stiffness) -> ancf.Scene:
            table = arm(effect=effect)
            table["beam"]["arm"]["axial_stiffness"] = stiffness
            return ancf.Scene(table)

        turned, bent = scene(more), scene(more)
        turned.add_force(
            "arm",
            "end",
            lambda x, y, angle: (-math.cos(angle) - 4.0 * math.sin(angle), -math.sin(angle) + 4.0 * math.cos(angle)),
        )
        bent.add_force("arm", "end", lambda x, y, angle: (0.0, 0.0, 2.2))
        named = [scene({**more, "force": [*more.get("force", []), force]}), scene({**more, **moment})]
        for own, other in zip([turned, bent], named, strict=True):
            found = [scene.run() for scene in (own, other)]
            counts = [result.statistics["newton_iterations"] for result in found]
            assert counts[0] == counts[1] > 0
            assert tip(own) == pytest.approx(tip(other), abs=1e-8)


def test_each_entry_of_a_derivative_leads() -> None:
    """A force and a couple that each depend on both coordinates and the angle: a function that tells another derivative
    of one by one of them than it has takes more iterations."""
    matrix = np.array([[6.0, 2.0, -3.0], [1.0, 5.0, 2.0], [-2.0, 3.0, 4.0]])

    def iterations(told: np.ndarray | None) -> int:
        table = arm(effect={})
        table["beam"]["arm"].update(start=[3, 2], end=[3.8, 2.6], axial_stiffness=1e3)
        scene = ancf.Scene(table)
        derivative = None if told is None else lambda *_: -told
        scene.add_force("arm", 0.5, lambda *z: matrix @ ([3.6, 2.75, 1.2] - np.array(z)), derivative=derivative)
        return int(scene.run().statistics["newton_iterations"])

    right = iterations(matrix)
    assert iterations(None) == right
    for row in range(3):
        for column in range(3):
            told = matrix.copy()
            told[row, column] *= 0.4
            assert iterations(told) > right, (row, column)


def braked(place: float, effect: dict[str, Any], coupling: float | None = None, told: float | None = None) -> ancf.Result:
    """A rod that moves and turns until a dashpot stops it: one that the scene names, or one by a function whose
    velocities along and across have a share in its couple, and which tells `told` for this share."""

    def matrix(coupling: float) -> np.ndarray:
        return np.array([[3.0, 0.0, 1.5 * coupling], [0.0, 3.0, -2.0 * coupling], [1.5 * coupling, -2.0 * coupling, 2.0]])

    motion = {"dynamic": {"duration": 0.1, "output_every": 0.1, "radau": {"step": 0.01}}}
    moving = [{"beam": "arm", "value": [0.01, 0.02], "rotation": 0.03}]
    table = falling(support=[], effect=effect, initial_velocity=moving, analysis=motion)
    table["beam"]["arm"].update(start=[3, 2], end=[3.8, 2.6])
    scene = ancf.Scene(table)
    if coupling is not None:
        derivative = None if told is None else lambda *_: -matrix(told)
        scene.add_force("arm", place, lambda *z: -matrix(coupling) @ z[3:], derivative=derivative, rates=True)
    return scene.run()


@pytest.mark.parametrize("place", [0.4, 1.0])
def test_matrices_of_dashpots_lead_as_fast_as_those_of_the_scene(place: float) -> None:
    spring = {"beam": "arm", "at": place, "damping": 3.0}
    named = braked(place, {"spring": [spring], "torsion_spring": [{**spring, "damping": 2.0}]})
    for own in (braked(place, {}, 0.0), braked(place, {}, 0.0, told=0.0)):
        assert own.statistics["newton_iterations"] == named.statistics["newton_iterations"]
        assert own.energy.lost[-1] == pytest.approx(named.energy.lost[-1], rel=1e-9)
    # A function that tells of no coupling, or of the opposite one, leads astray by as much, whichever it has.
    counts = [
        [braked(place, {}, coupling, told).statistics["newton_iterations"] for told in (coupling, 0.0, -coupling)]
        for coupling in (1.0, -1.0)
    ]
    for right, less, wrong in counts:
        assert 2 * right < less < wrong
    assert counts[0][0] == braked(place, {}, 1.0).statistics["newton_iterations"]
