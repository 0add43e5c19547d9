"""Rows of a verification case: an expected value, its source and the computed value.

`published` is the expected value, `source` its author and year, a closed form or a theorem, or this
project itself on a finer mesh, which proves convergence and no more.

`relative` is |computed − published| / |published|, or over the case's length scale where the published value
is 0, and None where neither has a meaning (orders, residuals, manufactured errors): there the
difference itself is held to the tolerance.
"""

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
    """Expected value with its source, the mesh of the computed one, and the tolerance. case: its key in
    `CASES`, set when cases are run."""

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
        """Tolerance, in per cent where it is relative."""
        if self.relative is None:
            return f"± {number(self.tolerance)}"
        return f"{number(100.0 * self.tolerance)} %"


def absolute_row(
    quantity: str, mesh: str, published: float, source: str, computed: float, tolerance: float
) -> Row:
    """Return a row held to a difference in the quantity's own unit."""
    passed = bool(abs(computed - published) <= tolerance)
    return Row("", quantity, mesh, float(published), source, float(computed), None, tolerance, passed)


def relative_row(*cells: Any, scale: float | None = None) -> Row:
    """Return a row of the arguments of `absolute_row`, held to a relative difference. It is relative to
    `scale` where given, else to the published value."""
    row = absolute_row(*cells)
    relative = abs(row.computed - row.published) / abs(row.published if scale is None else scale)
    return replace(row, relative=relative, passed=relative <= row.tolerance)


def mesh_change(mesh: str, coarse: np.ndarray, fine: np.ndarray, tolerance: float) -> Row:
    """Return a row of the largest relative change of the answers from half the mesh."""
    change = np.max(np.abs(np.asarray(fine) - coarse)) / np.max(np.abs(fine))
    return absolute_row("change from half the mesh", mesh, 0.0, OURS, change, tolerance)


def convergence(
    of: str, mesh: str, errors: Sequence[float], largest: float, order: float, source: str = EXACT
) -> Iterator[Row]:
    """Yield rows of the error on the finest mesh and of the order of the last refinement. errors: on meshes
    with twice the elements of the one before; largest: error allowed."""
    coarse, fine = errors[-2:]
    yield absolute_row(f"error {of}", mesh, 0.0, source, fine, largest)
    yield absolute_row(f"order {of}", mesh, order, THEORY, np.log2(coarse / fine), SLACK)


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
    """Yield rows of each model's values at each load of a curve, and of their change from half as many
    elements. names: with a place for the load; meshes: by model; source: of all, or by load; half_at: load of
    the change, the largest by default; size: a value far below it is relative to it."""
    for model, mesh in meshes.items():
        answers = {load: answer(model, load, elements) for load in published}
        for load, values in published.items():
            authority = source if isinstance(source, str) else source[load]
            for name, expected, computed in zip(names, values, answers[load], strict=True):
                scale = size if abs(expected) < 1e-9 * size else None
                cells = name.format(load), mesh, expected, authority, computed, tolerance
                yield relative_row(*cells, scale=scale)
        load = max(published) if half_at is None else half_at
        yield mesh_change(mesh, answer(model, load, elements // 2), answers[load], tolerance)


def lowest(
    quantity: str, mesh: str, published: Values, source: str, frequencies: np.ndarray, tolerance: float
) -> Iterator[Row]:
    """Yield rows of the published lowest frequencies; quantity: with a place for the mode's number."""
    for mode, (expected, computed) in enumerate(zip(published, frequencies, strict=True), 1):
        if expected is not None:
            yield relative_row(quantity.format(mode), mesh, expected, source, computed, tolerance)
