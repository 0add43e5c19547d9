"""What a verification case yields: rows of an expected value beside the computed one, and whose it is.

`published` is what is expected, `source` says by whom: author and year, a closed form or a theorem, or this
project itself on a finer mesh, which proves convergence and no more.

relative is |computed − published| / |published|, or over the case's length scale where the published value
is 0, and None where neither has a meaning (orders, residuals, manufactured errors): there the
difference itself is held to the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.table import NUMBER, PERCENT, Column, number

EXACT = "exact"
THEORY = "theory"  # of the elements' order
OURS = "this project"
SLACK = 0.15  # of an order
Values = Sequence[float | None]


@dataclass(frozen=True)
class Row:
    """One expected value and whose it is, the mesh it was computed on, the tolerance it is held to.

    case: its key in `CASES`, known where cases are run.
    """

    case: str
    quantity: Annotated[str, Column(prose=True)]
    mesh: str
    published: Annotated[float, NUMBER(".5g", "expected")]
    source: Annotated[str, Column("source", prose=True)]
    computed: Annotated[float, NUMBER(".5g")]
    relative: Annotated[float | None, PERCENT(".2f", "off by")]
    tolerance: float
    passed: Annotated[bool, Column("ok", words=("yes", "NO"))]

    @property
    def held_to(self) -> str:
        """The tolerance, in per cent where it is relative."""
        if self.relative is None:
            return f"± {number(self.tolerance)}"
        return f"{number(100.0 * self.tolerance)} %"


def absolutely(
    quantity: str, mesh: str, published: float, source: str, computed: float, tolerance: float
) -> Row:
    """A row held to a difference of its own kind."""
    passed = bool(abs(computed - published) <= tolerance)
    return Row("", quantity, mesh, float(published), source, float(computed), None, tolerance, passed)


def relatively(*cells: Any, scale: float | None = None) -> Row:
    """A row of the cells that `absolutely` takes, held to a relative difference: of `scale` where it is given
    and else of the published value."""
    row = absolutely(*cells)
    relative = abs(row.computed - row.published) / abs(row.published if scale is None else scale)
    return replace(row, relative=relative, passed=relative <= row.tolerance)


def mesh_change(mesh: str, coarse: np.ndarray, fine: np.ndarray, tolerance: float) -> Row:
    """The largest relative change of the answers from half the mesh: the case's own convergence."""
    change = np.max(np.abs(np.asarray(fine) - coarse)) / np.max(np.abs(fine))
    return absolutely("change from half the mesh", mesh, 0.0, OURS, change, tolerance)


def convergence(
    of: str, mesh: str, errors: Sequence[float], largest: float, order: float, source: str = EXACT
) -> Iterator[Row]:
    """Rows of the error on the finest of meshes, each with twice the elements of the one before, and of the
    order of the last refinement; largest: error allowed."""
    coarse, fine = errors[-2:]
    yield absolutely(f"error {of}", mesh, 0.0, source, fine, largest)
    yield absolutely(f"order {of}", mesh, order, THEORY, np.log2(coarse / fine), SLACK)


def curve(
    names: Sequence[str],
    meshes: Mapping[str, str],
    published: Mapping[float, Iterable[float]],
    source: str | Mapping[float, str],
    tolerance: float,
    answer: Callable[[str, float, int], np.ndarray],
    elements: int,
    size: float = 0.0,
    half_at: float | None = None,
) -> Iterator[Row]:
    """Rows of the values that an answer of each model has at each load of a curve, by names with a place for
    the load, and of its change from half as many elements at one load, the largest unless given. meshes: by
    model; source: of all, or by load; size: what is next to nothing beside that is relative to it."""
    for model, mesh in meshes.items():
        found = {load: answer(model, load, elements) for load in published}
        for load, values in published.items():
            whose = source if isinstance(source, str) else source[load]
            for name, expected, computed in zip(names, values, found[load], strict=True):
                scale = size if abs(expected) < 1e-9 * size else None
                yield relatively(name.format(load), mesh, expected, whose, computed, tolerance, scale=scale)
        load = max(published) if half_at is None else half_at
        yield mesh_change(mesh, answer(model, load, elements // 2), found[load], tolerance)


def lowest(
    quantity: str, mesh: str, published: Values, source: str, found: np.ndarray, tolerance: float
) -> Iterator[Row]:
    """Rows of the lowest frequencies, but for those that are not published; quantity: with a place for their
    number."""
    for mode, (expected, computed) in enumerate(zip(published, found, strict=True), 1):
        if expected is not None:
            yield relatively(quantity.format(mode), mesh, expected, source, computed, tolerance)
