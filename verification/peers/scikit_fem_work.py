"""How long scikit-fem takes to find natural frequencies of a plain description of a straight beam.

The matrices are those of `scikit_fem_scene.py`. scikit-fem has no eigenvalue solver of its own: what its users call is SciPy's, and
`solver` says which, LAPACK's for all of a dense pencil ("dense"), for the lowest alone ("lowest"), or ARPACK's with shifts ("sparse").
Timed is that call; assembling is the build.
"""

import json
import os
import sys
import time
from pathlib import Path

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # read once, while NumPy is imported

import numpy as np  # noqa: E402
import scipy.linalg  # noqa: E402
import scipy.sparse  # noqa: E402
import scipy.sparse.linalg  # noqa: E402

sys.path.insert(0, str(Path(__file__).parent))
import scikit_fem_scene as scene  # noqa: E402


def lowest(stiffness, mass, count, solver):
    """The `count` lowest eigenvalues, ascending."""
    if solver == "dense":
        return scipy.linalg.eigh(stiffness, mass, eigvals_only=True)[:count]
    if solver == "lowest":
        return scipy.linalg.eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, count - 1])
    if solver == "sparse":
        found = scipy.sparse.linalg.eigsh(stiffness, count, mass, sigma=0.0, return_eigenvectors=False)
        return np.sort(found)
    raise ValueError(f"no solver is called `{solver}` here")


def answer(text):
    """From {description, settings, repeat} as JSON to the frequencies and how long each repetition took, as JSON."""
    question = json.loads(text)
    given, settings = question["description"], dict(question["settings"])
    ((kind, asked),) = given["analysis"].items()
    solver = settings.pop("solver", "dense")
    if kind != "modal" or settings:
        raise ValueError(f"only frequencies are timed, and only `solver` is set; asked for {kind}, {list(settings)}")
    seconds, build = [], []
    for _ in range(question["repeat"]):
        start = time.perf_counter()
        beam = scene.Beam(given)
        pencil = beam.stiffness, beam.mass
        if solver == "sparse":
            pencil = [scipy.sparse.csc_matrix(matrix) for matrix in pencil]
        ready = time.perf_counter()
        squares = lowest(*pencil, asked["count"], solver)
        seconds.append(time.perf_counter() - ready)
        build.append(ready - start)
    frequencies = list(np.sqrt(np.maximum(squares, 0)) / (2 * np.pi))
    return json.dumps({"seconds": seconds, "build": build, "frequencies": frequencies}, allow_nan=False)
