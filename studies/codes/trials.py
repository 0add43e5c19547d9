"""Other codes with numbers in use and with ours: error and time of a scene, each in a process.

A recipe is a mesh and coefficients. `sheetbench study codes CODE=PYTHON` runs the recipes of a code with a
Python that has it, and writes results/codes/CODE.json. A run that crashes or takes too long loses its own row
only.
"""

import json
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from shutil import which
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any

import numpy as np

from comparisons.codes.setup import CodeSetup, setup
from comparisons.codes.sheet_mesh import refusal
from comparisons.codes.table import CODES
from comparisons.scoring.reference import Reference
from comparisons.sweep.differences import error
from sheetbench.answers.solution import Status
from sheetbench.errors import BadInput, require_choice
from sheetbench.process import ONE_THREAD, run
from sheetbench.scenes import Scene
from studies.codes.results import CASES, OURS, RESULTS, SCENES, Trial, read_results, write_results

CALIBRATED = {name: case for name, case in CASES.items() if not refusal(case.scene)}
SQUARES, BETTER = 8, 16
MEAN_EDGE = (2.0 + 2.0**0.5) / 3.0  # of squares with diagonals, over their side
ONE = "one-diagonal"
FLOAT = re.compile(r"\d+\.\d+(?:e[-+]?\d+)?")


def _rigidity(scene: Scene) -> float:
    material = scene.material
    return material.young * scene.sheet.thickness**3 / 12.0 / (1.0 - material.poisson**2)


def _stretching(scene: Scene) -> float:
    return scene.material.young * scene.sheet.thickness


@dataclass(frozen=True)
class Recipe:
    """Numbers and a mesh for a code. coefficients: ours, of a scene and a square's side; keys: the code's own
    parameters of a scene; without either the numbers of `calibrate --for`."""

    name: str
    mesh: str | None = None
    coefficients: Callable[[Scene, float], Mapping[str, float]] | None = None
    keys: Callable[[Scene], Mapping[str, float]] | None = None
    squares: int = SQUARES


BEST = Recipe(OURS)
FINER = Recipe(f"ours, {BETTER} squares", squares=BETTER)
DIAGONAL = Recipe("ours, one diagonal", ONE)
RECIPES: Mapping[str, tuple[Recipe, ...]] = {
    "newton": (
        Recipe("its defaults", ONE, keys=lambda _: dict.fromkeys(("tri_ke", "tri_ka", "edge_ke"), 100.0)),
        Recipe("textbook: D/l", ONE, lambda scene, side: {"hinge": _rigidity(scene) / side}),
        Recipe(
            "GAUGE: D/mean edge",
            ONE,
            lambda scene, side: {"hinge": _rigidity(scene) / side / MEAN_EDGE},
        ),
        DIAGONAL,
        BEST,
        FINER,
    ),
    "mujoco": (
        Recipe("textbook: E, ν, h", ONE, lambda scene, _: {"hinge": _rigidity(scene) / 3.0}),
        DIAGONAL,
        BEST,
        FINER,
    ),
    "pybullet": (
        Recipe("its defaults", keys=lambda _: {"springElasticStiffness": 1.0}),
        Recipe(
            "textbook: k = E h",
            coefficients=lambda scene, _: {"k": _stretching(scene), "layers": scene.sheet.thickness},
        ),
        BEST,
        FINER,
    ),
    "genesis": (
        Recipe("its defaults", keys=lambda _: _genesis(1e-7, 1e-5)),
        Recipe("GAUGE: 1/K", keys=lambda scene: _genesis(1.0 / _stretching(scene), 1.0 / _rigidity(scene))),
        BEST,
        FINER,
    ),
}


def _genesis(stretch: float, bending: float) -> dict[str, float]:
    return {"own stretch_compliance": stretch, "own bending_compliance": bending}


def run_trials(code: str, python: str, seconds: float, budget: float, report: Callable[[str], None]) -> None:
    """Run every recipe of a code in every scene, with a Python that has it, and write the file of results.
    seconds: of processor time, the limit of a run; budget: of the clock, after which no further run begins. A
    row of the file with unchanged inputs stays, unless a shorter limit ended it. SCENES come first, then
    statics before curves, our numbers before others, missing rows before changed ones, coarse meshes before
    fine ones, and last the scenes in which a run has come to the limit."""
    require_choice("code", code, RECIPES)
    if which(python) is None:
        raise BadInput(f"{code}={python}: no such program; `make trials` makes the environments")
    path, ends = RESULTS / f"{code}.json", perf_counter() + budget
    old = read_results(path).rows if path.exists() else ()
    rows = {(row.scene, row.recipe): row for row in old}
    at_limit = {row.scene for row in rows.values() if row.status == Status.STEP_LIMIT}
    order = [(name, recipe) for name in CALIBRATED for recipe in RECIPES[code]]
    first = sorted(
        order,
        key=lambda pair: (
            pair[0] not in SCENES,
            pair[0] in at_limit,
            CASES[pair[0]].suite == "curves",
            pair[1] is not BEST,
            (pair[0], pair[1].name) in rows,
            pair[1].squares,
        ),
    )
    for number, (name, recipe) in enumerate(first):
        if perf_counter() > ends:
            report(f"{code}: {budget:g} s have passed; {len(order) - number} of {len(order)} rows left")
            break
        with TemporaryDirectory() as folder:
            case_files = _write_files(CASES[name], code, recipe, Path(folder))
            inputs = _checksum(Path(folder))
            old_row = rows.get((name, recipe.name))
            if old_row and old_row.inputs == inputs and _final(old_row, seconds):
                continue
            trial = _trial(case_files, recipe.name, python, seconds, Path(folder), inputs)
        report(f"{code}, {name}, {recipe.name}: {trial.status}, {trial.error}")
        rows[name, recipe.name] = trial
        finished = [rows[name, recipe.name] for name, recipe in order if (name, recipe.name) in rows]
        # an interrupted run leaves its finished rows
        write_results(code, CODES[code].title, CODES[code].licence, finished, f"{code}=PYTHON")


def _write_files(case: Reference, code: str, recipe: Recipe, folder: Path) -> CodeSetup:
    scene, squares = case.scene, recipe.squares // (2 if case.suite == "curves" else 1)
    side = min(scene.sheet.lengths) / squares
    coefficients = recipe.coefficients and recipe.coefficients(scene, side)
    parameters = recipe.keys and recipe.keys(scene)
    case_files = setup(scene, code, squares, mesh=recipe.mesh, coefficients=coefficients, given=parameters)
    for name, write in case_files.files().items():
        write(folder / name)
    return case_files


def _checksum(folder: Path) -> str:
    """Return the checksum of the files' text, numbers rounded to six digits. Last digits that depend on the
    processor do not change it."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(folder.iterdir()))
    return sha256(FLOAT.sub(lambda one: f"{float(one[0]):.6g}", text).encode()).hexdigest()[:12]


def _final(row: Trial, seconds: float) -> bool:
    """Return whether a row would stay as it is with a longer time limit."""
    return row.status != Status.STEP_LIMIT or (row.seconds or 0.0) > 0.9 * seconds


def _trial(files: CodeSetup, recipe: str, python: str, seconds: float, folder: Path, inputs: str) -> Trial:
    script = str(folder / f"run_{files.code.name}.py")
    ended = run([python, script, str(seconds)], b"", 10.0 * seconds, variables=ONE_THREAD)
    identity = files.scene.name, recipe, files.cell.name
    lines = [line for line in ended.answer.decode().splitlines() if line.startswith("{")]
    if ended.fault or not lines:
        return Trial(*identity, "failed", None, None, ended.fault or "no answer", inputs)
    answer: dict[str, Any] = json.loads(lines[-1])
    moved = np.array([answer["probes"][probe] for probe in files.scene.probes])
    miss = error(moved, CASES[files.scene.name].values) if answer["status"] == "converged" else None
    shown = [[float(f"{value:.6g}") for value in u] for u in moved.tolist()] if miss is not None else None
    return Trial(*identity, answer["status"], miss, answer["solve_seconds"], "", inputs, shown)
