"""Scripts beside the packages: gallery, notebooks, docstrings, benchmarks, the targets of the make files."""

import doctest
import importlib
import importlib.util
import os
import re
import runpy
import shutil
import subprocess
import sys
from pathlib import Path

import matplotlib.pyplot as plt
import nbformat
import numpy as np
import pytest
from browser import PROGRAMS
from commands import python
from nbclient import NotebookClient

ROOT = Path(__file__).resolve().parents[1]
DOCS = ROOT / "docs"
NOTEBOOKS = sorted((DOCS / "notebooks").glob("*.ipynb"))
EXAMPLES = sorted((ROOT / "examples").glob("[0-9][0-9]_*.py"))


@pytest.mark.nightly
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example_runs_and_draws(path, monkeypatch):
    assert len(EXAMPLES) >= 8
    pyvista = pytest.importorskip("pyvista")
    shown: list[int] = []
    monkeypatch.setattr(plt, "show", lambda: shown.extend(plt.get_fignums()))
    monkeypatch.setattr(pyvista.Plotter, "show", lambda plotter: shown.append(len(plotter.actors)))
    plt.close("all")
    runpy.run_path(str(path), run_name="__main__")
    plt.close("all")
    assert shown and all(shown)


BENCHMARKS = ROOT / "benchmarks"


def test_scipy_is_given_the_lattices_own_jacobian(monkeypatch):
    """Against central differences of the right-hand side, in a bent state at rest."""
    monkeypatch.syspath_prepend(str(BENCHMARKS))
    for name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"):
        monkeypatch.setenv(name, "1")
    system, rate, jacobian = runpy.run_path(str(BENCHMARKS / "settling.py"))["equations"]()
    n, rng, h = system.reduced_mass.shape[0], np.random.default_rng(3), 1e-8
    y, along = np.zeros(2 * n), rng.standard_normal(2 * n)
    y[:n] = 1e-4 * rng.standard_normal(n)
    slope = (rate(0.1, y + h * along) - rate(0.1, y - h * along)) / (2 * h)
    exact = jacobian(0.1, y) @ along
    np.testing.assert_allclose(slope, exact, atol=1e-5 * np.abs(exact).max())


@pytest.fixture
def tree(tmp_path):
    """A copy of the repository, which scripts write to."""
    left_out = shutil.ignore_patterns(".*", "*.egg-info", "__pycache__", "_build", "build", "demo")
    return shutil.copytree(ROOT, tmp_path / "tree", ignore=left_out)


# scripts of benchmarks/ that no target of the make files runs, and their arguments for the smallest size
ALONE = {
    "against.py": (str(ROOT), "lattice:3", "shell:2", "settling:3", "--seconds", "0.1"),
    "contact.py": (),
    "gradients.py": ("1",),
    "live.py": ("--grid", "3", "--elements", "2", "--drags", "2"),
    "natural.py": ("arc",),
    "one_file.py": ("3", "--seconds", "0.01"),
    "versions.py": ("tried",),
}
SMALL = "help studies sizes tests-of catalogue docs-scene archive clean"
# targets of the make files, and what stands in their commands for the smallest size
SMALLER = {
    **{name: {} for name in SMALL.split()},
    "demo": {"--lumped 9": "--lumped 3 --elements 2"},
    "verify": {"verify": "verify --case patch"},
    "locking": {"--case locking-shell --case locking-solid ": ""},
    "tradeoff": {
        "3,5,7,9,17,33": "3,5",
        "consistent,consistent-interior,cauchy,uniform": "consistent",
        "2,3,4,8,12,16": "2,3",
        "2,4,8": "2",
        "--model mujoco:grid=5 --model mujoco:grid=9 --model mujoco:grid=17": "",
    },
    "bench": {
        "settling.py": "settling.py --duration 0.02",
        "statics.py": "statics.py --lattices 3 --shells 2 --batch 2",
        "shell.py": "shell.py --elements 2",
        "explicit_steps.py": "explicit_steps.py 3",
        " --first": "",
    },
    "animations": {"--duration 1 ": "--duration 0.02 ", "--duration 1.5": "--duration 0.02"},
    "pictures": {"docs/pictures.py": "docs/pictures.py one-edge-clamped"},
    "crosscheck": {
        "all docs/crosscheck/*.toml": "two-edges-clamped --lumped 3,5 --plate 2,3 --shell 2,3 --solid 2,3"
    },
    "coarse": {"auto,consistent,consistent-membrane": "consistent", "9,17": "5", "elements 16": "elements 2"},
    "transfer": {
        "transfer --out": "transfer --part modal --methods consistent --grids 5 --elements 2 --out",
        "-m slow tests/studies/test_transfer.py": "--version",
    },
    "promises": {"promises --out": "promises --part bars --scenes 1 --model plate --out"},
    "reproduce": {"reproduction --out": "reproduction --elements 4 --out"},
}
TESTED = "install test check nightly kernels slow ready lint fuzz kills"
FETCHING = "docs mutants viewer wheel-check extras-check release-check codes trials"
OF_ONE_SIZE = "central master-curves rubber stability standing suite"  # of some minutes
ELSEWHERE = set(f"{TESTED} {FETCHING} {OF_ONE_SIZE}".split())


def commands(target, folder=ROOT):
    """The commands of a target, but for those that fetch packages."""
    stamps = ".venv/installed", ".venv/testing", ".venv-peers/installed"
    variables = [f"BIN={Path(sys.executable).parent}", f"PYTHON={sys.executable}", "FILE=lumped/moduli.py"]
    asked = [
        "make",
        "--dry-run",
        "--no-print-directory",
        *(f"-o{stamp}" for stamp in stamps),
        *variables,
        target,
    ]
    done = subprocess.run(asked, cwd=folder, capture_output=True, text=True, check=True)
    return "\n".join(line for line in done.stdout.replace("\\\n", " ").splitlines() if " pip " not in line)


def test_every_target_and_benchmark_is_run_or_left_out_for_a_reason():
    text = "".join((ROOT / name).read_text(encoding="utf-8") for name in ("Makefile", "studies/Makefile"))
    phony = " ".join(re.findall(r"^\.PHONY:((?:.*\\\n)*.*)$", text, re.M)).replace("\\\n", " ").split()
    assert SMALLER.keys() | ELSEWHERE == set(phony) and not SMALLER.keys() & ELSEWHERE
    mains = {path.name for path in BENCHMARKS.glob("*.py") if "__main__" in path.read_text(encoding="utf-8")}
    assert set(re.findall(r"benchmarks/(\w+\.py)", commands("bench"))) | ALONE.keys() == mains


@pytest.mark.parametrize("target", sorted(SMALLER.keys() | ELSEWHERE))
def test_files_and_modules_of_a_target_exist(target):
    text = commands(target)
    for path in re.findall(r"(?<![\w/.-])[\w-]+(?:/[\w-]+)*\.(?:py|toml|txt)\b|\.ci/[\w-]+", text):
        assert (ROOT / path).exists(), path
    for module in re.findall(r"python -m ([\w.]+)", text):
        assert importlib.util.find_spec(module) or module in ("sphinx", "cosmic_ray"), module


@pytest.mark.nightly
@pytest.mark.parametrize("name", ALONE)
def test_a_benchmark_runs(name, tree):
    if name == "live.py" and not any(map(shutil.which, PROGRAMS)):
        pytest.skip("needs a browser: install the Debian package chromium")
    found = python(
        str(tree / "benchmarks" / name), *ALONE[name], PYTHONPATH=f"{tree}:{tree / 'tests/helpers'}"
    )
    assert found.returncode == 0 and found.stdout, found.stderr


@pytest.mark.nightly
@pytest.mark.parametrize("target", SMALLER)
def test_a_target_runs(target, tree):
    text = commands(target, tree)
    for said, less in SMALLER[target].items():
        assert said in text
        text = text.replace(said, less)
    if target == "pictures" and not any(map(shutil.which, PROGRAMS)):
        text = "\n".join(line for line in text.splitlines() if "page_pictures" not in line)
    bash = ["bash", "-euc", f"set -o pipefail\n{text}"]
    environment = os.environ | {"PYTHONPATH": str(tree)}
    found = subprocess.run(bash, cwd=tree, env=environment, capture_output=True, text=True, timeout=900)
    assert found.returncode == 0, found.stdout + found.stderr


@pytest.mark.nightly
@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_draws(path):
    assert len(NOTEBOOKS) >= 2
    notebook = nbformat.read(path, as_version=4)
    NotebookClient(notebook, timeout=600, kernel_name="python3").execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", ())]
    assert any("image/png" in output.get("data", {}) for output in outputs)


MODULES = [
    "comparisons.sweep.differences",
    "fem_reference",
    "fem_reference.linear_buckling",
    "fem_reference.vibration",
    "lumped.dynamics.integrators",
    "lumped.dynamics.runs.simulation",
    "lumped.fitting.identifiability",
    "lumped.fitting.methods",
    "lumped.statics.buckling",
    "lumped.statics.solver",
    "lumped.vibration",
    "sheetbench.face",
    "sheetbench.numerics.eigenmodes",
    "sheetbench.numerics.cache",
    "sheetbench.numerics.stability",
]


@pytest.mark.parametrize("name", MODULES)
def test_examples_run_as_written(name):
    found = doctest.testmod(importlib.import_module(name))
    assert found.attempted > 0 and found.failed == 0
