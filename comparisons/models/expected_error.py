"""How far a lattice will be from a converged shell, estimated from the same lattice on a finer grid.

With f the displacements at the scene's probes on the grid requested and g those on a finer one, whose cells
are 1/r as long, an error that falls with the square of the cells is

    e = max |f − g| / (1 − 1/r²) / max |g|

in the norm of `error` (largest component over the probes; Roache, J. Fluids Eng. 116 (1994) 405–413, with
the finer answer known). The finer grid has half as many cells again, and FINEST_COARSE or more along the
shorter side, where the error is not yet second order on coarser ones.

Chains are divided as the grid is (`lumped.actuators.division`), so that the finer lattice has the finer
chain.

It is the grid's error and no more: what differs on every grid, as the laws of strain do, it does not see. So
no estimate is given

- of calibrations whose answers do not tend to the sheet's, of a given k or layer distance, of linear answers;
- where either answer is no stable equilibrium, or one snapped and the other not;
- where the load bends the sheet within FOLD cells of the finer grid: both grids miss the fold, and agree;
- where the estimate is above FAR: the two may lie on different branches;
- where the sheet stretches so far that the laws of strain weigh more (LAW);
- where the finer lattice would have more than MOST masses in plan.

`sheetbench study promises` measures on a hundred scenes how good it is (docs/theory.md, section 6).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np

from comparisons.models.grids import scene_grid
from comparisons.models.layers import layers
from comparisons.models.spec import Lattice
from comparisons.pictures.plan import inside
from sheetbench.answers.solution import Solution, Status
from sheetbench.choices import EXTRAPOLATED
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.objects.grid import LAYERS, Grid

FINER = 1.5  # times as many cells
FINEST_COARSE = 12  # cells along the shorter side of the finer grid, at least
FOLD = 1.5  # cells of the finer grid in the layer that a load bends (`comparisons.models.layers`), at least
FAR = 0.5  # of the largest displacement
LAW = 0.2  # of the largest stretch, that the laws of strain may put lattice and shell apart
MOST = 5000  # masses in plan
LARGE = 0.02  # above which a note says how to lower it
ROUNDING = 1e-9  # of the largest displacement


@dataclass(frozen=True)
class ExpectedError:
    """value: a share, in the norm of `error`; grid: the finer one that it is estimated from, and its time."""

    value: float
    grid: Grid
    solve_seconds: float

    @property
    def reason(self) -> str:
        """What it is made from, in words."""
        masses = " × ".join(str(n) for n in self.grid[:2])
        return f"estimated from a second solve on {masses} masses, {1e3 * self.solve_seconds:.0f} ms"

    def __str__(self) -> str:
        lower = ": a finer --grid or --grading auto lowers it" if self.value > LARGE else ""
        return f"expected grid error about {few(100 * self.value)} %{lower} ({self.reason})"

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {**vars(self), "grid": list(self.grid), "reason": self.reason}


@dataclass(frozen=True)
class NoEstimate:
    """Why there is none."""

    reason: str

    def __str__(self) -> str:
        return f"no estimate of its grid error: {self.reason}."


def finer_grid(grid: Grid) -> Grid:
    """Return the grid whose answer the estimate compares with: 1.5 times as many cells, at least
    FINEST_COARSE."""
    cells = [n - 1 for n in grid[:2]]
    factor = max(FINER, FINEST_COARSE / min(cells))
    nx, ny = (int(np.ceil(factor * n - 1e-9)) + 1 for n in cells)
    return nx, ny, grid[2]


def converges(lattice: Lattice, finer: Grid) -> bool:
    """Return whether answers of a resolved lattice tend to the sheet's, and the finer grid is not too
    large."""
    own = lattice.k or lattice.layer_distance or lattice.linear
    known = lattice.calibration in EXTRAPOLATED and finer[2] == LAYERS
    return known and not own and prod(finer[:2]) <= MOST


def resolves(scene: Scene, grid: Grid) -> bool:
    """Return whether the layer in which the scene's load bends the sheet has FOLD cells of a grid or more."""
    cell = max(length / (n - 1) for length, n in zip(scene.sheet.lengths, grid[:2], strict=True))
    return all(layer.bent_edge or layer.width >= FOLD * cell for layer in layers(scene))


def finer_of(scene: Scene, lattice: Lattice) -> tuple[Grid, float] | NoEstimate:
    """Return the finer grid of a resolved lattice, and how many times as many cells in plan it has; or why
    there is no estimate."""
    grid = scene_grid(scene, lattice.grid)
    finer = finer_grid(grid)
    if converges(lattice, finer):
        return finer, prod(n - 1 for n in finer[:2]) / prod(n - 1 for n in grid[:2])
    if prod(finer[:2]) > MOST:
        return NoEstimate(f"{finer[0]} × {finer[1]} masses would be needed")
    return NoEstimate("these springs do not tend to the sheet on finer grids")


def expected_error(
    scene: Scene, lattice: Lattice, solution: Solution, solve: Callable[[Lattice], Solution | None]
) -> ExpectedError | NoEstimate:
    """Return the grid error to expect of a lattice's solution of a scene, or why none is given (see above).

    lattice: what was solved, resolved; solve: answers the finer lattice, None where that takes too much
    memory.
    """
    if solution.status is not Status.CONVERGED:
        return NoEstimate(f"the lattice is {solution.status}")
    found = finer_of(scene, lattice)
    if isinstance(found, NoEstimate):
        return found
    finer, ratio = found
    masses = f"{finer[0]} × {finer[1]}"
    if not resolves(scene, finer):
        return NoEstimate("the load bends the sheet within a cell or two, on a finer grid too")
    fine = solve(lattice.but(grid=finer))
    if fine is None:
        return NoEstimate(f"{masses} masses take too much memory")
    if fine.status is not Status.CONVERGED:
        return NoEstimate(f"on {masses} masses the lattice is {fine.status}")
    if len(fine.snaps) != len(solution.snaps):
        snaps = f"the sheet snaps {len(fine.snaps)} times, here {len(solution.snaps)}"
        return NoEstimate(f"on {masses} masses {snaps}")
    if other := ", ".join(sorted(fine.touched ^ solution.touched)):
        return NoEstimate(f"{other}: touched here or on {masses} masses alone")
    points = scene.probe_points()
    stretch = largest_stretch(scene, fine, finer)
    value = grid_error(solution.displacement(points), fine.displacement(points), ratio, stretch)
    if isinstance(value, str):
        return NoEstimate(f"displacements on {masses} masses {value}")
    return ExpectedError(value, finer, fine.solve_seconds)


def grid_error(coarse: np.ndarray, fine: np.ndarray, ratio: float, stretch: float = 0.0) -> float | str:
    """Return e of displacements (n, 3), or of other values, on grids with `ratio` times as many cells in plan
    on the finer; or why there is none, as the end of a sentence: they are alike but for rounding, too far
    apart, or `stretch` makes the laws of strain weigh more."""
    size, difference = float(np.max(np.abs(fine))), float(np.max(np.abs(coarse - fine)))
    if not difference > ROUNDING * size:
        return "are the same but for rounding"
    value = difference / (1.0 - 1.0 / ratio) / size
    if LAW * stretch < value < FAR:
        return value
    too_far = "too much to extrapolate from"
    why = too_far if value >= FAR else "less than the law of strain may change them at this stretch"
    return f"differ by {few(100.0 * difference / size)} %, {why}"


def largest_stretch(scene: Scene, solution: Solution, grid: Grid) -> float:
    """Return the largest elongation of the mid-surface between neighbours on a lattice's grid, along its
    lines and diagonals."""
    lines = [np.linspace(0.0, a, n) for a, n in zip(scene.sheet.lengths, grid[:2], strict=True)]
    flat = np.stack([*np.meshgrid(*lines, indexing="ij"), np.zeros([len(line) for line in lines])], axis=-1)
    plan = flat[..., :2].reshape(-1, 2)
    there, moved = inside(scene, plan), np.full_like(flat, np.nan)
    moved.reshape(-1, 3)[there] = flat.reshape(-1, 3)[there] + solution.displacement(plan[there])
    on, to, all_ = slice(1, None), slice(None, -1), slice(None)
    ways = [((on, all_), (to, all_)), ((all_, on), (all_, to)), ((on, on), (to, to)), ((on, to), (to, on))]
    found = []
    for one, other in ways:
        rest, now = (np.linalg.norm(at[one] - at[other], axis=-1) for at in (flat, moved))
        found.append(float(np.nanmax(now / rest)) - 1.0)
    return max(found)
