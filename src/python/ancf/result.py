"""Results as arrays."""

from __future__ import annotations

import html
import json
import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _ancf

if TYPE_CHECKING:
    import pandas
    import xarray

Array = NDArray[np.float64]


def _array(data: bytearray) -> Array:
    return np.frombuffer(data, dtype=np.float64)


class Columns(Mapping[str, Array]):
    """Arrays of one length by their names: `energy["bend"]` or `energy.bend`."""

    def __init__(self, columns: Mapping[str, bytearray]) -> None:
        self._columns = {name: _array(data) for name, data in columns.items()}

    def __getitem__(self, name: str) -> Array:
        try:
            return self._columns[name]
        except KeyError:
            raise KeyError(f"there is no `{name}`; there are: {', '.join(self._columns)}") from None

    def __getattr__(self, name: str) -> Array:
        if name.startswith("_"):
            raise AttributeError(name)
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(error.args[0]) from None

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._columns]

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(self._columns)}>"


class Probe(Columns):
    """What a probe sees at every record: `x`, `y` [m], `angle` [rad], `curvature` [1/m], `strain`,
    and in motions `vx`, `vy` [m/s]. With `output.section_forces` also what the section carries:
    `axial_force`, `shear_force` [N], `bending_moment` [N m], and `stress_bottom`, `stress_top` [Pa]
    where they are known."""

    def __init__(self, name: str, columns: Mapping[str, bytearray], error: Mapping[str, bytearray] | None) -> None:
        super().__init__(columns)
        self.name = name
        self.error = None if error is None else Columns(error)
        """The estimated errors of the same quantities, where they are known."""


class Probes(Mapping[str, Probe]):
    """Probes by their names."""

    def __init__(self, results: _ancf.Results) -> None:
        self._results = results
        self._places = {name: index for index, name in enumerate(results.probes)}
        self._seen: dict[str, Probe] = {}

    def __getitem__(self, name: str) -> Probe:
        if name not in self._seen:
            if name not in self._places:
                known = ", ".join(self._places) or "none: a scene names them as [[probe]]"
                raise KeyError(f"there is no probe `{name}`; the probes are: {known}")
            index = self._places[name]
            self._seen[name] = Probe(name, self._results.probe(index), self._results.probe_error(index))
        return self._seen[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._places)

    def __len__(self) -> int:
        return len(self._places)

    def __repr__(self) -> str:
        return f"<Probes: {', '.join(self._places)}>"


@dataclass(frozen=True, repr=False)
class Shape:
    """A beam in a state, from its start to its end. A place where a force or a couple acts is there
    twice: before and behind it."""

    beam: str
    """Its name."""
    s: Array
    """Arc length [m]."""
    x: Array
    """Position along x [m]."""
    y: Array
    """Position along y [m]."""
    angle: Array
    """Direction of the tangent [rad], continuous along the beam."""
    strain: Array
    """Axial strain."""
    curvature: Array
    """Curvature [1/m]."""
    N: Array
    """Axial force [N], positive in tension."""
    Q: Array
    """Shear force [N]."""
    M: Array
    """Bending moment [N m], of the sign of EI κ."""
    nodes: Array
    """Positions of the nodes [m], one row each."""
    layers: Array | None = None
    """Stresses [Pa] of each layer of the section at each place, on its faces to the right and to the
    left of the centreline: an array of layers, places and these two. None where the scene does not
    tell the shape of the section and its modulus."""

    @property
    def stress(self) -> Array:
        """Stresses [Pa] on the outer faces to the right and to the left of the centreline, a row for
        each place.

        Raises ValueError where the scene does not tell the shape of the section and its modulus."""
        if self.layers is None:
            raise ValueError(f"the stress in `{self.beam}` is not known: give the beam `youngs_modulus` and a `section`")
        return np.column_stack((self.layers[0, :, 0], self.layers[-1, :, 1]))

    @property
    def r(self) -> Array:
        """Positions [m], one row each."""
        return np.column_stack((self.x, self.y))

    def __repr__(self) -> str:
        return f"<Shape of {self.beam}: {len(self.s)} places>"


@dataclass(frozen=True, repr=False)
class Mode:
    """A vibration or a buckling shape: what it changes along one beam."""

    beam: str
    """Its name."""
    s: Array
    """Arc length [m]."""
    x: Array
    """Displacement along x [m]."""
    y: Array
    """Displacement along y [m]."""
    angle: Array
    """Turn of the tangent [rad]."""
    strain: Array
    """Change of the axial strain."""
    curvature: Array
    """Change of the curvature [1/m]."""

    def __repr__(self) -> str:
        return f"<Mode of {self.beam}: {len(self.s)} places>"


@dataclass(frozen=True)
class Error:
    """The estimated errors of a result."""

    wanted: float | None
    """The largest error that was wanted: of positions in beam lengths, or of numbers, relative."""
    estimated: float
    """The largest error; infinite where nothing is known of it."""
    met: bool
    """Whether no error is larger than wanted."""
    reason: str | None
    """Why not."""
    good_until: float | None
    """Time [s] or load factor until which results are as good as was wanted."""
    notes: list[str]
    """Where the model itself errs."""


class Result:
    """The results of a run. Arrays have an entry per record."""

    def __init__(self, results: _ancf.Results) -> None:
        self._results = results

    @property
    def analysis(self) -> str:
        """`static`, `dynamic`, `modal` or `buckling`."""
        return self._results.analysis

    @cached_property
    def summary(self) -> dict[str, Any]:
        """What `summary.json` says."""
        read: dict[str, Any] = json.loads(self._results.summary())
        return read

    @property
    def complete(self) -> bool:
        """Whether the run reached as far as was asked for."""
        return bool(self.summary["complete"])

    @cached_property
    def parameter(self) -> Array:
        """Load factors or times [s] of the records."""
        return _array(self._results.parameter())

    @property
    def time(self) -> Array:
        """Times [s] of the records of a motion."""
        return self._parameter_of("dynamic", "times", "load_factor")

    @property
    def load_factor(self) -> Array:
        """Load factors of the records of a static analysis."""
        return self._parameter_of("static", "load factors", "time")

    def _parameter_of(self, analysis: str, what: str, other: str) -> Array:
        if self.analysis != analysis:
            raise AttributeError(f"a {self.analysis} analysis has no {what}; see `{other}` or `parameter`")
        return self.parameter

    @cached_property
    def probes(self) -> Probes:
        """What each probe sees."""
        return Probes(self._results)

    @cached_property
    def energy(self) -> Columns:
        """Energies [J]: `stretch`, `bend`, `stored`, `kinetic`, `potential`, `work`, `lost`, `total`."""
        return Columns(self._results.energy())

    @cached_property
    def reactions(self) -> dict[str, Columns]:
        """Forces `fx`, `fy` [N] and `moment` [N m] of supports and joints, by their names; where the
        scene asks for them (`output.reactions = true`)."""
        return {name: Columns(columns) for name, columns in self._results.reactions().items()}

    @cached_property
    def effects(self) -> dict[str, Columns]:
        """`energy` [J], `fx`, `fy` [N] of effects, by their names; where the scene asks for them
        (`output.effects = true`)."""
        return {name: Columns(columns) for name, columns in self._results.effects().items()}

    @property
    def events(self) -> list[dict[str, Any]]:
        """What happened in a motion, in order."""
        return list(self.summary.get("events", []))

    @property
    def warnings(self) -> list[str]:
        """What the user should know."""
        return list(self.summary["warnings"])

    @property
    def statistics(self) -> dict[str, int]:
        """Counts of steps, iterations and factorisations."""
        return dict(self.summary["statistics"])

    @property
    def seconds(self) -> dict[str, float]:
        """Computing time [s]."""
        return dict(self.summary["seconds"])

    @cached_property
    def error(self) -> Error | None:
        """The estimated errors, where they are known."""
        said = self.summary.get("error")
        if said is None:
            return None
        estimated = said["estimated"]
        return Error(
            wanted=said["wanted"],
            estimated=float("inf") if estimated is None else estimated,
            met=said["met"],
            reason=said.get("reason"),
            good_until=said.get("good_until"),
            notes=list(said.get("notes", [])),
        )

    @cached_property
    def frequencies(self) -> Array:
        """Natural frequencies [Hz], ascending, of a modal analysis."""
        return self._eigenvalues("modal", "frequencies")

    @cached_property
    def load_factors(self) -> Array:
        """Critical load factors, ascending, of a buckling analysis."""
        return self._eigenvalues("buckling", "critical load factors")

    def _eigenvalues(self, analysis: str, what: str) -> Array:
        if self.analysis != analysis:
            raise AttributeError(f"a {self.analysis} analysis has no {what}")
        return _array(self._results.eigenvalues())

    @cached_property
    def modes(self) -> list[dict[str, Mode]]:
        """Vibrations or buckling shapes, in the order of their numbers, each by the beams' names."""
        modes = []
        for shapes in self._results.modes():
            made = (Mode(**_arrays(columns)) for columns in shapes)
            modes.append({mode.beam: mode for mode in made})
        return modes

    @cached_property
    def _last(self) -> dict[str, Shape]:
        return _shapes(self._results.shapes(None))

    @cached_property
    def undeformed(self) -> dict[str, Shape]:
        """The stress-free shape of each beam, without forces."""
        return _shapes(self._results.undeformed())

    def shape(self, beam: str | None = None, t: float | None = None) -> Shape:
        """A beam (which may be left out where there is one) in the last state, or at time or load
        factor `t`: between records their mean, weighted by the distance."""
        shapes = self._last if t is None else _shapes(self._results.shapes(float(t)))
        if beam is None:
            if len(shapes) > 1:
                raise ValueError(f"which beam? There are: {', '.join(shapes)}")
            beam = next(iter(shapes))
        if beam not in shapes:
            raise KeyError(f"there is no beam `{beam}`; the beams are: {', '.join(shapes)}")
        return shapes[beam]

    @property
    def chosen(self) -> str | None:
        """The text of the scene with what was chosen for an accuracy, which gives the same results."""
        return self._results.chosen

    @property
    def state(self) -> _ancf.State | None:
        """The state from which a motion can start."""
        return self._results.state

    def save(self, directory: str | os.PathLike[str]) -> None:
        """Writes the files and the page of the command line."""
        self._results.save(os.fspath(directory))

    def probes_frame(self) -> pandas.DataFrame:
        """All probes as a table of pandas, with columns as in `probes.csv`, by time or load factor."""
        import pandas

        columns: dict[str, Array] = {}
        for name, probe in self.probes.items():
            columns.update({f"{name}.{quantity}": values for quantity, values in probe.items()})
            if probe.error is not None:
                columns[f"{name}.error"] = probe.error["x"]
        index = pandas.Index(self.parameter, name="time" if self.analysis == "dynamic" else "load")
        return pandas.DataFrame(columns, index=index)

    def to_xarray(self) -> xarray.Dataset:
        """Probes and energies as a dataset of xarray, by time or load factor, and by probe."""
        import xarray

        dimension = "time" if self.analysis == "dynamic" else "load_factor"
        names = list(self.probes)
        quantities = list(self.probes[names[0]]) if names else []
        variables: dict[str, Any] = {
            quantity: (("probe", dimension), np.stack([self.probes[name][quantity] for name in names]))
            for quantity in quantities
        }
        variables.update({f"energy_{name}": ((dimension,), values) for name, values in self.energy.items()})
        attributes = {"title": self.summary["title"], "analysis": self.analysis, "version": self.summary["version"]}
        return xarray.Dataset(variables, {dimension: self.parameter, "probe": names}, attributes)

    def page(self) -> str:
        """The page `report.html`, with its moving picture."""
        return self._results.page()

    def _repr_html_(self) -> str:
        source = html.escape(self.page(), quote=True)
        return f'<iframe srcdoc="{source}" style="width: 100%; height: 48em; border: 0"></iframe>'

    def __repr__(self) -> str:
        records = f"{len(self.parameter)} records" if len(self.parameter) else "no record"
        end = "" if self.complete else ", incomplete"
        return f"<ancf.Result of a {self.analysis} analysis: {records}{end}>"


def _arrays(columns: Mapping[str, Any]) -> dict[str, Any]:
    return {name: _array(data) if isinstance(data, bytearray) else data for name, data in columns.items()}


def _shapes(columns: list[dict[str, Any]]) -> dict[str, Shape]:
    shapes = {}
    for one in columns:
        arrays = _arrays(one)
        arrays["nodes"] = arrays["nodes"].reshape(-1, 2)
        if "stress" in arrays:
            arrays["layers"] = arrays.pop("stress").reshape(-1, len(arrays["s"]), 2)
        shapes[arrays["beam"]] = Shape(**arrays)
    return shapes
