"""The tables of `sheetbench identify --tensile`: constants with intervals, and how well each law fits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from comparisons.identification.tensile.laws import Fit
from sheetbench.answers.table import MEGAPASCALS, NUMBER, PERCENT, Column, Table, Unit, unit


@dataclass(frozen=True)
class ConstantRow:
    """A constant of a law and its 95 % interval."""

    law: str
    constant: str
    unit: Unit
    value: Annotated[float, NUMBER(".4g")]
    low: Annotated[float, NUMBER(".4g", "from")]
    high: Annotated[float, NUMBER(".4g", "to")]


@dataclass(frozen=True)
class MisfitRow:
    """How well a law fits, of the largest stress, and what speaks against it."""

    law: str
    young: Annotated[float, MEGAPASCALS(".4g", "E at small strain")]
    rms: Annotated[float, PERCENT(".2f", "misfit")]
    largest: Annotated[float, PERCENT(".2f")]
    remark: Annotated[str, Column(prose=True)]


def _named(fits: Sequence[Fit], free: Sequence[Fit]) -> list[tuple[str, Fit]]:
    return [*((fit.law, fit) for fit in fits), *((f"{fit.law}, unbounded", fit) for fit in free)]


def constants(fits: Sequence[Fit], free: Sequence[Fit]) -> Table:
    """Return a row per constant of every law."""
    rows = [
        ConstantRow(law, key, unit("" if key == "limit" else "Pa"), value, *fit.intervals[key])
        for law, fit in _named(fits, free)
        for key, value in fit.constants.items()
    ]
    return Table.of(ConstantRow, rows, "Constants and their 95 % intervals", "constants", grouped=True)


def misfits(fits: Sequence[Fit], free: Sequence[Fit], chosen: Fit | None) -> Table:
    """Return a row per law."""
    rows = [
        MisfitRow(law, f.young, f.rms, f.largest, "← the data ask for it" if f is chosen else _against(f))
        for law, f in _named(fits, free)
    ]
    return Table.of(MisfitRow, rows, "Misfit, of the largest stress (root mean square)", "misfits")


def _against(fit: Fit) -> str:
    if fit.unstable:
        return "its stress falls below 0 at some stretch, or it has no stiffness at rest: scenes refuse it"
    if "limit" in fit.bound:
        return "these data see no limit"
    return f"{' and '.join(fit.bound)} at the bound 0" if fit.bound else ""
