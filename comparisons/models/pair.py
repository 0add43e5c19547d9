"""Two lattices of a scene, one coarser than the other, and one answer extrapolated from both, with a bar.

A consistent lattice's error falls with the size l of its cells as a l² − b l³. From answers f on the finer
and g on the coarser grid, of r times as long cells, the same springs and the same grading,

    extrapolated  f + d,   d = (f − g)/(r² − 1)
    bar           2 |d| + s (l/L)² max |f|,   s = 0.2, L the shorter side

are the sheet's but for the third order. The first part reaches as far as the index of two grids does about f
(3 |d|, Roache 1994); the second is what a pair cannot see, a difference that is small because a l² and b l³
cancel in it. s was set on every other case of the reference set, and held on the rest (docs/theory.md).
Forces, energies and what they leave over are extrapolated alike. Where one of the two is no equilibrium, or
they end differently, the finer one stands alone.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import prod
from typing import Any

import numpy as np

from comparisons.models.grading import Grading
from comparisons.models.grids import GridLike, scene_grid
from comparisons.models.lattice import Solve, Watch, lattice, require_known
from comparisons.models.springs import LatticeSpec, resolve
from sheetbench.choices import EXTRAPOLATED, listed
from sheetbench.errors import BadInput
from sheetbench.scenes import FieldMesh, Scene, Solution
from sheetbench.scenes.balance import Balance
from sheetbench.scenes.grid import Grid

ORDER, REACH, UNSEEN = 2.0, 2.0, 0.2
Field = Callable[[np.ndarray], np.ndarray]  # plan points (n, 2) [m] → (n, 3) [m]


def lattice_pair(
    scene: Scene,
    *,
    grid: GridLike = None,
    coarser: GridLike = None,
    calibration: str | None = None,
    layer_distance: float | None = None,
    grading: Grading = None,
    linear: bool = False,
    symmetry: bool = False,
) -> Solve:
    """Both lattices, ready to be solved one after the other.

    coarser: the other grid, of half as many cells unless given. grading: of both; "auto" looks at the finer.
    """
    fine, coarse = grids(scene, grid, coarser)
    spec = LatticeSpec(fine, calibration, None, layer_distance, grading)
    found = resolve(scene, spec, own=False)
    own: dict[str, Any] = {"calibration": found.calibration, "grading": found.grading}
    own |= {"layer_distance": layer_distance, "linear": linear, "symmetry": symmetry}
    ready = [lattice(scene, grid=shape, **own) for shape in (coarse, fine)]

    def solve(watch: Watch | None) -> Solution:
        rough, near = (answer(watch) for answer in ready)
        return extrapolated(rough, replace(near, settings={**near.settings, **found.reasons}))

    return solve


def grids(scene: Scene, grid: GridLike, coarser: GridLike) -> tuple[Grid, Grid]:
    """The finer and the coarser grid. Raises BadInput where the second is not the coarser."""
    fine = scene_grid(scene, grid)
    halved = tuple(max(2, (n - 1) // 2 + 1) for n in fine[:2])
    coarse = scene_grid(scene, (*halved, fine[2]) if coarser is None else coarser)
    if min(coarse) < 2 or coarse[0] >= fine[0] or coarse[1] >= fine[1] or coarse[2] != fine[2]:
        raise BadInput(
            f"lumped-pair: {size(coarse)} beside {size(fine)}: the coarser grid has fewer masses along both "
            "sides, at least 2, and as many layers; write 5:9"
        )
    return fine, coarse


def size(grid: Sequence[int]) -> str:
    """A grid as people write it."""
    return "×".join(str(n) for n in grid)


def check_pair(scene: Scene, settings: Mapping[str, Any]) -> None:
    """Raise BadInput for settings of a pair that it does not have or cannot use on this scene."""
    require_known("lumped-pair", settings, lattice_pair)
    fine, _ = grids(scene, settings.get("grid"), settings.get("coarser"))
    method = resolve(scene, LatticeSpec.of({**settings, "grid": fine})).calibration
    if method is None:
        raise BadInput("lumped-pair: the scene's [springs] are of one grid; name a calibration")
    if method not in EXTRAPOLATED:
        raise BadInput(
            f"lumped-pair: with the calibration {method} answers need not tend to the sheet's as cells "
            f"shrink; choose {listed(EXTRAPOLATED)}"
        )


def extrapolated(coarse: Solution, fine: Solution) -> Solution:
    """One answer of two; their times, factorisations and histories together."""
    both = replace(
        fine,
        model="lumped-pair",
        label=f"{fine.label} and {size(coarse.settings['grid'])}, extrapolated",
        settings={**fine.settings, "coarser": coarse.settings["grid"]},
        iterations=coarse.iterations + fine.iterations,
        solve_seconds=coarse.solve_seconds + fine.solve_seconds,
        setup_seconds=coarse.setup_seconds + fine.setup_seconds,
        history=(*coarse.history, *fine.history),
    )
    if not fine.comparable or (coarse.status, len(coarse.snaps)) != (fine.status, len(fine.snaps)):
        grid, ended = size(coarse.settings["grid"]), f"{coarse.status} with {len(coarse.snaps)} snaps"
        finer = f"{fine.status} with {len(fine.snaps)}"
        return replace(both, fallback=f"the finer lattice alone: {grid} ended {ended}, the finer {finer}")
    cells = [np.array(s.settings["grid"][:2]) - 1 for s in (coarse, fine)]
    weight = 1.0 / ((prod(cells[1]) / prod(cells[0])) ** (ORDER / 2.0) - 1.0)
    unseen = UNSEEN / min(cells[1]) ** 2 * np.max(np.abs(fine.mesh.point_data["displacement"]))

    def change(points: np.ndarray) -> np.ndarray:
        return weight * (fine.sample(points) - coarse.sample(points))

    def bar(points: np.ndarray) -> np.ndarray:
        return REACH * np.abs(change(points)) + unseen

    return replace(
        both,
        sample=lambda points: fine.sample(points) + change(points),
        reactions={k: f + weight * (f - coarse.reactions[k]) for k, f in fine.reactions.items()},
        energies={k: e + weight * (e - coarse.energies[k]) for k, e in fine.energies.items()},
        actuators={k: w + weight * (w - coarse.actuators[k]) for k, w in fine.actuators.items()},
        mesh=_moved(fine.mesh, change, bar),
        balance=_balance(coarse.balance, fine.balance, weight),
        bar=bar,
    )


def _moved(mesh: FieldMesh, change: Field, bar: Field) -> FieldMesh:
    """The finer lattice's mesh where the extrapolated answer has it, and the bar at its masses [m]."""
    at = mesh.points[:, :2]
    displacement = mesh.point_data["displacement"] + change(at)
    fields = {**mesh.point_data, "displacement": displacement, "bar": bar(at)}
    return FieldMesh(mesh.points, mesh.cells, fields, mesh.cell_data)


def _balance(coarse: Balance | None, fine: Balance | None, weight: float) -> Balance | None:
    """What the extrapolated forces leave over: as they are a sum of both lattices', so is this."""
    if coarse is None or fine is None:
        return None
    return replace(
        fine,
        force=fine.force + weight * (fine.force - coarse.force),
        moment=fine.moment + weight * (fine.moment - coarse.moment),
        allowed=fine.allowed + weight * (fine.allowed + coarse.allowed),
    )
