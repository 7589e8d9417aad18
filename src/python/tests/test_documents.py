"""What README and the handbook print runs as printed."""

from __future__ import annotations

import doctest
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import ancf
import pytest

ROOT = Path(__file__).parents[3]
# Clusters that are not here: their lines are compiled, and the classes that they name are those of the packages, where installed.
ELSEWHERE = {"slurm": "dask_jobqueue", "kubernetes": "dask_kubernetes.operator", "mpi": "mpi4py.futures"}


def blocks(document: str) -> list[tuple[str, str]]:
    text = (ROOT / document).read_text(encoding="utf-8")
    return [(kind.strip(), code) for kind, code in re.findall(r"^```python([^\n]*)\n(.*?)^```$", text, re.M | re.S)]


@pytest.mark.parametrize(("document", "least"), [("README.md", 1), ("src/handbook/python.md", 5)])
def test_printed_python_runs_as_printed(document: str, least: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    scenes = re.findall(r"^```toml\n(.*?)^```$", (ROOT / document).read_text(encoding="utf-8"), re.M | re.S)
    for scene in scenes:
        (tmp_path / "scene.toml").write_text(scene, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {"__name__": "document"}
    printed = blocks(document)
    assert len([kind for kind, _ in printed if kind not in ELSEWHERE]) >= least
    for kind, code in printed:
        compiled = compile(code, f"{document} {kind}", "exec")
        if kind == "dask":
            pytest.importorskip("distributed")
        if kind not in ELSEWHERE:
            exec(compiled, names)
        if kind == "dask":
            client: Any = names["client"]
            client.close()
            client.cluster.close()


@pytest.mark.parametrize(("kind", "module"), ELSEWHERE.items())
def test_clusters_are_those_of_their_packages(kind: str, module: str) -> None:
    (code,) = [code for found, code in blocks("src/handbook/python.md") if found == kind]
    (name,) = re.findall(rf"from {module} import (\w+)", code)
    # In a process of its own, for these packages change how this one handles signals.
    asked = f"import importlib; made = getattr(importlib.import_module({module!r}), {name!r})"
    if kind == "slurm":
        (arguments,) = re.findall(r"SLURMCluster\((.*)\)", code)
        asked += f"; print(made.job_cls(scheduler='tcp://x:1', name='x', {arguments}).job_script())"
    done = subprocess.run([sys.executable, "-c", asked], capture_output=True, text=True, check=False)
    if "ModuleNotFoundError" in done.stderr or "cannot load MPI library" in done.stderr:
        pytest.skip(f"{module} is not here")
    assert done.returncode == 0, done.stderr
    if kind == "slurm":
        assert "#SBATCH --cpus-per-task=32" in done.stdout and "#SBATCH -t 02:00:00" in done.stdout


def test_the_example_of_the_module() -> None:
    failed, tried = doctest.testmod(ancf)
    assert failed == 0 and tried > 0
