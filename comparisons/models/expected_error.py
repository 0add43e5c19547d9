"""Expected grid error of a lattice, estimated from a second solve on a finer grid, without a shell.

Let f be the displacements at the scene's probes on the requested grid and g the displacements on a finer
grid with cells 1/r as long. An error proportional to the square of the cell length is

    e = max |f − g| / (1 − 1/r²) / max |g|

in the norm of `error` (largest component over the probes; Roache, J. Fluids Eng. 116 (1994) 405–413, in the
form for a known finer answer). The finer grid has half as many cells again, and at least FINEST_COARSE along
the shorter side, because the error is not yet second order on coarser grids.

Over a plane e = max |f − g| / max |g|: errors swing there with the places of the masses that touch.

A chain has about as many parts as the grid has cells (`lumped.actuators.division`), whole numbers of each
segment; the finer grid has so many cells that the chain is divided FINER as well, up to MOST_PARTS.

The estimate covers the grid error alone; differences that remain on every grid, as between laws of strain,
are not in it. No estimate is given

- for calibrations whose answers do not converge to the sheet's, a given k or layer distance, linear answers;
- if either answer is no stable equilibrium, or only one of them snapped;
- if the load bends the sheet within CELLS cells of the finer grid: both grids miss the fold, and agree;
- if points hold each other in the sheet's plane: the lattice has no limit there, nor has the sheet;
- if a ball touches on less than a cell of the finer grid: the error depends on where in a cell it is;
- if the estimate is above FAR: the answers may lie on different branches;
- if the sheet stretches so far that the laws of strain differ by more (LAW);
- if the finer lattice would have more than MOST masses in plan.

`sheetbench study promises` measures its accuracy on a hundred scenes (docs/theory.md, section 6).
"""

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
from sheetbench.scenes import EDGES, Chain, Scene
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.objects.grid import LAYERS, Grid
from sheetbench.scenes.objects.obstacles import Box, Plane, Sphere
from sheetbench.scenes.objects.supports import points_overconstrain

FINER = 1.5  # ratio of cells
FINEST_COARSE = 12  # cells along the shorter side of the finer grid, at least
CELLS = 1.5  # cells of the finer grid in the layer that a load bends (`comparisons.models.layers`), at least
FAR = 0.5  # of the largest displacement
LAW = 0.2  # of the largest stretch: difference of lattice and shell due to their laws of strain
MOST = 5000  # masses in plan
LARGE = 0.02  # estimates above it get advice on how to lower them
ROUNDING = 1e-9  # of the largest displacement
PINNED = "point supports over-constrain the sheet's plane: their displacement diverges on finer grids"


@dataclass(frozen=True)
class ExpectedError:
    """An estimated grid error. value: fraction of the largest displacement, in the norm of `error`; grid,
    solve_seconds: the finer grid and its solve time."""

    value: float
    grid: Grid
    solve_seconds: float

    @property
    def reason(self) -> str:
        """The origin of the estimate in words."""
        masses = " × ".join(str(n) for n in self.grid[:2])
        return f"estimated from a second solve on {masses} masses, {1e3 * self.solve_seconds:.0f} ms"

    def __str__(self) -> str:
        lower = ": a finer --grid or --grading auto lowers it" if self.value > LARGE else ""
        return f"expected grid error about {few(100 * self.value)} %{lower} ({self.reason})"

    def as_dict(self) -> dict[str, Any]:
        """Return plain data for JSON."""
        return {**vars(self), "grid": list(self.grid), "reason": self.reason}


@dataclass(frozen=True)
class NoEstimate:
    """The reason why no estimate is given."""

    reason: str

    def __str__(self) -> str:
        return f"no estimate of its grid error: {self.reason}."


def finer_grid(grid: Grid, scene: Scene | None = None) -> Grid:
    """Return the finer grid of the estimate: FINER times as many cells, at least FINEST_COARSE, and as many
    as divide the scene's chains FINER."""
    cells = [n - 1 for n in grid[:2]]
    factor = max(FINER, FINEST_COARSE / min(cells))
    for chain in scene.actuators if scene else ():
        if isinstance(chain, Chain):
            from lumped import refining_cells

            along = cells[EDGES[chain.edge].along_axis]
            factor = max(factor, refining_cells(chain, along, FINER) / along)
    nx, ny = (int(np.ceil(factor * n - 1e-9)) + 1 for n in cells)
    return nx, ny, grid[2]


def converges(lattice: Lattice, finer: Grid) -> bool:
    """Return whether a lattice converges to the sheet and its finer grid has at most MOST masses."""
    modified = lattice.k or lattice.layer_distance or lattice.linear
    convergent = lattice.calibration in EXTRAPOLATED and finer[2] == LAYERS
    return convergent and not modified and prod(finer[:2]) <= MOST


def resolves(scene: Scene, grid: Grid) -> bool:
    """Return whether the boundary layer of the scene's load spans at least CELLS cells of a grid."""
    cell = max(length / (n - 1) for length, n in zip(scene.sheet.lengths, grid[:2], strict=True))
    return all(layer.bent_edge or layer.width >= CELLS * cell for layer in layers(scene))


def finer_of(scene: Scene, lattice: Lattice) -> tuple[Grid, float] | NoEstimate:
    """Return a lattice's finer grid and its ratio of cells in plan, or the reason for no estimate."""
    grid = scene_grid(scene, lattice.grid)
    finer = finer_grid(grid, scene)
    if converges(lattice, finer):
        return finer, ratio_of(scene, grid, finer)
    if prod(finer[:2]) > MOST:
        return NoEstimate(f"{finer[0]} × {finer[1]} masses would be needed")
    return NoEstimate("answers of these springs do not converge to the sheet's on finer grids")


def ratio_of(scene: Scene, grid: Grid, finer: Grid) -> float:
    """Return the number of cells in plan of a finer grid over a grid's; infinite over planes, where errors
    swing with the places of the masses that touch, and the finer answer stands for the limit."""
    if any(isinstance(obstacle, Plane) for obstacle in scene.obstacles):
        return np.inf
    return prod(n - 1 for n in finer[:2]) / prod(n - 1 for n in grid[:2])


def touched_around_points(scene: Scene, solution: Solution, grid: Grid) -> list[str]:
    """Return the names of the balls and boxes that a solution touches on less than a cell of a grid."""
    cell = np.prod([length / (n - 1) for length, n in zip(scene.sheet.lengths, grid[:2], strict=True)])
    bodies, states = scene.named_obstacles(), solution.contacts.items()
    return [name for name, one in states if 0.0 < one.area < cell and isinstance(bodies[name], Sphere | Box)]


def expected_error(
    scene: Scene, lattice: Lattice, solution: Solution, solve: Callable[[Lattice], Solution | None]
) -> ExpectedError | NoEstimate:
    """Return the expected grid error of a lattice's solution, or the reason for no estimate. lattice: the
    resolved lattice; solve: solves the finer lattice, None if it needs too much memory."""
    if solution.status is not Status.CONVERGED:
        return NoEstimate(f"the lattice is {solution.status}")
    if points_overconstrain(scene.supports, bool(scene.actuators)):
        return NoEstimate(PINNED)
    refinement = finer_of(scene, lattice)
    if isinstance(refinement, NoEstimate):
        return refinement
    finer, ratio = refinement
    masses = f"{finer[0]} × {finer[1]}"
    if not resolves(scene, finer):
        return NoEstimate("the load bends the sheet within a cell or two, on a finer grid too")
    if around := ", ".join(touched_around_points(scene, solution, finer)):
        return NoEstimate(f"{around}: touched within a cell of {masses} masses, and errors depend on where")
    fine = solve(lattice.but(grid=finer))
    if fine is None:
        return NoEstimate(f"{masses} masses take too much memory")
    if fine.status is not Status.CONVERGED:
        return NoEstimate(f"on {masses} masses the lattice is {fine.status}")
    if len(fine.snaps) != len(solution.snaps):
        snaps = f"the sheet snaps {len(fine.snaps)} times, on the given grid {len(solution.snaps)}"
        return NoEstimate(f"on {masses} masses {snaps}")
    if touched_once := ", ".join(sorted(fine.touched ^ solution.touched)):
        return NoEstimate(f"{touched_once}: touched on only one of the given grid and {masses} masses")
    points = scene.probe_points()
    stretch = largest_stretch(scene, fine, finer)
    value = grid_error(solution.displacement(points), fine.displacement(points), ratio, stretch)
    if isinstance(value, str):
        return NoEstimate(f"displacements on {masses} masses {value}")
    return ExpectedError(value, finer, fine.solve_seconds)


def grid_error(coarse: np.ndarray, fine: np.ndarray, ratio: float, stretch: float = 0.0) -> float | str:
    """Return the grid error e of displacements (n, 3) or other values, or a clause why there is none.

    ratio: number of cells in plan of the finer grid over the coarser one; stretch: largest elongation. No
    estimate is given for values that differ by rounding alone, by too much, or by less than the laws of
    strain may differ.
    """
    size, difference = float(np.max(np.abs(fine))), float(np.max(np.abs(coarse - fine)))
    if not difference > ROUNDING * size:
        return "are equal but for rounding"
    value = difference / (1.0 - 1.0 / ratio) / size
    if LAW * stretch < value < FAR:
        return value
    too_far = "too much to extrapolate from"
    why = too_far if value >= FAR else "less than the law of strain may change them at this stretch"
    return f"differ by {few(100.0 * difference / size)} %, {why}"


def largest_stretch(scene: Scene, solution: Solution, grid: Grid) -> float:
    """Return the largest elongation of the mid-surface between neighbours on a lattice's grid."""
    lines = [np.linspace(0.0, a, n) for a, n in zip(scene.sheet.lengths, grid[:2], strict=True)]
    flat = np.stack([*np.meshgrid(*lines, indexing="ij"), np.zeros([len(line) for line in lines])], axis=-1)
    plan = flat[..., :2].reshape(-1, 2)
    on_sheet, deformed = inside(scene, plan), np.full_like(flat, np.nan)
    deformed.reshape(-1, 3)[on_sheet] = flat.reshape(-1, 3)[on_sheet] + solution.displacement(plan[on_sheet])
    up, low, every = slice(1, None), slice(None, -1), slice(None)
    neighbours = [
        ((up, every), (low, every)),
        ((every, up), (every, low)),
        ((up, up), (low, low)),
        ((up, low), (low, up)),
    ]
    elongations = []
    for first, second in neighbours:
        rest, length = (np.linalg.norm(at[first] - at[second], axis=-1) for at in (flat, deformed))
        elongations.append(float(np.nanmax(length / rest)) - 1.0)
    return max(elongations)
