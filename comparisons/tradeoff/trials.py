"""Trial solves of a scene, for predictions of every model's error and time on this machine.

The reference is the shell on three meshes, with the grid convergence index as its error bar; it is refined
only while a decision depends on it. Times are measured on warm code; the time of a model that was not solved
follows t = c N^p through the two solved models nearest in unknowns.
"""

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
from comparisons.sweep.in_process import LocalSolve, solve_in_process
from comparisons.sweep.limits import limit
from comparisons.sweep.model_error import ModelError, model_error
from sheetbench.choices import CALIBRATION
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.grid import near_square

MESHES = (4, 6, 8, 12, 16, 24, 32)  # elements along the shorter side
FIRST = 3  # number of meshes that are always solved
CELLS = {"lumped": (2, 4, 6, 8, 12, 16, 24, 32), "plate": (2, 4, 8), "shell": (2, 3, 4, 6, 8, 12, 16, 24)}
UNKNOWNS = {"lumped": 6.0, "plate": 20.0, "shell": 20.0}  # per cell or element
EXPONENT = 1.1  # of time in unknowns, for a series with one solve
REPEATS = 3


class TrialSolves:
    """The trial solves of a scene so far, one per model."""

    def __init__(
        self,
        scene: Scene,
        lattice: Lattice = Lattice(),  # noqa: B008  # frozen
        models: Sequence[str] | None = None,
    ) -> None:
        """Prepare trials; lattice: springs and grading of all lattices; models: names of the candidates, by
        default all. Raises BadInput for a grid, for invalid or contradictory springs and grading, and if the
        first references need too much memory; larger models are just left out."""
        if lattice.grid is not None:
            raise BadInput(f"grid = {counted(lattice.grid)}: is chosen by the trials; leave it out")
        for name in models or ():
            require_choice("models", name, CELLS)
        self.scene, self.models, self.springs = scene, models, lattice
        self.scales = scales(scene)
        self.rows: dict[Spec, LocalSolve] = {}
        self.refused: dict[Spec, str] = {}  # with the reason
        self.meshes: list[int] = []
        self.seconds = 0.0  # of all solves
        require_room(scene, self.elements("shell", MESHES[FIRST - 1]), instead="no coarser trial exists")

    def lattice(self, cells: int, linear: bool = False) -> Lattice:
        """Return a lattice with `cells` along the shorter side; linear: with default springs."""
        nx, ny = near_square(self.scene.sheet, cells)
        grid = (nx + 1, ny + 1, 2)
        if linear:
            return Lattice(grid, CALIBRATION, linear=True)
        spec = self.resolved(self.springs.but(grid=grid)).spec
        return spec.but(grading=fixed(spec.grading) or None)

    def resolved(self, lattice: Lattice) -> Resolved[Lattice]:
        """Return a lattice with all choices made, without use of the scene's own [springs]."""
        return resolve(self.scene, lattice, "springs", scene_springs=False)

    def elements(self, kind: str, cells: int) -> Elements:
        """Return a reference with `cells` elements along the shorter side."""
        return Elements(kind, near_square(self.scene.sheet, cells))

    def candidates(self, linear: bool) -> list[Spec]:
        """Return the candidates that fit into memory; linear: include linear lattices and plates."""
        specs: list[Spec] = [self.lattice(n) for n in CELLS["lumped"]]
        specs += [self.elements("shell", n) for n in CELLS["shell"]]
        if linear:
            specs += [self.lattice(n, linear=True) for n in CELLS["lumped"]]
            specs += [self.elements("plate", n) for n in CELLS["plate"]]
        named = [spec for spec in specs if self.models is None or spec.model in self.models]
        return [spec for spec in named if has_room(self.scene, spec)]

    def row(self, candidate: Spec, repeats: int = REPEATS) -> LocalSolve:
        """Return the candidate's row, solved on the first request."""
        if candidate not in self.rows:
            start = perf_counter()
            with threadpool_limits(1):  # as in campaigns
                self.rows[candidate] = solve_in_process(resolve(self.scene, candidate), repeats=repeats)
            self.seconds += perf_counter() - start
        return self.rows[candidate]

    def try_row(self, candidate: Spec) -> LocalSolve | None:
        """Return the candidate's row, None if refused, as for a grid without a mass at a point."""
        try:
            return self.row(candidate)
        except BadInput as reason:
            self.refused[candidate] = str(reason)
            return None

    def refine(self) -> bool:
        """Solve the reference on its next mesh; return whether one was left that fits, and it converged."""
        if len(self.meshes) == len(MESHES):
            return False
        cells = MESHES[len(self.meshes)]
        if not has_room(self.scene, self.elements("shell", cells)):
            return False
        self.meshes.append(cells)
        return self.row(self.elements("shell", cells), repeats=1).stable

    @property
    def reference(self) -> LocalSolve:
        """The reference on its finest mesh so far."""
        return self.row(self.elements("shell", self.meshes[-1]))

    @property
    def uncertainty(self) -> float:
        """Error bar of the reference at the probes, a fraction."""
        finest = [self.row(self.elements("shell", cells)) for cells in self.meshes[:-4:-1]]
        bar = limit(finest) if all(row.stable for row in finest) else None
        return float("inf") if bar is None else bar.error

    @cached_property
    def model_error(self) -> ModelError | None:
        """Model error of the reference, independent of its mesh, from its present answer."""
        return model_error(self.scene, self.reference.answer)

    def error(self, row: LocalSolve) -> float:
        """Return the error of a row at the probes, infinite without a stable answer."""
        return (error(row.u, self.reference.u) or 0.0) if row.stable else float("inf")

    def field_error(self, row: LocalSolve) -> float | None:
        """Return the error of a row over the sheet, None without a stable answer."""
        return error(row.field, self.reference.field) if row.stable else None

    def predicted_seconds(self, candidate: Spec) -> float:
        """Return the time of a candidate [s]: as measured, or extrapolated from its series."""
        if candidate in self.rows:
            return self.rows[candidate].seconds
        size, series = unknowns(candidate), _time_series(candidate)
        rows = [row for spec, row in self.rows.items() if _time_series(spec) == series]
        points = [(unknowns(row.request.spec), row.seconds) for row in rows]
        if not points:
            return size * 1e-5
        points.sort(key=lambda point: abs(np.log(point[0] / size)))
        (near, seconds), exponent = points[0], EXPONENT
        others = [point for point in points[1:] if point[0] != near]
        if others:
            slope = np.log(seconds / others[0][1]) / np.log(near / others[0][0])
            exponent = float(np.clip(slope, 0.3, 1.6))
        return seconds * float(size / near) ** exponent


def _time_series(candidate: Spec) -> str:
    """Return the series of a candidate for its time, which does not depend on the grading."""
    return (candidate.but(grading=None) if isinstance(candidate, Lattice) else candidate).series


def unknowns(candidate: Spec) -> float:
    """Return the approximate number of unknowns of a candidate."""
    nx, ny = candidate.settings.get("elements") or [n - 1 for n in candidate.settings["grid"][:2]]
    return UNKNOWNS[candidate.model] * nx * ny
