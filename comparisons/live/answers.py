"""What lattice and shell answer to a question of the page: where the sheet is, how far off, and in what time.

Both are solved as `sheetbench compare` solves them, without error bars. The shell is sampled at the lattice's
masses and on a regular grid for the picture. The error is that of `comparisons.comparison`, at the probes.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from comparisons.calibration.answer import to_toml as springs_to_toml
from comparisons.live.panel import Question
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from comparisons.pages.sheets import packed, viewer_sheet
from comparisons.pictures.plan import on_sheet, plan_mesh
from comparisons.sweep.differences import error
from sheetbench.answers.files import plain
from sheetbench.answers.solution import FieldMesh, Solution
from sheetbench.scenes import Scene
from sheetbench.scenes.language.toml import to_toml

SHELL_CELLS = 24  # along the shorter side, of the picture of the shell
DIFFERENCE = {"name": "difference", "label": "Difference from the shell", "unit": "mm", "scale": 1e3}
KEPT = ("label", "status", "advice", "load_factor", "unknowns", "settings", "probes")  # of a solution


def solved(scene: Scene, question: Question) -> Solution:
    """Return the lattice's solution. Raises BadInput for what is contradictory, as do the others here."""
    return solve(resolve(scene, question.lattice))


def lattice(scene: Scene, question: Question) -> dict[str, Any]:
    """Return the lattice's message."""
    solution = solved(scene, question)
    flat = {**DIFFERENCE, "kind": "difference", "values": packed(np.zeros(len(solution.mesh.points)))}
    return _message(question, scene, solution, "lattice", solution.mesh, flat)


def shell(scene: Scene, question: Question) -> dict[str, Any]:
    """Return the shell's message, with what the lattice differs by: `error` (a fraction, null where it has no
    meaning), and `difference` [m] at the masses, of those beyond a rim at the nearest point of the sheet."""
    beside = solved(scene, question)
    solution = solve(resolve(scene, Elements("shell", int(question.values["elements"]))))
    plan, probes = plan_mesh(scene, SHELL_CELLS), scene.probe_points()
    u = solution.displacement(plan.points[:, :2])
    mesh = FieldMesh(plan.points, plan.cells, {"displacement": u})
    places = on_sheet(scene, beside.mesh.points[:, :2])
    off = np.linalg.norm(beside.displacement(places) - solution.displacement(places), axis=1)
    known = beside.comparable and solution.comparable
    return {
        **_message(question, scene, solution, "shell", mesh),
        "error": error(beside.displacement(probes), solution.displacement(probes)) if known else None,
        "difference": packed(np.nan_to_num(off)),
    }


def text(scene: Scene, question: Question) -> dict[str, Any]:
    """Return what is to be copied, as TOML: the lattice's [springs], or the scene."""
    if question.copied == "scene":
        return {"text": to_toml(scene)}
    return {"text": springs_to_toml(resolve(scene, question.lattice, "springs").springs)}


def _message(
    question: Question, scene: Scene, solution: Solution, model: str, mesh: FieldMesh, *fields: dict[str, Any]
) -> dict[str, Any]:
    known = plain(solution.document(scene))
    said = solution.message or ("" if solution.comparable else solution.status.advice)
    sheet = viewer_sheet(model, mesh, model.capitalize(), [*fields], scene)
    found = {"number": question.number, "said": said, "seconds": solution.solve_seconds, "sheet": sheet}
    return found | {name: known[name] for name in KEPT}
