"""What a candidate takes on a scene, before it is built, and a refusal where that is more than there is.

Where memory ends in the middle of a solve the process is gone without a word; so the size is looked at first,
by every verb, for all that it is about to solve.
"""

from __future__ import annotations

from collections.abc import Callable
from math import prod

from comparisons.models import memory
from comparisons.models.candidate import Candidate
from comparisons.models.grids import scene_grid
from comparisons.models.symmetry import cut_axes
from comparisons.report import amounts
from sheetbench.choices import ELEMENTS
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.grid import grid_of, near_square
from sheetbench.scenes.size import Size

LATTICES = ("lumped", "lumped-pair")  # of a pair the finer one: they are solved one after the other
OWN = (*LATTICES, "plate", "shell", "solid")  # models whose size is known


def size(scene: Scene, candidate: Candidate) -> Size | None:
    """Of what is solved, a half or a quarter of the sheet where symmetry is asked for; None of a plug-in."""
    if candidate.model not in OWN:
        return None
    counts = _counts(scene, candidate)
    lattice = candidate.model in LATTICES
    if candidate.settings.get("symmetry", False):
        for axis in cut_axes(scene, counts[:2], masses=lattice):
            counts[axis] = (counts[axis] + lattice) // 2
    return _estimate(candidate, counts)


def has_room(scene: Scene, candidate: Candidate) -> bool:
    """Whether there is as much memory as a candidate takes, as far as either is known."""
    room, asked = memory.available(), size(scene, candidate)
    return room is None or asked is None or asked.memory <= room


def require_room(scene: Scene, candidate: Candidate, option: str = "", instead: str = "") -> None:
    """Raise BadInput where a candidate takes more memory than there is, naming a size that would fit.

    option: by which the size is asked for, --lumped or --elements unless said; instead: what to do where
    it is not asked for.
    """
    room, asked = memory.available(), size(scene, candidate)
    if room is None or asked is None or asked.memory <= room:
        return
    counts = "x".join(str(n) for n in _counts(scene, candidate))
    option = option or (f"--{candidate.model}" if candidate.model in LATTICES else "--elements")
    least = 2 if candidate.model in LATTICES else 1
    fitting = _largest(
        least, lambda n: _estimate(candidate, _along(scene.sheet, candidate, n)).memory <= room
    )
    advice = f"{option} {fitting} would fit" if fitting else f"take fewer along the longer side, {option} NxM"
    needed, free = amounts.memory(asked.memory), amounts.memory(room)
    raise BadInput(
        f"{candidate.model} {counts}: {amounts.count(asked.unknowns)} unknowns take about {needed} of "
        f"memory, and {free} are free here; {instead or advice}, or give --large (in Python large=True) to "
        "try all the same"
    )


def mesh(scene: Scene, candidate: Candidate) -> str:
    """The masses or elements of a candidate in words, of the whole sheet; "" of a plug-in."""
    if candidate.model not in OWN:
        return ""
    counts = " × ".join(str(n) for n in _counts(scene, candidate))
    return f"{counts} {'masses' if candidate.model in LATTICES else 'elements'}"


def _counts(scene: Scene, candidate: Candidate) -> list[int]:
    """Masses (nx, ny, layers), or elements (nx, ny) and bricks through the thickness."""
    if candidate.model in LATTICES:
        return list(scene_grid(scene, candidate.settings.get("grid")))
    elements = candidate.settings.get("elements", ELEMENTS)
    asked = [elements] if isinstance(elements, int) else list(elements)
    along = list(near_square(scene.sheet, asked[0])) if len(asked) == 1 else asked
    return [*along, *_layers(candidate)]


def _along(sheet: Sheet, candidate: Candidate, number: int) -> list[int]:
    """The same for so many along the shorter side, as they are asked for by one number."""
    if candidate.model in LATTICES:
        return list(grid_of(sheet, number))
    return [*near_square(sheet, number), *_layers(candidate)]


def _layers(candidate: Candidate) -> list[int]:
    return [candidate.settings.get("layers", 1)] if candidate.model == "solid" else []


def _estimate(candidate: Candidate, counts: list[int]) -> Size:
    if candidate.model in LATTICES:
        import lumped

        return lumped.footprint((counts[0], counts[1], counts[2]))
    from fem_reference.footprint import footprint

    return footprint(candidate.model, (counts[0], counts[1]), prod(counts[2:]))


def _largest(least: int, fits: Callable[[int], bool]) -> int:
    """The largest number that fits, 0 if none does."""
    if not fits(least):
        return 0
    above = 2 * least
    while fits(above):
        above *= 2
    below = above // 2
    while above - below > 1:
        middle = (below + above) // 2
        below, above = (middle, above) if fits(middle) else (below, middle)
    return below
