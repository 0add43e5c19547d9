"""Lattice against shell on drawn sheets: errors at the probes as the grid is refined, and their order.

Required errors with 17 masses along the shorter side: 2 % of the largest displacement where rims lie along
the axes, 4 % where they are oblique or round; required orders from 9 to 33 masses: 1.5 and 1. The shell is
taken as exact: `bar` is the uncertainty by its mesh (`fem_reference.uncertainty`).

At a re-entrant corner of 270° with free sides a plate's moments go like r^(a − 1), sin(3πa/2) =
a (1 − ν)/(3 + ν), a = 0.65 at ν = 0.45 (Williams, J. Appl. Mech. 19 (1952) 526–528): on evenly refined grids
deflections come nearer with order 2a = 1.3 in the end, of every model whose cells do not shrink towards it.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, Self

import numpy as np

from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from comparisons.sweep.differences import error
from fem_reference.uncertainty import solve_with_bar
from sheetbench.answers.table import NUMBER, PERCENT
from sheetbench.scenes import Scene
from studies.transfer.drawn_scenes import OBLIQUE

GRIDS, ELEMENTS, TESTED_GRID = (9, 17, 33), 32, 17


def measure(scene: dict[str, Any], grids: Sequence[int] = GRIDS, elements: int = ELEMENTS) -> dict[str, Any]:
    """Return a scene's errors by the number of masses along the shorter side, and the shell's bar; a task.
    Errors are shares of the largest displacement. Raises RuntimeError where the shell has no equilibrium."""
    parsed = Scene.model_validate(scene)
    points = parsed.probe_points()
    _, shell = solve_with_bar(parsed, points, elements=elements)
    if shell is None:
        raise RuntimeError(f"{parsed.name}: the shell has no equilibrium")
    errors: dict[str, float | None] = {}
    for masses in grids:
        answer = solve(resolve(parsed, Lattice(grid=masses)))
        errors[str(masses)] = error(answer.displacement(points), shell.answer) if answer.comparable else None
    return {"scene": parsed.name, "errors": errors, "bar": shell.error}


@dataclass(frozen=True)
class Drawn:
    """Errors of a scene by masses along the shorter side, their orders, and the shell's bar."""

    scene: str
    rims: str
    errors: Annotated[dict[str, float], PERCENT(".2f")]
    orders: Annotated[dict[str, float], NUMBER(".1f")]
    bar: Annotated[float, PERCENT(".2f")]
    missed: str

    @classmethod
    def of(cls, scene: str, errors: dict[str, float | None], bar: float) -> Self:
        """Return the row of a result of `measure`; missed: the requirement that fails, "" if none does."""
        numbers = {int(n): np.inf if value is None else value for n, value in errors.items()}
        steps = [*pairwise(numbers), (min(numbers), max(numbers))]
        orders = {f"order {a}–{b}": float(_order(numbers, a, b)) for a, b in steps}
        oblique = scene in OBLIQUE
        close = numbers.get(TESTED_GRID, np.inf) <= (0.04 if oblique else 0.02)
        fast = [*orders.values()][-1] >= (1.0 if oblique else 1.5)
        missed = ", ".join(name for name, holds in (("error", close), ("order", fast)) if not holds)
        shown = {str(n): float(value) for n, value in numbers.items()}
        return cls(scene, "oblique" if oblique else "aligned", shown, orders, bar, missed)


def _order(errors: dict[int, float], coarse: int, fine: int) -> float:
    with np.errstate(divide="ignore"):  # −∞ without an answer on the finer grid
        return np.log(errors[coarse] / errors[fine]) / np.log((fine - 1) / (coarse - 1))
