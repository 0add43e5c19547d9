"""What lattice and shell answer to a question of the page: where the sheet is, how far off, and in what time.

The lattice is solved as `sheetbench compare` solves it, or from an equilibrium close by. The shell is sampled
at the lattice's masses and on a regular grid for the picture; its error bar is not sought, so that it keeps
up. The error is that of `comparisons.comparison`, at the scene's probes, of both for the same question.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.live.panel import Question
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements
from comparisons.pages.sheets import packed, viewer_sheet
from comparisons.pictures.plan import on_sheet, plan_mesh
from sheetbench.answers.files import plain
from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.scenes import Scene

SAME = 1e-6  # of the largest displacement: what two answers of one equilibrium may differ by
SHELL_CELLS = 24  # along the shorter side, of the picture of the shell
DIFFERENCE = {"name": "difference", "label": "Difference from the shell", "unit": "mm", "scale": 1e3}


@dataclass(frozen=True)
class Answered:
    """The lattice's answer to a question."""

    question: Question
    scene: Scene
    solution: Solution

    @property
    def displacement(self) -> np.ndarray:
        """Of the masses, (n, 3) [m]."""
        moved: np.ndarray = self.solution.mesh.point_data["displacement"]
        return moved

    def starts(self, question: Question) -> bool:
        """Return whether another question's equilibrium can be sought from this one's."""
        same = self.question.lattice == question.lattice
        return same and self.solution.status is Status.CONVERGED and not self.scene.actuators

    def agrees(self, other: Answered) -> bool:
        """Return whether two answers to a question are one equilibrium."""
        difference = np.abs(self.displacement - other.displacement).max(initial=0.0)
        return bool(difference <= SAME * np.abs(other.displacement).max(initial=0.0))

    @property
    def masses(self) -> np.ndarray:
        """Plan points (n, 2) [m] of the masses, of those beyond a rim the nearest of the sheet."""
        return on_sheet(self.scene, self.solution.mesh.points[:, :2])

    def document(self) -> dict[str, Any]:
        """Return the message to the page."""
        mesh = self.solution.mesh
        flat = {**DIFFERENCE, "kind": "difference", "values": packed(np.zeros(len(mesh.points)))}
        return {
            **_document(self.question, self.scene, self.solution),
            "sheet": viewer_sheet("lattice", mesh, "Lattice", [flat], self.scene),
        }


def lattice(scene: Scene, question: Question, last: Answered | None = None) -> Answered:
    """Return the lattice's answer, sought from the last one's equilibrium where that is of the same grid: in
    a third of the time. Raises BadInput for what is contradictory."""
    import lumped

    springs = resolve(scene, question.lattice).springs
    near = last.displacement if last is not None and last.starts(question) else None
    return Answered(question, scene, lumped.solve(scene, springs, near=near))


@dataclass(frozen=True)
class Sampled:
    """A shell's answer as it comes from its own process: message to the page, and what it is compared by.

    at_masses (n, 3), at_probes (p, 3) [m].
    """

    document: dict[str, Any]
    comparable: bool
    at_masses: np.ndarray
    at_probes: np.ndarray


def shell(scene: Scene, question: Question, masses: np.ndarray) -> Sampled:
    """Return the shell's answer, sampled at plan points of masses (n, 2) [m]. Raises BadInput as the
    lattice's."""
    solution = solve(resolve(scene, Elements("shell", question.elements)))
    found = _document(question, scene, solution)
    plan = plan_mesh(scene, SHELL_CELLS)
    u = solution.displacement(plan.points[:, :2])
    mesh = FieldMesh(plan.points, plan.cells, {"displacement": u})
    found["sheet"] = viewer_sheet("shell", mesh, "Shell", scene=scene)
    return Sampled(
        found, solution.comparable, solution.displacement(masses), solution.displacement(scene.probe_points())
    )


def compared(answered: Answered, sampled: Sampled) -> dict[str, Any]:
    """Return the shell's message, with what the lattice differs by: `error` (a fraction, null where it has no
    meaning), and `difference` [m] at the masses."""
    both = sampled.comparable and answered.solution.comparable
    ours = answered.solution.displacement(answered.scene.probe_points())
    off = answered.solution.displacement(answered.masses) - sampled.at_masses
    return {
        **sampled.document,
        "error": error(ours, sampled.at_probes) if both else None,
        "difference": packed(np.nan_to_num(np.linalg.norm(off, axis=1))),
    }


def _document(question: Question, scene: Scene, solution: Solution) -> dict[str, Any]:
    known = plain(solution.document(scene))
    kept = ("label", "status", "advice", "load_factor", "unknowns", "settings", "probes")
    message = solution.message or ("" if solution.comparable else solution.status.advice)
    found = {name: known[name] for name in kept}
    return {
        "number": question.number,
        "said": message,
        "seconds": solution.solve_seconds,
        **found,
    }
