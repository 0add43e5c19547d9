"""What lattice and shell answer to a question of the page: where the sheet is, how far off, and in what time.

The lattice is solved as `sheetbench compare` solves it, or from an equilibrium close by. The shell is sampled
at the lattice's masses and on a regular grid for the picture; its error bar is not sought, so that it keeps
up. The error is that of `comparisons.comparison`, at the scene's probes, of both for the same question.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from comparisons.live.panel import Question
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from comparisons.pages.sheets import packed, viewer_sheet
from comparisons.pictures.plan import on_sheet, plan_mesh
from comparisons.sweep.differences import error
from sheetbench.answers.files import plain
from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.scenes import Scene

SAME = 1e-6  # of the largest displacement: what two answers of one equilibrium may differ by
SHELL_CELLS = 24  # along the shorter side, of the picture of the shell
DIFFERENCE = {"name": "difference", "label": "Difference from the shell", "unit": "mm", "scale": 1e3}
KEPT = ("label", "status", "advice", "load_factor", "unknowns", "settings", "probes")  # of a solution


@dataclass(frozen=True)
class Answered:
    """The lattice's answer to a question."""

    question: Question
    scene: Scene
    solution: Solution

    @cached_property
    def moved(self) -> np.ndarray:
        """Displacement of the masses, (n, 3) [m]."""
        return np.asarray(self.solution.mesh.point_data["displacement"])

    def near(self, question: Question) -> np.ndarray | None:
        """Return where another question's equilibrium can be sought, None where it cannot from here."""
        same = self.question.lattice == question.lattice and not self.scene.actuators
        return self.moved if same and self.solution.status is Status.CONVERGED else None

    def agrees(self, other: Answered) -> bool:
        """Return whether two answers to a question are one equilibrium."""
        difference = np.abs(self.moved - other.moved).max(initial=0.0)
        return bool(difference <= SAME * np.abs(other.moved).max(initial=0.0))

    def document(self) -> dict[str, Any]:
        """Return the message to the page."""
        mesh = self.solution.mesh
        flat = {**DIFFERENCE, "kind": "difference", "values": packed(np.zeros(len(mesh.points)))}
        sheet = viewer_sheet("lattice", mesh, "Lattice", [flat], self.scene)
        return _document(self.question, self.scene, self.solution, sheet)

    def places(self) -> tuple[np.ndarray, np.ndarray, np.ndarray | None]:
        """Return the plan points (n, 2) [m] of the masses, of those beyond a rim the nearest of the sheet,
        the displacements (n, 3) [m] there, and those at the probes where they may be compared."""
        points, of = on_sheet(self.scene, self.solution.mesh.points[:, :2]), self.solution.displacement
        return points, of(points), of(self.scene.probe_points()) if self.solution.comparable else None


def lattice(scene: Scene, question: Question, last: Answered | None = None) -> Answered:
    """Return the lattice's answer, sought from the last one's equilibrium where that is of the same grid: in
    a third of the time. Raises BadInput for what is contradictory."""
    import lumped

    near = None if last is None else last.near(question)
    return Answered(question, scene, lumped.solve(scene, resolve(scene, question.lattice).springs, near=near))


def shell(
    scene: Scene, question: Question, points: np.ndarray, moved: np.ndarray, probes: np.ndarray | None
) -> dict[str, Any]:
    """Return the shell's message, with what the lattice differs by (`Answered.places`): `error` (a fraction,
    null where it has no meaning), and `difference` [m] at the masses. Raises BadInput as the lattice's."""
    solution = solve(resolve(scene, Elements("shell", question.elements)))
    plan = plan_mesh(scene, SHELL_CELLS)
    u = solution.displacement(plan.points[:, :2])
    mesh = FieldMesh(plan.points, plan.cells, {"displacement": u})
    sheet = viewer_sheet("shell", mesh, "Shell", scene=scene)
    off = np.linalg.norm(moved - solution.displacement(points), axis=1)
    truth = solution.displacement(scene.probe_points()) if solution.comparable else None
    return {
        **_document(question, scene, solution, sheet),
        "error": None if probes is None or truth is None else error(probes, truth),
        "difference": packed(np.nan_to_num(off)),
    }


def _document(question: Question, scene: Scene, solution: Solution, sheet: Any) -> dict[str, Any]:
    known = plain(solution.document(scene))
    message = solution.message or ("" if solution.comparable else solution.status.advice)
    found = {"number": question.number, "said": message, "seconds": solution.solve_seconds, "sheet": sheet}
    return found | {name: known[name] for name in KEPT}
