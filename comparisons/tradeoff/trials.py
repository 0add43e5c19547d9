"""Trial solves of a scene that predict the error and the time of every model on this machine.

The reference is the shell on three meshes of rising fineness, its error bar the grid convergence index, made
finer only as long as a decision hangs on it. Times are this machine's, on warm code; those of models
that were not solved follow t = c N^p through the two solved ones nearest in unknowns.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from time import perf_counter

import numpy as np
from threadpoolctl import threadpool_limits

from comparisons.models.grading import fixed
from comparisons.models.resolve import Resolved, resolve
from comparisons.models.scales import scales
from comparisons.models.sizes import has_room, require_room
from comparisons.models.spec import Elements, Lattice, Spec, counted
from comparisons.sweep.differences import error
from comparisons.sweep.here import SolvedHere, here
from comparisons.sweep.limits import limit
from comparisons.sweep.model_error import ModelError, model_error
from sheetbench.choices import CALIBRATION
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grid import near_square

MESHES = (4, 6, 8, 12, 16, 24, 32)  # elements along the shorter side
FIRST = 3  # of them are always solved
CELLS = {"lumped": (2, 4, 6, 8, 12, 16, 24, 32), "plate": (2, 4, 8), "shell": (2, 3, 4, 6, 8, 12, 16, 24)}
UNKNOWNS = {"lumped": 6.0, "plate": 20.0, "shell": 20.0}  # a cell or element
EXPONENT = 1.1  # of time in unknowns, where one solve only is known
REPEATS = 3


class TrialSolves:
    """The rows of a scene so far, each solved once."""

    def __init__(
        self,
        scene: Scene,
        lattice: Lattice = Lattice(),  # noqa: B008  # frozen
        models: Sequence[str] | None = None,
    ) -> None:
        """lattice: springs and grading of all lattices; models: that may be chosen, all unless some are
        named. Raises BadInput for a grid, where springs and grading are none or contradict each other, and
        where the first references take too much memory; otherwise the larger models are left out."""
        if lattice.grid is not None:
            raise BadInput(f"grid = {counted(lattice.grid)}: is chosen here; leave it out")
        for name in models or ():
            require_choice("models", name, CELLS)
        self.scene, self.models, self.springs = scene, models, lattice
        self.scales = scales(scene)
        self.rows: dict[Spec, SolvedHere] = {}
        self.refused: dict[Spec, str] = {}  # and why
        self.meshes: list[int] = []
        self.seconds = 0.0  # of all solves
        require_room(scene, self.elements("shell", MESHES[FIRST - 1]), instead="advise has no coarser one")

    def lattice(self, cells: int, linear: bool = False) -> Lattice:
        """Return a lattice of that many cells along the shorter side; linear: of the usual springs."""
        nx, ny = near_square(self.scene.sheet, cells)
        grid = (nx + 1, ny + 1, 2)
        if linear:
            return Lattice(grid, CALIBRATION, linear=True)
        found = self.resolved(self.springs.but(grid=grid)).spec
        return found.but(grading=fixed(found.grading) or None)

    def resolved(self, lattice: Lattice) -> Resolved[Lattice]:
        """Return a lattice with its springs, the scene's own left aside, and the reasons for these."""
        return resolve(self.scene, lattice, "springs", own=False)

    def elements(self, kind: str, cells: int) -> Elements:
        """Return a reference of that many elements along the shorter side."""
        return Elements(kind, near_square(self.scene.sheet, cells))

    def candidates(self, linear: bool) -> list[Spec]:
        """Return what may be chosen: lattices and shells; the linear lattice and the plate where `linear`."""
        specs: list[Spec] = [self.lattice(n) for n in CELLS["lumped"]]
        specs += [self.elements("shell", n) for n in CELLS["shell"]]
        if linear:
            specs += [self.lattice(n, linear=True) for n in CELLS["lumped"]]
            specs += [self.elements("plate", n) for n in CELLS["plate"]]
        chosen = [one for one in specs if self.models is None or one.model in self.models]
        return [one for one in chosen if has_room(self.scene, one)]

    def row(self, candidate: Spec, repeats: int = REPEATS) -> SolvedHere:
        """Return the candidate's row; solved once, whoever wants it."""
        if candidate not in self.rows:
            began = perf_counter()
            with threadpool_limits(1):  # as campaigns measure
                self.rows[candidate] = here(resolve(self.scene, candidate), repeats=repeats)
            self.seconds += perf_counter() - began
        return self.rows[candidate]

    def tried(self, candidate: Spec) -> SolvedHere | None:
        """Return the candidate's row, None where it is refused: a grid without a mass at a point."""
        try:
            return self.row(candidate)
        except BadInput as reason:
            self.refused[candidate] = str(reason)
            return None

    def refine(self) -> bool:
        """Solve the reference on its next mesh; return whether there was one with room, and it converged."""
        if len(self.meshes) == len(MESHES):
            return False
        cells = MESHES[len(self.meshes)]
        if not has_room(self.scene, self.elements("shell", cells)):
            return False
        self.meshes.append(cells)
        return self.row(self.elements("shell", cells), repeats=1).stable

    @property
    def reference(self) -> SolvedHere:
        """The reference on its finest mesh so far."""
        return self.row(self.elements("shell", self.meshes[-1]))

    @property
    def uncertainty(self) -> float:
        """Error bar of the reference, in the design's measure of error."""
        finest = [self.row(self.elements("shell", cells)) for cells in self.meshes[:-4:-1]]
        bar = limit(finest) if all(row.stable for row in finest) else None
        return float("inf") if bar is None else bar.error

    @cached_property
    def model_error(self) -> ModelError | None:
        """What the reference leaves out of the sheet on every mesh, by its present answer."""
        return model_error(self.scene, self.reference.answer)

    def error(self, row: SolvedHere) -> float:
        """Error of a row against the reference; infinite for an answer that is none."""
        return (error(row.u, self.reference.u) or 0.0) if row.stable else float("inf")

    def field_error(self, row: SolvedHere) -> float | None:
        """Error of a row over the sheet; None for an answer that is none."""
        return error(row.field, self.reference.field) if row.stable else None

    def predicted_seconds(self, candidate: Spec) -> float:
        """Time of a candidate: as measured, or by the rates of its family."""
        if candidate in self.rows:
            return self.rows[candidate].seconds
        size = unknowns(candidate)
        alike = [row for one, row in self.rows.items() if _rate(one) == _rate(candidate)]
        family = [(unknowns(row.ask.spec), row.seconds) for row in alike]
        if not family:
            return size * 1e-5
        family.sort(key=lambda one: abs(np.log(one[0] / size)))
        (near, seconds), exponent = family[0], EXPONENT
        others = [one for one in family[1:] if one[0] != near]
        if others:
            slope = np.log(seconds / others[0][1]) / np.log(near / others[0][0])
            exponent = float(np.clip(slope, 0.3, 1.6))
        return seconds * float(size / near) ** exponent


def _rate(candidate: Spec) -> str:
    """Return what stays the same in time as the grid is refined: graded cells take no longer than even
    ones."""
    return (candidate.but(grading=None) if isinstance(candidate, Lattice) else candidate).series


def unknowns(candidate: Spec) -> float:
    """Unknowns of a candidate, about."""
    nx, ny = candidate.settings.get("elements") or [n - 1 for n in candidate.settings["grid"][:2]]
    return UNKNOWNS[candidate.model] * nx * ny
