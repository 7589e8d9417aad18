"""Many runs, by any executor."""

from __future__ import annotations

import asyncio
import csv
import json
import os
import tempfile
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _ancf
from .scene import Scene
from .values import text

if TYPE_CHECKING:
    import pandas

Axes = tuple[tuple[tuple[str, ...], tuple[tuple[str, ...], ...]], ...]

# A call to a worker costs some milliseconds, on another machine some ten: it should take this long.
_SECONDS_A_CALL = 0.5
# Calls that wait at each worker, so that none is idle while results travel.
_CALLS_A_WORKER = 3
_LARGEST_CALL = 2000


@dataclass(frozen=True)
class SweepTable:
    """A complete sweep: one row per run."""

    path: Path
    """The table, `sweep.csv`, as `ancf sweep` writes it."""
    unsolved: list[int]
    """The numbers of the runs that failed or were refused, from 1."""
    warned: list[int]
    """The numbers of those that were solved with warnings."""

    def rows(self) -> list[dict[str, str]]:
        """The rows, as the table says them."""
        with self.path.open(newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def to_frame(self) -> pandas.DataFrame:
        """The table as one of pandas, by the numbers of the runs."""
        import pandas

        return pandas.read_csv(self.path, index_col="run")


def sweep(
    scene: Scene,
    values: Mapping[Any, Iterable[Any]],
    *,
    executor: Any = None,
    directory: str | os.PathLike[str] | None = None,
    on_row: Callable[[dict[str, Any]], object] | None = None,
) -> SweepTable:
    """Runs a scene over the product of `values`: lists by the paths that take them, the last one
    changing fastest. A tuple of paths takes tuples of values, which change together. Texts stand as
    on the command line.

    `executor` computes the runs: nothing (threads on all cores), any `concurrent.futures.Executor`
    (processes, MPI by `mpi4py.futures`), or a `dask.distributed.Client`. Rows are recorded in
    `directory` as they come, each once; called again, the sweep goes on where it ended. `on_row` is
    called with every new record: its number `run`, `outcome`, `message`, `seconds`, `summary`.

    Raises `SceneError` before anything is computed where the scene of a run is not legal.
    """
    scene._without_functions("cannot be swept")
    axes = _axes(values)
    runs = _ancf.Sweep(scene._scene, _lists(axes))
    runs.check()
    where = Path(tempfile.mkdtemp(prefix="ancf-sweep-")) if directory is None else Path(directory)
    journal = _ancf.Journal(runs, os.fspath(where))
    try:
        left = journal.missing()
        if executor is None:
            with ThreadPoolExecutor(os.cpu_count()) as threads:
                _feed(threads, os.cpu_count() or 1, runs.compute, left, journal, on_row)
        else:
            task = _Task(scene.text, scene.name, axes)
            pool, workers = _pool(executor)
            _feed(pool, workers, task, left, journal, on_row)
        path, unsolved, warned = journal.merge()
    finally:
        journal.close()
    return SweepTable(Path(path), unsolved, warned)


@dataclass(frozen=True)
class _Task:
    """The runs of a sweep, as they travel to a worker."""

    text: str
    name: str
    axes: Axes

    def __call__(self, numbers: list[int]) -> list[str]:
        return _runs(self).compute(numbers)


@lru_cache(maxsize=4)
def _runs(task: _Task) -> _ancf.Sweep:
    """A worker reads the scene once, not for every call."""
    return _ancf.Sweep(_ancf.Scene.parse(task.text, task.name), _lists(task.axes))


def _feed(
    pool: Executor,
    workers: int,
    compute: Callable[[list[int]], list[str]],
    left: list[int],
    journal: _ancf.Journal,
    on_row: Callable[[dict[str, Any]], object] | None,
) -> None:
    """Hands out the runs that are left in calls of about the same length, and records what comes."""
    left = left[::-1]
    calls: set[Future[list[str]]] = set()
    size, seconds, finished = 1, 0.0, 0
    try:
        while left or calls:
            while left and len(calls) < _CALLS_A_WORKER * workers:
                # Towards the end calls are shorter, so that workers end together.
                share = max(1, len(left) // (2 * workers))
                numbers = [left.pop() for _ in range(min(size, share, len(left)))]
                calls.add(pool.submit(compute, numbers))
            done, calls = wait(calls, return_when=FIRST_COMPLETED)
            for call in done:
                lines = call.result()
                journal.enter(lines)
                for line in lines:
                    record = json.loads(line) if on_row is not None or finished < 1000 else None
                    finished += 1
                    if record is not None:
                        seconds += record["seconds"]
                        size = _size(seconds / finished)
                        if on_row is not None:
                            on_row(record)
    finally:
        for call in calls:
            call.cancel()


def _size(mean: float) -> int:
    return max(1, min(_LARGEST_CALL, int(_SECONDS_A_CALL / max(mean, 1e-9))))


class _Dask(Executor):
    """Dask's client as an executor.

    That of `Client.get_executor` fails where a worker dies between the arrival of a result at the client and its delivery: it takes the
    result for an exception. To wait for a future of Dask computes what was lost once more.
    """

    def __init__(self, client: Any) -> None:
        self._client = client

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        async def outcome() -> Any:
            return await self._client.submit(fn, *args, **kwargs, pure=False)

        return asyncio.run_coroutine_threadsafe(outcome(), self._client.loop.asyncio_loop)


def _pool(executor: Any) -> tuple[Executor, int]:
    """Dask's client as an executor, and how many calls are computed at a time."""
    if hasattr(executor, "get_executor"):
        return _Dask(executor), max(1, sum(executor.ncores().values()))
    if not hasattr(executor, "submit"):
        raise TypeError(f"expected a concurrent.futures.Executor or a dask.distributed.Client, found {executor!r}")
    # `num_workers` is that of mpi4py; the executors of Python tell it in `_max_workers` alone.
    workers = getattr(executor, "num_workers", None) or getattr(executor, "_max_workers", None)
    return executor, workers or os.cpu_count() or 1


def _axes(values: Mapping[Any, Iterable[Any]]) -> Axes:
    axes = []
    for path, taken in values.items():
        paths = (path,) if isinstance(path, str) else tuple(path)
        if isinstance(taken, (str, bytes)) or not hasattr(taken, "__iter__"):
            raise TypeError(f"{', '.join(paths)}: expected a list of values, found {taken!r}")
        rows = []
        for index, value in enumerate(taken):
            entries = (value,) if isinstance(path, str) else tuple(value)
            if len(entries) != len(paths):
                raise ValueError(f"{', '.join(paths)}: expected {len(paths)} values in entry {index}, found {len(entries)}")
            rows.append(tuple(text(entry, one) for entry, one in zip(entries, paths)))
        if not rows:
            raise ValueError(f"{', '.join(paths)}: the list of values is empty")
        axes.append((paths, tuple(rows)))
    return tuple(axes)


def _lists(axes: Axes) -> list[tuple[list[str], list[list[str]]]]:
    return [(list(paths), [list(row) for row in rows]) for paths, rows in axes]
