"""Scenes and their runs."""

from __future__ import annotations

import json
import math
import os
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from . import _ancf
from .result import Result
from .values import document, inline, plain

Force = Callable[..., Iterable[float]]
"""(x, y, angle) → (fx, fy) or (fx, fy, couple), in N and N m."""

Derivative = Callable[..., Iterable[Iterable[float]]]
"""(x, y, angle) → the derivatives of fx, of fy (and of the couple), each by x, y and the angle."""


class Progress(NamedTuple):
    """How far a run has got."""

    parameter: float
    """Load factor or time [s] reached."""
    target: float
    """Load factor or time [s] at which it ends."""
    step: float
    """The next step."""
    newton_iterations: int
    """Newton iterations so far."""


class Scene:
    """A legal scene: beams, supports, what acts, and what is to be computed.

    `Scene({...})` takes what a scene file says as a table of tables; `Scene.load` reads a file, and
    `Scene.parse` text. Whatever is not legal raises `SceneError`, with `file`, `line` and `column`.

    A scene keeps the shape functions that its runs have computed, so that it is solved again faster
    than for the first time, after changes of loads, say.
    """

    def __init__(self, scene: Mapping[str, Any], *, name: str = "<scene>") -> None:
        if not isinstance(scene, Mapping):
            found = type(scene).__name__
            raise TypeError(f"Scene takes a table (a dict), found {found}; Scene.load reads a file, Scene.parse text")
        self._scene = _ancf.Scene.parse(document(plain(scene, "")), name)

    @classmethod
    def _of(cls, scene: _ancf.Scene) -> Scene:
        made = cls.__new__(cls)
        made._scene = scene
        return made

    @classmethod
    def load(cls, path: str | os.PathLike[str], *, set: Mapping[str, Any] | None = None) -> Scene:
        """Reads a scene file, with the values of `set` at their paths."""
        return cls._of(_ancf.Scene.load(os.fspath(path), _overrides(set or {})))

    @classmethod
    def parse(cls, text: str, name: str = "<text>") -> Scene:
        """Reads a scene from text; `name` stands for the file in messages."""
        return cls._of(_ancf.Scene.parse(text, name))

    def __getitem__(self, path: str) -> Any:
        """The value at a path such as `effect.moment.0.value`, as the scene says it."""
        value = self._scene.value(_path(path))
        if value is None:
            raise KeyError(f"the scene has no `{path}`")
        return json.loads(value)

    def __setitem__(self, path: str, value: Any) -> None:
        """Sets the value at a path, which is added where it is missing; the scene stays legal, or
        as it was."""
        self._scene = self._scene.with_overrides(_overrides({path: value}))

    def __contains__(self, path: str) -> bool:
        return self._scene.value(_path(path)) is not None

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets the values at several paths at once."""
        self._scene = self._scene.with_overrides(_overrides(values))

    def copy(self) -> Scene:
        """Another scene that says the same, and shares what was computed."""
        return self._of(self._scene)

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> Scene:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        self._without_functions("cannot be sent to another process")
        return (Scene.parse, (self.text, self.name))

    def __eq__(self, other: object) -> bool:
        """Whether both say the same; scenes with forces by functions equal themselves alone."""
        if not isinstance(other, Scene):
            return NotImplemented
        return self is other or (self.text == other.text and not self._scene.forces and not other._scene.forces)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        beams = ", ".join(name for name, _ in self._scene.beams)
        return f"<ancf.Scene {self.name}: {self.analysis} analysis of {beams}>"

    def _without_functions(self, what: str) -> None:
        if self._scene.forces:
            raise ValueError(f"{self.name}: a scene with forces by functions (add_force) {what}: its text does not say them")

    @property
    def text(self) -> str:
        """The scene as the text of a file, without forces by functions."""
        return self._scene.text

    @property
    def name(self) -> str:
        """The name in messages: the file's path."""
        return self._scene.name

    @property
    def stages(self) -> list[str]:
        """The names of the stages; none of a scene with one analysis."""
        return self._scene.stages

    @property
    def analysis(self) -> str:
        """`static`, `dynamic`, `modal` or `buckling`; `stages` of a scene that has several."""
        return self._scene.analysis

    @property
    def beams(self) -> dict[str, float]:
        """The beams with their lengths [m]."""
        return dict(self._scene.beams)

    def inspect(self) -> str:
        """What would be built: effects, tables, unknowns, bandwidth, memory."""
        return self._scene.inspect()

    def add_force(
        self,
        beam: str,
        at: str | float,
        force: Force,
        *,
        derivative: Derivative | None = None,
        rates: bool = False,
    ) -> None:
        """A force at a point that a function gives, for what scenes have no words for.

        `at` is `"start"`, `"end"` or an arc length [m]. `force(x, y, angle)` returns (fx, fy) [N],
        or (fx, fy, couple) with a couple [N m]; the angle is that of the section, within ±π. With
        `rates` it is `force(x, y, angle, vx, vy, rate)`, and acts in motions alone.
        `derivative`, of the same arguments, returns a row for fx, for fy (and for the couple), each
        of derivatives by x, y and the angle, with `rates` by the three rates; without it,
        differences of the force take their place.

        A call from the solver to Python takes about a microsecond, which is as much as ten
        elements of an iteration, and runs in threads wait for each other there. In statics the
        force grows with the load factor. What the function raises ends the run, and is raised.
        """
        if not callable(force) or not (derivative is None or callable(derivative)):
            raise TypeError("`force` and `derivative` are functions")
        lengths = self.beams
        if beam not in lengths:
            raise KeyError(f"there is no beam `{beam}`; the beams are: {', '.join(lengths)}")
        s = {"start": 0.0, "end": lengths[beam]}.get(at) if isinstance(at, str) else float(at)
        if s is None or not 0.0 <= s <= lengths[beam] * (1 + 1e-9):
            raise ValueError(f"`at` is 'start', 'end' or an arc length from 0 to {lengths[beam]} m, found {at!r}")
        self._scene = self._scene.with_force(beam, s, force, derivative, rates)

    def run(
        self,
        *,
        accuracy: float | None = None,
        estimate: bool = False,
        start: Result | _ancf.State | str | os.PathLike[str] | None = None,
        stage: str | None = None,
        progress: bool = False,
        on_step: Callable[[Progress], object] | None = None,
        shapes: bool = True,
        pictures: bool = True,
    ) -> Result:
        """Solves the scene, while other Python threads go on.

        `accuracy` is the largest error in place of the scene's, and chooses what the scene leaves
        open; `estimate` gives the errors of a scene that names its mesh and steps. `start` is a
        result, a `State` or a `state.json` from which the analysis starts. Of a scene with stages the
        results are those of `stage`, or of the last one. `progress` shows on standard
        error how far it is; `on_step` is called with a `Progress` after every step and ends the
        run by returning `False`.

        `shapes` keeps all recorded states, so that `Result.shape` knows every time, and `pictures`
        those of the page; in a loop over small scenes both may be left out.

        Raises `ComputationError` where there is no way on, or the accuracy cannot be had, and
        `KeyboardInterrupt` after Ctrl-C; both have the results until then as `partial`.
        """
        scene = self._scene
        if accuracy is not None:
            if scene.analysis == "stages":
                raise ValueError("this scene has stages, and an accuracy is that of one analysis")
            scene = scene.with_overrides(_overrides({f"analysis.{scene.analysis}.accuracy": accuracy}))
        return self._run(scene, estimate=estimate, start=start, stage=stage, progress=progress, on_step=on_step, shapes=shapes, pictures=pictures)

    @staticmethod
    def _run(
        scene: _ancf.Scene,
        *,
        estimate: bool = False,
        start: Result | _ancf.State | str | os.PathLike[str] | None = None,
        stage: str | None = None,
        duration: float | None = None,
        progress: bool = False,
        on_step: Callable[[Progress], object] | None = None,
        shapes: bool = True,
        pictures: bool = True,
    ) -> Result:
        tick = _show if progress else None
        step = None if on_step is None else (lambda *told: on_step(Progress(*told)))
        try:
            results = scene.run(
                estimate=estimate,
                start=_state(start),
                stage=stage,
                duration=duration,
                shapes=shapes,
                pictures=pictures,
                tick=tick,
                on_step=step,
            )
        except BaseException as error:
            partial = getattr(error, "partial", None)
            if isinstance(partial, _ancf.Results):
                error.partial = Result(partial)  # type: ignore[attr-defined]
            raise
        finally:
            if progress:
                print("\r\033[K", end="", file=sys.stderr, flush=True)
        return Result(results)

    def chosen(self) -> Scene:
        """The scene with everything that its accuracy leaves open chosen, by a run. It is solved
        faster, again and again: nothing is searched for, and no error is estimated."""
        if not self._scene.is_open:
            return self.copy()
        text = self.run(shapes=False, pictures=False).chosen
        return self.copy() if text is None else self._of(self._scene.with_text(text))

    def steps(self, every: float | None = None, *, start: Result | _ancf.State | str | os.PathLike[str] | None = None) -> Iterator[Step]:
        """A motion in steps of `every` seconds (the time between its records), for control in the
        loop: read the state, set values, go on.

        >>> for step in scene.steps(0.01):                            # doctest: +SKIP
        ...     step["effect.moment.0.value"] = -20.0 * step.probes["tip"].angle[-1]

        A change acts from this moment on. A motion that an event stops has no more steps. Where
        the scene leaves its mesh open, it is chosen first, by a run without control.
        """
        motion = self._scene.motion
        if motion is None:
            raise _ancf.SceneError(f"{self.name}: only a motion has steps, and this is a {self.analysis} analysis")
        duration, output_every = motion
        every = output_every if every is None else float(every)
        if not 0.0 < every < math.inf:
            raise ValueError(f"`every` is a positive time in seconds, found {every}")
        return _steps(self.chosen(), duration, every, start)


class Step:
    """A motion at the end of a step: its state, and the scene of what follows."""

    def __init__(self, scene: Scene, result: Result) -> None:
        self.scene = scene
        """The scene, whose values may be changed."""
        self.result = result
        """The results of this step, with its start and its end as records."""

    @property
    def time(self) -> float:
        """The time [s]."""
        return float(self.result.time[-1])

    @property
    def probes(self) -> Any:
        """What the probes see; the present is the last record, `[-1]`."""
        return self.result.probes

    def __getitem__(self, path: str) -> Any:
        return self.scene[path]

    def __setitem__(self, path: str, value: Any) -> None:
        self.scene[path] = value


def _steps(scene: Scene, duration: float, every: float, start: Any) -> Iterator[Step]:
    # As records are: the last step is shorter where the others do not fill the duration.
    count = max(1, math.ceil(duration / every * (1.0 - 1e-12)))
    for index in range(count):
        length = duration - index * every if index + 1 == count else every
        result = Scene._run(scene._scene, start=start, duration=length, pictures=False)
        step = Step(scene, result)
        yield step
        scene, start = step.scene, result.state
        if result.time[-1] - result.time[0] < length * (1.0 - 1e-9):
            # An event has stopped the motion.
            return


def _path(path: str) -> str:
    if not isinstance(path, str):
        raise TypeError(f"a path is text such as 'effect.moment.0.value', found {path!r}")
    return path


def _overrides(values: Mapping[str, Any]) -> list[str]:
    return [f"{_path(path)}={inline(plain(value, path))}" for path, value in values.items()]


def _state(start: Any) -> _ancf.State | None:
    if start is None or isinstance(start, _ancf.State):
        return start
    if isinstance(start, Result):
        if start.state is None:
            raise ValueError("this result has no state from which a motion can start: only motions and full equilibria have")
        return start.state
    return _ancf.State.load(os.fspath(start))


def _show(parameter: float, target: float, step: float, iterations: int) -> None:
    share = f"{100 * parameter / target:3.0f} %" if target else ""
    print(f"\r\033[K{share}  at {parameter:.6g} of {target:.6g}, step {step:.1e}", end="", file=sys.stderr, flush=True)
