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

from collections.abc import Callable
from dataclasses import replace
from math import prod

import numpy as np

from comparisons.models.spec import LatticePair, counted
from sheetbench.answers.balance import Balance
from sheetbench.answers.solution import FieldMesh, Solution

ORDER, REACH, UNSEEN = 2.0, 2.0, 0.2
Field = Callable[[np.ndarray], np.ndarray]  # plan points (n, 2) [m] → (n, 3) [m]


def extrapolated(coarse: Solution, fine: Solution) -> Solution:
    """One answer of two; their times, factorisations and histories together."""
    both = replace(
        fine,
        model=LatticePair.NAME,
        label=f"{fine.label} and {counted(coarse.settings['grid'])}, extrapolated",
        settings={**fine.settings, "coarser": coarse.settings["grid"]},
        iterations=coarse.iterations + fine.iterations,
        solve_seconds=coarse.solve_seconds + fine.solve_seconds,
        setup_seconds=coarse.setup_seconds + fine.setup_seconds,
        history=(*coarse.history, *fine.history),
    )
    if not fine.comparable or (coarse.status, len(coarse.snaps)) != (fine.status, len(fine.snaps)):
        grid, ended = counted(coarse.settings["grid"]), f"{coarse.status} with {len(coarse.snaps)} snaps"
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
    """Return the finer lattice's mesh where the extrapolated answer has it, and the bar at its masses [m]."""
    at = mesh.points[:, :2]
    displacement = mesh.point_data["displacement"] + change(at)
    fields = {**mesh.point_data, "displacement": displacement, "bar": bar(at)}
    return FieldMesh(mesh.points, mesh.cells, fields, mesh.cell_data)


def _balance(coarse: Balance | None, fine: Balance | None, weight: float) -> Balance | None:
    """Return what the extrapolated forces leave over: as they are a sum of both lattices', so is this."""
    if coarse is None or fine is None:
        return None
    return replace(
        fine,
        force=fine.force + weight * (fine.force - coarse.force),
        moment=fine.moment + weight * (fine.moment - coarse.moment),
        allowed=fine.allowed + weight * (fine.allowed + coarse.allowed),
    )
