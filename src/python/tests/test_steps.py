"""Motions step by step, with control in the loop."""

from __future__ import annotations

import ancf
import numpy as np
import pytest
from conftest import arm, falling


def test_without_a_change_steps_are_the_motion_as_a_whole(pendulum: ancf.Scene) -> None:
    whole = pendulum.run()
    steps = list(pendulum.steps())
    assert [step.time for step in steps] == pytest.approx(whole.time[1:], abs=1e-15)
    # Records of the whole lie between the ends of its steps, and are interpolated.
    assert [step.probes["tip"].x[-1] for step in steps] == pytest.approx(whole.probes["tip"].x[1:], abs=1e-8)
    assert [step.time for step in pendulum.steps(0.125)] == [0.125, 0.25, 0.375, 0.5]


def test_a_step_records_its_start_and_its_end() -> None:
    """However long: here 2 s of a rigid bar that falls freely."""
    table = falling(analysis={"dynamic": {"duration": "4 s", "output_every": "0.1 s", "radau": {"stages": 3, "tolerance": 1e-5}}})
    table["support"] = []
    for step in ancf.Scene(table).steps(2.0):
        assert list(step.result.time) == pytest.approx([step.time - 2.0, step.time])


def test_a_change_acts_from_then_on() -> None:
    """A rigid free beam pushed by a force F(t) that is switched: v = ∫F/m, in steps of a constant force."""
    table = falling(
        support=[{"beam": "arm", "at": "start", "fix": ["y", "angle"]}],
        effect={"force": [{"beam": "arm", "at": "start", "value": [0.0, 0.0]}]},
    )
    table["beam"]["arm"]["axial_stiffness"] = 1e6
    scene, speed = ancf.Scene(table), 0.0
    for step in scene.steps(0.05):
        force = 2.0 if step.time < 0.3 else -1.0
        step["effect.force.0.value"] = [force, 0.0]
        speed = step.probes["tip"].vx[-1]
    # 0.05 s of nothing, 0.25 s of 2 N, 0.2 s of −1 N, on 1 kg.
    assert speed == pytest.approx(0.25 * 2.0 - 0.2 * 1.0, abs=2e-3)
    assert scene["effect.force.0.value"] == [0.0, 0.0], "the scene itself is not changed"


def test_control_in_the_loop_holds_a_pendulum() -> None:
    """A motor at the hinge that is told the angle holds the beam near the horizontal, which it leaves alone."""
    motor = {
        "moment": [{"beam": "arm", "at": "start", "value": 0.0}],
        "gravity": {"acceleration": [0, -9.81]},
        "damping": [{"beam": "arm", "stiffness_proportional": "5 ms"}],
    }
    table = falling(effect=motor, probe=[{"name": "hinge", "beam": "arm", "at": "start"}, {"name": "tip", "beam": "arm", "at": "end"}])
    table["beam"]["arm"].update(axial_stiffness=1e6, bending_stiffness=1e2)
    free = ancf.Scene(table)
    assert free.run().probes["tip"].y[-1] < -0.5
    for step in free.steps(0.005):
        before, angle = step.probes["hinge"].angle
        step["effect.moment.0.value"] = 9.81 / 2 - 60.0 * angle - 4.0 * (angle - before) / 0.005
    # What is left is the beam's own bending under its weight, ρA g L⁴/(8 EI) = 0.012 m, about which it swings.
    assert abs(step.probes["tip"].y[-1]) < 0.02


def test_only_motions_have_steps(cantilever: ancf.Scene, pendulum: ancf.Scene) -> None:
    with pytest.raises(ancf.SceneError, match="only a motion has steps"):
        cantilever.steps()
    with pytest.raises(ValueError, match="positive"):
        pendulum.steps(-1.0)
    with pytest.raises(ValueError, match="positive"):
        pendulum.steps(float("nan"))


def test_an_open_mesh_is_chosen_first() -> None:
    table = falling(analysis={"dynamic": {"duration": 0.1, "output_every": 0.05, "accuracy": 1e-4}})
    del table["beam"]["arm"]["basis"]
    scene = ancf.Scene(table)
    steps = list(scene.steps())
    assert steps[-1].probes["tip"].y[-1] == pytest.approx(scene.run().probes["tip"].y[-1], abs=1e-4)
    assert np.isfinite(steps[-1].result.shape().M).all() and arm()["beam"]


def test_an_event_that_stops_the_motion_ends_its_steps() -> None:
    event = [{"probe": "tip", "y": -0.5, "stop": True}]
    table = falling()
    table["analysis"]["dynamic"]["event"] = event
    scene = ancf.Scene(table)
    end = scene.run().time[-1]
    assert end < 0.5
    times = [step.time for step in scene.steps(0.1)]
    assert times[-1] == pytest.approx(end, abs=1e-4) and times[:-1] == pytest.approx([0.1 * (i + 1) for i in range(len(times) - 1)])


def test_steps_have_two_records_wherever_they_begin(pendulum: ancf.Scene) -> None:
    first = next(iter(pendulum.steps(0.11)))
    for step in list(pendulum.steps(0.02, start=first.result))[:3]:
        assert len(step.result.time) == 2
        assert step.result.time[1] - step.result.time[0] == pytest.approx(0.02)


def test_a_spring_whose_stiffness_changes_keeps_its_turns() -> None:
    """E = k φ²/2 with all turns, whatever happened to k."""
    table = falling(
        effect={"torsion_spring": [{"beam": "arm", "at": "start", "stiffness": 0.05}]},
        initial_velocity=[{"beam": "arm", "rotation": 30.0, "about": [0, 0]}],
        probe=[{"name": "hinge", "beam": "arm", "at": "start"}],
    )
    table["beam"]["arm"].update(axial_stiffness=1e5, bending_stiffness=1e3)
    for step in ancf.Scene(table).steps(0.1):
        step["effect.torsion_spring.0.stiffness"] = 0.05 + 0.01 * step.time
        angle, k = step.probes["hinge"].angle[-1], 0.05 + 0.01 * (step.time - 0.1)
        assert step.result.energy.stored[-1] == pytest.approx(0.5 * k * angle**2, rel=1e-6)
    assert angle > 10.0
