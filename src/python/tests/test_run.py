"""Runs: results as numbers, how they are stopped, and what is left of those that fail."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path
from typing import Any

import ancf
import numpy as np
import pytest
from conftest import arm, falling

SLOW = {"dynamic": {"duration": "1000 s", "output_every": 0.5, "radau": {"stages": 3, "tolerance": 1e-6}}}


def read(path: Path) -> dict[str, np.ndarray]:
    table = np.genfromtxt(path, delimiter=",", names=True, deletechars="")
    return {name: np.atleast_1d(table[name]) for name in table.dtype.names or ()}


def test_numbers_are_those_of_the_command_line(pendulum: ancf.Scene, tmp_path: Path) -> None:
    scene = tmp_path / "pendulum.toml"
    pendulum["output.reactions"] = True
    pendulum["output.effects"] = True
    scene.write_text(pendulum.text)
    done = subprocess.run([sys.executable, "-m", "ancf", "run", scene, "-o", tmp_path / "out", "-q"], check=False)
    assert done.returncode == 0
    result = ancf.Scene.load(scene).run()
    probes, energy = read(tmp_path / "out/probes.csv"), read(tmp_path / "out/energy.csv")
    assert np.array_equal(result.time, probes["time"])
    for quantity in ("x", "y", "angle", "curvature", "strain", "vx", "vy"):
        assert np.array_equal(result.probes["tip"][quantity], probes[f"tip.{quantity}"]), quantity
    for name in ("stretch", "bend", "kinetic", "potential", "total"):
        assert np.array_equal(result.energy[name], energy[name]), name
    reactions, effects = read(tmp_path / "out/reactions.csv"), read(tmp_path / "out/effects.csv")
    assert np.array_equal(result.reactions["support1"].fy, reactions["support1.fy"])
    assert np.array_equal(result.effects["gravity.arm"].fy, effects["gravity.arm.fy"])
    shape = read(tmp_path / "out/shape.csv")
    for column, name in {"N": "axial_force", "Q": "shear_force", "M": "bending_moment", "x": "x", "curvature": "curvature"}.items():
        assert np.array_equal(getattr(result.shape("arm"), column), shape[name]), column
    result.save(tmp_path / "saved")
    for name in ("probes.csv", "energy.csv", "shape.csv", "reactions.csv", "state.json"):
        assert (tmp_path / "saved" / name).read_bytes() == (tmp_path / "out" / name).read_bytes(), name
    assert (tmp_path / "saved/report.html").is_file()


def test_stresses_are_those_of_the_files(tmp_path: Path) -> None:
    def arm(section: str) -> str:
        return f"""
            support = [{{ beam = "arm", at = "start", fix = ["x", "y", "angle"] }}]
            effect.force = [{{ beam = "arm", at = "end", value = [1, -2] }}]
            beam.arm = {{ start = [0, 0], end = [1, 0], basis.ancf.elements = 4, {section} }}
            analysis.static.steps = 2
        """

    layers = "{ youngs_modulus = 1e9, width = 0.02, height = 0.01 }, { youngs_modulus = 3e9, width = 0.02, height = 0.02 }"
    text = arm(f"section.layers = [{layers}]")
    result = ancf.Scene.parse(text).run()
    result.save(tmp_path)
    shape, last = result.shape(), read(tmp_path / "shape.csv")
    assert np.array_equal(shape.stress, np.column_stack((last["stress_bottom"], last["stress_top"])))
    assert shape.layers is not None and shape.layers.shape == (2, len(shape.s), 2)
    # Bonded layers have the strain of their common face: stresses as their moduli.
    assert np.allclose(3 * shape.layers[0, :, 1], shape.layers[1, :, 0])
    half = result.shape(t=0.5)
    assert half.stress[0] == pytest.approx(0.5 * shape.stress[0], rel=0.02)
    plain = ancf.Scene.parse(arm("axial_stiffness = 1e4, bending_stiffness = 1")).run()
    with pytest.raises(ValueError, match="the stress in `arm` is not known"):
        _ = plain.shape().stress


def test_every_column_of_the_files_is_an_array(tmp_path: Path) -> None:
    """Of a motion that has all columns: forces that bend, stretch, damp and do work, layers, a joint, two beams."""
    layers = "{ youngs_modulus = 1e7, width = 0.02, height = 0.01 }, { youngs_modulus = 3e7, width = 0.02, height = 0.02 }"
    section = "section.layers = [" + layers.replace(" }", ", density = 2e3 }") + "]"
    result = ancf.Scene.parse(f"""
        beam.arm = {{ start = [0, 0], end = [1, 0], basis.ancf.elements = 3, {section} }}
        beam.leg = {{ start = [1, 0], end = [1, -0.5], axial_stiffness = 1e3, bending_stiffness = 1, mass_per_length = 1, \
            basis.ancf.elements = 2 }}
        support = [{{ beam = "arm", at = "start", fix = ["x", "y", "angle"] }}]
        joint = [{{ type = "weld", first = {{ beam = "arm", at = "end" }}, second = {{ beam = "leg", at = "start" }} }}]
        probe = [{{ name = "tip", beam = "arm", at = "end" }}, {{ name = "knee", beam = "leg", at = 0.25 }}]
        output = {{ reactions = true, effects = true, section_forces = true }}
        analysis.dynamic = {{ duration = 0.1, output_every = 0.05 }}
        [effect]
        gravity.acceleration = [1, -9.81]
        spring = [{{ beam = "leg", at = "end", stiffness = 50, damping = 2, anchor = [1.5, 0.2] }}]
        force = [{{ beam = "arm", at = 0.5, value = [1, 3], follower = true }}]
    """).run()
    result.save(tmp_path)
    files: dict[str, dict[str, Any]] = {
        "probes": dict(result.probes),
        "energy": {"": result.energy},
        "reactions": result.reactions,
        "effects": result.effects,
    }
    for file, arrays in files.items():
        table = read(tmp_path / f"{file}.csv")
        assert np.array_equal(result.time, table.pop("time"))
        # What is not known of one probe has a column without numbers, and no array.
        table = {column: values for column, values in table.items() if not np.isnan(values).all()}
        for column, values in table.items():
            name, quantity = column.rsplit(".", 1) if "." in column else ("", column)
            assert np.array_equal(arrays[name][quantity], values, equal_nan=True), column
        assert sum(len(list(columns)) for columns in arrays.values()) == len(table), file
        # But for resultants of what adds up to nothing all tell something.
        idle = [column for column, values in table.items() if not values.any()]
        assert all(column.endswith((".fx", ".fy")) for column in idle), idle


def test_shapes_between_records_blend_their_neighbours(pendulum: ancf.Scene) -> None:
    result = pendulum.run()
    at = [result.shape("arm", t=t) for t in (0.2, 0.22, 0.25)]
    for quantity in ("x", "y", "angle", "curvature", "strain", "N", "Q", "M"):
        first, middle, last = (getattr(shape, quantity) for shape in at)
        assert np.allclose(middle, 0.6 * first + 0.4 * last, rtol=1e-12, atol=1e-12), quantity
    tip = result.probes["tip"]
    assert (at[0].x[-1], at[0].y[-1]) == (tip.x[4], tip.y[4])
    # The end of the run has the forces of the last shape, however it is asked for.
    end, last = result.shape(t=0.5), result.shape()
    assert np.allclose(end.N, last.N, atol=1e-9 * np.abs(last.N).max())
    assert np.allclose(end.M, last.M, atol=1e-9)


def test_section_forces_of_a_record_carry_what_hangs_below(pendulum: ancf.Scene) -> None:
    """At every time the support carries what gravity and inertia do: its force is N and Q there."""
    pendulum["output.reactions"] = True
    result = pendulum.run()
    force = result.reactions["support1"]
    for record in (0, 3, 7, 10):
        shape = result.shape(t=result.time[record])
        cosine, sine = np.cos(shape.angle[0]), np.sin(shape.angle[0])
        fx, fy = cosine * shape.N[0] - sine * shape.Q[0], sine * shape.N[0] + cosine * shape.Q[0]
        assert fx == pytest.approx(-force.fx[record], abs=1e-6) and fy == pytest.approx(-force.fy[record], abs=1e-6)
        assert shape.M[-1] == pytest.approx(0.0, abs=1e-8) and shape.N[-1] == pytest.approx(0.0, abs=1e-8)


def test_statics_know_their_shapes_by_load_factor(cantilever: ancf.Scene) -> None:
    result = cantilever.run()
    assert np.allclose(result.shape(t=0.5).M, 1.5) and np.allclose(result.shape(t=1.0).M, 3.0)
    for wrong in (1.5, -0.1, float("nan")):
        with pytest.raises(ValueError, match="reaches from 0 to 1"):
            result.shape(t=wrong)
    with pytest.raises(KeyError, match="the beams are: arm"):
        result.shape("leg")
    with pytest.raises(ancf.ComputationError, match="shapes=True"):
        cantilever.run(shapes=False).shape(t=0.5)


def test_a_run_without_states_has_the_same_numbers_and_warnings(cantilever: ancf.Scene, pendulum: ancf.Scene) -> None:
    for scene in (cantilever, pendulum):
        whole, lean = scene.run(), scene.run(shapes=False, pictures=False)
        assert whole.probes["tip"].x.tolist() == lean.probes["tip"].x.tolist()
        assert whole.energy.total.tolist() == lean.energy.total.tolist() and whole.warnings == lean.warnings
        assert whole.shape().M.tolist() == lean.shape().M.tolist()
    modal = ancf.Scene(arm(effect={}, analysis={"modal": {"count": 1}})).run()
    with pytest.raises(ValueError, match="about one state"):
        modal.shape(t=1.0)


def test_a_page_moves_only_where_its_pictures_are_kept(cantilever: ancf.Scene) -> None:
    moving = ['"frames":' in cantilever.run(shapes=False, pictures=kept).page() for kept in (True, False)]
    assert moving == [True, False]


def test_an_accuracy_chooses_what_is_open() -> None:
    table = arm(analysis={"static": {"accuracy": 1e-5}})
    del table["beam"]["arm"]["basis"]
    scene = ancf.Scene(table)
    result = scene.run()
    assert result.error is not None and result.error.met and result.error.wanted == 1e-5
    error = result.probes["tip"].error
    assert error is not None and 0.0 < error.x[-1] < 1e-5
    # κ = M/EI = 3 along the beam; EA is finite, so that nothing is stretched by a moment.
    assert abs(result.probes["tip"].x[-1] - np.sin(3.0) / 3.0) < 1e-5
    assert np.allclose(result.shape(t=0.5).M, 1.5)
    chosen = scene.chosen()
    assert "basis" in chosen.text and chosen.run().error is None
    assert chosen.run().probes["tip"].x[-1] == result.probes["tip"].x[-1]
    with pytest.raises(ancf.ComputationError, match="not met") as caught:
        scene.run(accuracy=1e-15)
    partial = caught.value.partial
    assert isinstance(partial, ancf.Result) and partial.error is not None and not partial.error.met


def test_errors_are_estimated_of_a_scene_as_it_is(cantilever: ancf.Scene) -> None:
    error = cantilever.run(estimate=True).error
    assert error is not None and error.wanted is None and 0.0 < error.estimated < 1e-2


def test_frequencies_and_critical_loads(cantilever: ancf.Scene) -> None:
    cantilever = ancf.Scene(arm(effect={}, analysis={"modal": {"count": 2}}))
    result = cantilever.run()
    # (β L)² = 3.516, 22.03 of a cantilever with EI = ρA = L = 1.
    assert result.frequencies * 2.0 * np.pi == pytest.approx([3.5160, 22.0345], rel=1e-3)
    assert len(result.modes) == 2 and abs(result.modes[0]["arm"].y[-1]) == pytest.approx(2.0, rel=1e-3)
    with pytest.raises(AttributeError, match="no critical load factors"):
        result.load_factors
    push = {"force": [{"beam": "arm", "at": "end", "value": [-1.0, 0.0]}]}
    loads = ancf.Scene(arm(effect=push, analysis={"buckling": {"count": 1}})).run()
    assert loads.load_factors == pytest.approx([np.pi**2 / 4.0], rel=1e-3)
    with pytest.raises(AttributeError, match="no times"):
        loads.time


def test_tables_of_pandas_and_xarray(pendulum: ancf.Scene) -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    result = pendulum.run()
    frame, data = result.probes_frame(), result.to_xarray()
    assert frame.index.name == "time" and frame["tip.x"].iloc[-1] == result.probes["tip"].x[-1]
    assert data["y"].sel(probe="tip").values[-1] == result.probes["tip"].y[-1]
    assert np.array_equal(data["energy_kinetic"], result.energy.kinetic)


def test_a_notebook_shows_the_page(cantilever: ancf.Scene) -> None:
    shown = cantilever.run()._repr_html_()
    assert shown.startswith("<iframe srcdoc=") and "&lt;svg" in shown and "<script" not in shown


def test_a_failure_leaves_what_was_computed() -> None:
    pushed = arm(effect={"force": [{"beam": "arm", "at": "end", "value": [-1e6, 1.0]}]}, analysis={"static": {"steps": 10}})
    with pytest.raises(ancf.ComputationError, match="no equilibrium beyond load factor") as caught:
        ancf.Scene(pushed).run()
    assert caught.value.partial is None or not caught.value.partial.complete


def test_a_motion_goes_on_from_a_result_a_state_or_a_file(tmp_path: Path) -> None:
    whole = ancf.Scene(falling()).run()
    half = ancf.Scene(falling())
    half["analysis.dynamic.duration"] = 0.25
    first = half.run()
    path = tmp_path / "state.json"
    assert first.state is not None and first.state.time == 0.25
    first.state.save(str(path))
    for start in (first, first.state, path):
        second = half.run(start=start)
        assert second.time[-1] == 0.5 and second.probes["tip"].x[-1] == whole.probes["tip"].x[-1]
        assert second.shape(t=0.5).M == pytest.approx(whole.shape(t=0.5).M, abs=1e-9)
    with pytest.raises(OSError, match="nowhere"):
        half.run(start="/nowhere/state.json")
    # A motion at rest from the equilibrium under its load stays there.
    still = ancf.Scene(arm(analysis={"dynamic": {"duration": 0.1, "output_every": 0.1}}))
    moved = still.run(start=ancf.Scene(arm()).run()).probes["tip"]
    assert abs(moved.x[-1] - moved.x[0]) < 1e-9 and moved.x[0] < 0.1


def test_every_step_is_told_and_may_be_the_last(pendulum: ancf.Scene) -> None:
    told: list[ancf.Progress] = []
    result = pendulum.run(on_step=told.append)
    assert len(told) == result.statistics["steps"] and told[-1].parameter == told[-1].target == 0.5
    stopped = pendulum.run(on_step=lambda now: now.parameter < 0.2)
    assert not stopped.complete and 0.2 <= stopped.time[-1] < 0.5


def test_what_a_listener_raises_ends_the_run(pendulum: ancf.Scene) -> None:
    def fail(now: ancf.Progress) -> None:
        if now.parameter > 0.2:
            raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough") as caught:
        pendulum.run(on_step=fail)
    assert not caught.value.partial.complete  # type: ignore[attr-defined]
    assert caught.value.partial.time[-1] > 0.2  # type: ignore[attr-defined]


@pytest.mark.skipif(os.name == "nt", reason="signals")
def test_ctrl_c_ends_the_run_and_keeps_what_was_computed() -> None:
    scene = ancf.Scene(falling(analysis=SLOW))
    # A shell lets what it starts in the background ignore the signal.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    timer = threading.Timer(0.6, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt) as caught:
        scene.run()
    assert time.monotonic() - start < 20.0
    partial = caught.value.partial  # type: ignore[attr-defined]
    assert not partial.complete and 0.0 < partial.time[-1] < 1000.0 and partial.shape().x[0] == 0.0


def test_other_threads_go_on_meanwhile() -> None:
    scene, counted, over = ancf.Scene(falling(analysis=SLOW)), [], threading.Event()

    def count() -> None:
        while not over.is_set():
            counted.append(time.monotonic())
            time.sleep(0.01)

    thread = threading.Thread(target=count)
    thread.start()
    start = time.monotonic()
    scene.run(on_step=lambda now: time.monotonic() - start < 1.0)
    over.set()
    thread.join()
    gaps = np.diff([moment for moment in counted if start <= moment <= start + 1.0])
    assert len(gaps) > 5


def test_progress_is_shown_on_standard_error(capsys: pytest.CaptureFixture[str]) -> None:
    scene, start = ancf.Scene(falling(analysis=SLOW)), time.monotonic()
    scene.run(progress=True, on_step=lambda now: time.monotonic() - start < 0.5)
    shown = capsys.readouterr()
    assert "of 1000" in shown.err and "%" in shown.err and not shown.out


def test_ten_thousand_runs_leak_nothing(cantilever: ancf.Scene) -> None:
    resource = pytest.importorskip("resource")

    def runs(count: int) -> None:
        for index in range(count):
            cantilever["effect.moment.0.value"] = 1.0 + index % 7
            cantilever.run().shape(t=0.5)

    def used() -> int:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
        return pages * int(resource.getpagesize())

    if not Path("/proc/self/statm").exists():
        pytest.skip("no /proc")
    runs(1000)
    before = used()
    runs(10_000)
    assert used() - before < 4e6, "bytes more after ten thousand runs"


def test_stages_go_on_from_each_other() -> None:
    table = arm(
        effect={"force": [{"beam": "arm", "at": "end", "value": [0, 3e-3], "until": "swing"}]},
        stage=[
            {"name": "bend", "analysis": {"static": {}}},
            {"name": "swing", "analysis": {"dynamic": {"duration": 0.2, "output_every": 0.05}}},
        ],
    )
    del table["analysis"]
    scene = ancf.Scene(table)
    assert (scene.analysis, scene.stages) == ("stages", ["bend", "swing"])
    assert "stage bend" in scene.inspect() and "stage swing" in scene.inspect()
    bent, swung = scene.run(stage="bend"), scene.run()
    assert bent.probes["tip"].y[-1] == pytest.approx(1e-3, rel=1e-4)
    assert swung.probes["tip"].y[0] == pytest.approx(bent.probes["tip"].y[-1], abs=1e-12)
    assert swung.time[-1] == pytest.approx(0.2)
    ends = [swung.shape(beam="arm", t=0.0), bent.shape(beam="arm", t=1.0)]
    assert np.allclose(ends[0].curvature, ends[1].curvature, atol=1e-12)
    assert ends[1].M[0] == pytest.approx(3e-3, rel=1e-3)
    with pytest.raises(KeyError, match="there is no stage `draw`; the stages are: bend, swing"):
        scene.run(stage="draw")
    told = [scene.run(stage=stage, estimate=True).error for stage in scene.stages]
    assert all(error is not None and 0 < error.estimated < 1e-2 for error in told)


def test_all_states_are_saved_where_the_scene_asks_for_them(tmp_path: Path) -> None:
    """However many they are, and whether or not pictures are wanted."""
    table = falling(output={"states": True})
    table["analysis"]["dynamic"]["output_every"] = 0.001
    for pictures in (True, False):
        folder = tmp_path / str(pictures)
        ancf.Scene(table).run(pictures=pictures).save(folder)
        with open(folder / "states.csv", encoding="utf-8") as file:
            times = {line.split(",")[0] for line in file} - {"time"}
        assert len(times) == 501
