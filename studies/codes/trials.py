"""Other codes with the numbers that people use and with ours: error and time of a scene, each in a process.

A recipe is a mesh and coefficients. `sheetbench study codes CODE=PYTHON` runs the recipes of a code with a
Python that has it, and writes results/codes/CODE.json. What crashes or takes too long costs its own row.
"""

from __future__ import annotations

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
    parameters of a scene; without either what `calibrate --for` gives."""

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


def run_trials(code: str, python: str, seconds: float, budget: float, say: Callable[[str], None]) -> None:
    """Run every recipe of a code in every scene, with a Python that has it, and write the file of results.

    seconds: of processor time, the limit of a run; budget: of the clock, after which no further run begins.
    A row of the file that had the same inputs stays, but for one that a shorter limit ended. SCENES come
    first, then statics before curves, ours before others, rows that are missing before changed ones, coarse
    meshes before fine ones, and last the scenes in which a run has come to the limit.
    """
    require_choice("code", code, RECIPES)
    if which(python) is None:
        raise BadInput(f"{code}={python}: no such program; `make trials` makes the environments")
    path, ends = RESULTS / f"{code}.json", perf_counter() + budget
    old = read_results(path).rows if path.exists() else ()
    rows = {(row.scene, row.recipe): row for row in old}
    late = {row.scene for row in rows.values() if row.status == Status.STEP_LIMIT}
    order = [(name, recipe) for name in CALIBRATED for recipe in RECIPES[code]]
    first = sorted(
        order,
        key=lambda one: (
            one[0] not in SCENES,
            one[0] in late,
            CASES[one[0]].suite == "curves",
            one[1] is not BEST,
            (one[0], one[1].name) in rows,
            one[1].squares,
        ),
    )
    for number, (name, recipe) in enumerate(first):
        if perf_counter() > ends:
            say(f"{code}: {budget:g} s have passed; {len(order) - number} of {len(order)} rows not looked at")
            break
        with TemporaryDirectory() as folder:
            made = _write_files(CASES[name], code, recipe, Path(folder))
            inputs = _checksum(Path(folder))
            if (known := rows.get((name, recipe.name))) and known.inputs == inputs and _final(known, seconds):
                continue
            found = _trial(made, recipe.name, python, seconds, Path(folder), inputs)
        say(f"{code}, {name}, {recipe.name}: {found.status}, {found.error}")
        rows[name, recipe.name] = found
        kept = [rows[name, recipe.name] for name, recipe in order if (name, recipe.name) in rows]
        # what is killed leaves what it has
        write_results(code, CODES[code].title, CODES[code].licence, kept, f"{code}=PYTHON")


def _write_files(case: Reference, code: str, recipe: Recipe, folder: Path) -> CodeSetup:
    scene, squares = case.scene, recipe.squares // (2 if case.suite == "curves" else 1)
    side = min(scene.sheet.lengths) / squares
    coefficients = recipe.coefficients and recipe.coefficients(scene, side)
    given = recipe.keys and recipe.keys(scene)
    made = setup(scene, code, squares, mesh=recipe.mesh, coefficients=coefficients, given=given)
    for name, write in made.files().items():
        write(folder / name)
    return made


def _checksum(folder: Path) -> str:
    """Of the files' text, numbers to six digits: another processor's last digits make no other inputs."""
    text = "".join(path.read_text(encoding="utf-8") for path in sorted(folder.iterdir()))
    return sha256(FLOAT.sub(lambda one: f"{float(one[0]):.6g}", text).encode()).hexdigest()[:12]


def _final(row: Trial, seconds: float) -> bool:
    """Whether a longer limit would not change it."""
    return row.status != Status.STEP_LIMIT or (row.seconds or 0.0) > 0.9 * seconds


def _trial(made: CodeSetup, recipe: str, python: str, seconds: float, folder: Path, inputs: str) -> Trial:
    script = str(folder / f"run_{made.code.name}.py")
    ended = run([python, script, str(seconds)], b"", 10.0 * seconds, variables=ONE_THREAD)
    about = made.scene.name, recipe, made.cell.name
    lines = [line for line in ended.answer.decode().splitlines() if line.startswith("{")]
    if ended.fault or not lines:
        return Trial(*about, "failed", None, None, ended.fault or "no answer", inputs)
    answer: dict[str, Any] = json.loads(lines[-1])
    moved = np.array([answer["probes"][probe] for probe in made.scene.probes])
    off = error(moved, CASES[made.scene.name].values) if answer["status"] == "converged" else None
    shown = [[float(f"{value:.6g}") for value in u] for u in moved.tolist()] if off is not None else None
    return Trial(*about, answer["status"], off, answer["solve_seconds"], "", inputs, shown)
