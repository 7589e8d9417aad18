"""Sweeps by threads, processes and Dask: the same table, each run once, whatever happens to a worker."""

from __future__ import annotations

import csv
import faulthandler
import os
import signal
import subprocess
import sys
import threading
import time
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import ancf
import pytest
from conftest import arm, falling

VALUES: dict[Any, Any] = {"effect.moment.0.value": [1.0, 2.5, "3 N m"], ("beam.arm.basis.ancf.elements", "title"): [(4, "a"), (8, "b")]}


def table(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return [{name: value for name, value in row.items() if not name.startswith("seconds")} for row in rows]


def test_the_table_is_that_of_the_command_line(cantilever: ancf.Scene, tmp_path: Path) -> None:
    scene, listed = tmp_path / "arm.toml", tmp_path / "values.csv"
    scene.write_text(cantilever.text)
    listed.write_text("beam.arm.basis.ancf.elements,title\n4,a\n8,b\n")
    command: list[Any] = [sys.executable, "-m", "ancf", "sweep", scene, "--vary", "effect.moment.0.value=1.0,2.5,3 N m", "--list", listed]
    done = subprocess.run([*command, "-o", tmp_path / "cli", "-q"], capture_output=True, check=False)
    assert done.returncode == 0, done.stderr
    # The command line lets lists change slowest.
    values = dict(reversed(VALUES.items()))
    swept = ancf.sweep(ancf.Scene.load(scene), values, directory=tmp_path / "python")
    assert swept.path == tmp_path / "python/sweep.csv" and swept.unsolved == swept.warned == []
    assert table(swept.path) == table(tmp_path / "cli/sweep.csv") and len(swept.rows()) == 6


@pytest.mark.parametrize("executor", ["threads", "processes"])
def test_any_executor_gives_the_same_table(cantilever: ancf.Scene, tmp_path: Path, executor: str) -> None:
    alone = ancf.sweep(cantilever, VALUES, directory=tmp_path / "alone")
    pool = ThreadPoolExecutor(2) if executor == "threads" else ProcessPoolExecutor(2, mp_context=get_context("spawn"))
    rows: list[dict[str, Any]] = []
    with pool:
        swept = ancf.sweep(cantilever, VALUES, executor=pool, directory=tmp_path / "pool", on_row=rows.append)
    assert table(swept.path) == table(alone.path)
    assert sorted(row["run"] for row in rows) == [1, 2, 3, 4, 5, 6]


def test_a_sweep_goes_on_where_it_ended(cantilever: ancf.Scene, tmp_path: Path) -> None:
    def stop(row: dict[str, Any]) -> None:
        rows.append(row["run"])
        if len(rows) == 2:
            raise RuntimeError("enough")

    rows: list[int] = []
    with pytest.raises(RuntimeError, match="enough"), ThreadPoolExecutor(1) as pool:
        ancf.sweep(cantilever, VALUES, executor=pool, directory=tmp_path, on_row=stop)
    assert not (tmp_path / "sweep.csv").exists()
    more: list[int] = []
    ancf.sweep(cantilever, VALUES, directory=tmp_path, on_row=lambda row: more.append(row["run"]))
    lines = (tmp_path / "journal-1-of-1.jsonl").read_text().splitlines()
    assert len(lines) == 6 and len(more) < 6
    again: list[int] = []
    ancf.sweep(cantilever, VALUES, directory=tmp_path, on_row=lambda row: again.append(row["run"]))
    assert again == []
    with pytest.raises(ancf.SweepError, match="holds another sweep"):
        ancf.sweep(cantilever, {"effect.moment.0.value": [1.0]}, directory=tmp_path)


def test_a_process_that_dies_loses_and_doubles_nothing(tmp_path: Path) -> None:
    # Runs of milliseconds whose records fit a pipe together: a worker is killed while it computes. Python waits for ever for the rest of
    # a result of which a killed worker wrote a part.
    scene = ancf.Scene(falling(analysis={"dynamic": {"duration": 0.2, "output_every": 0.1}}))
    values = {"beam.arm.bending_stiffness": [1.0 + 0.01 * index for index in range(300)]}
    pool = ProcessPoolExecutor(2, mp_context=get_context("spawn"))

    def kill(row: dict[str, Any]) -> None:
        if row["run"] == 50:
            os.kill(next(iter(pool._processes)), signal.SIGKILL)

    faulthandler.dump_traceback_later(300, exit=True)
    try:
        with pytest.raises(BrokenProcessPool), pool:
            ancf.sweep(scene, values, executor=pool, directory=tmp_path, on_row=kill)
    finally:
        faulthandler.cancel_dump_traceback_later()
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        swept = ancf.sweep(scene, values, executor=pool, directory=tmp_path)
    runs = [int(row["run"]) for row in swept.rows()]
    assert runs == list(range(1, 301))
    assert len((tmp_path / "journal-1-of-1.jsonl").read_text().splitlines()) == 300


def test_a_worker_of_dask_that_is_killed_loses_and_doubles_nothing(tmp_path: Path) -> None:
    distributed = pytest.importorskip("distributed")
    scene = ancf.Scene(falling(analysis={"dynamic": {"duration": 0.2, "output_every": 0.1}}))
    values = {"beam.arm.bending_stiffness": [1.0 + 0.01 * index for index in range(200)]}
    # The nanny of a worker starts another one in its place.
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster, distributed.Client(cluster) as client:
        killed: list[int] = []

        def kill(row: dict[str, Any]) -> None:
            if not killed:
                killed.append(next(iter(client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)

        swept = ancf.sweep(scene, values, executor=client, directory=tmp_path / "dask", on_row=kill)
        assert killed
    alone = ancf.sweep(scene, values, directory=tmp_path / "alone")
    assert table(swept.path) == table(alone.path)
    assert len((tmp_path / "dask/journal-1-of-1.jsonl").read_text().splitlines()) == 200


def test_wrong_sweeps_are_refused_before_anything_is_computed(cantilever: ancf.Scene, tmp_path: Path) -> None:
    wrong: list[tuple[dict[Any, Any], type[Exception], str]] = [
        ({"effect.moment.0.value": [1.0, "2 m"]}, ancf.SceneError, "dimension"),
        ({"effect.moment.0.value": []}, ValueError, "empty"),
        ({"effect.moment.0.value": "123"}, TypeError, "a list of values"),
        ({"effect.moment.0.value": 3.0}, TypeError, "a list of values"),
        ({"effect.moment.0.value": [float("nan")]}, ValueError, "finite"),
        ({("a", "b"): [(1,)]}, ValueError, "expected 2 values"),
        ({"nonsense": [1]}, ancf.SceneError, "unknown key"),
        ({}, ancf.SweepError, "nothing varies"),
    ]
    for values, error, message in wrong:
        with pytest.raises(error, match=message):
            ancf.sweep(cantilever, values, directory=tmp_path / "none")
        assert not (tmp_path / "none").exists()
    with pytest.raises(TypeError, match="Executor"):
        ancf.sweep(cantilever, {"effect.moment.0.value": [1.0]}, executor=3, directory=tmp_path / "x")


def test_runs_that_fail_are_rows_of_their_own(tmp_path: Path) -> None:
    scene = ancf.Scene(arm(effect={"force": [{"beam": "arm", "at": "end", "value": [0.0, 1.0]}]}))
    swept = ancf.sweep(scene, {"effect.force.0.value": [[0.0, 1.0], [-1e9, 1.0]]}, directory=tmp_path)
    assert swept.unsolved == [2] and swept.rows()[1]["outcome"] == "failed" and "load factor" in swept.rows()[1]["message"]


def test_threads_share_the_work() -> None:
    """Runs let go of Python: two of them, begun at once, are under way at the same time."""
    scene = ancf.Scene(falling())
    under_way, most, lock = 0, 0, threading.Lock()

    def run() -> None:
        nonlocal under_way, most
        first = True

        def step(now: ancf.Progress) -> None:
            nonlocal under_way, most, first
            if first:
                first = False
                with lock:
                    under_way += 1
                    most = max(most, under_way)
                time.sleep(0.1)

        scene.run(on_step=step)
        with lock:
            under_way -= 1

    threads = [threading.Thread(target=run) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == 2
