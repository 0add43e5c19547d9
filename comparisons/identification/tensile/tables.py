"""The tables of `sheetbench identify --tensile`: constants with intervals, and how well each law fits."""

from __future__ import annotations

from collections.abc import Sequence

from comparisons.identification.tensile.laws import Fit
from sheetbench.answers.table import Column, Table, unit


def constants(fits: Sequence[Fit], free: Sequence[Fit]) -> Table:
    """A row per constant of every law."""

    def of(fit: Fit, name: str) -> list[tuple[object, ...]]:
        return [
            (name, key, unit("" if key == "limit" else "Pa"), value, *fit.intervals[key])
            for key, value in fit.constants.items()
        ]

    rows = [row for fit in fits for row in of(fit, fit.law)]
    rows += [row for fit in free for row in of(fit, f"{fit.law}, unbounded")]
    columns = (
        Column("law"),
        Column("constant"),
        Column("unit"),
        *(Column(name, form=".4g") for name in ("value", "from", "to")),
    )
    return Table("Constants and their 95 % intervals", columns, tuple(rows), "constants", grouped=True)


def misfits(fits: Sequence[Fit], free: Sequence[Fit], law: Fit | None) -> Table:
    """A row per law: E of small strains, the misfit, and what speaks against it."""
    rows = [
        (f.law, f.young, f.rms, f.largest, "← the data ask for it" if f is law else _against(f)) for f in fits
    ]
    rows += [(f"{f.law}, unbounded", f.young, f.rms, f.largest, _against(f)) for f in free]
    columns = (
        Column("law"),
        Column("E at small strain", "Pa", "MPa", 1e-6, ".4g"),
        Column("misfit", "", "%", 100.0, ".2f"),
        Column("largest", "", "%", 100.0, ".2f"),
        Column("remark", prose=True),
    )
    return Table("Misfit, of the largest stress (root mean square)", columns, tuple(rows), "misfits")


def _against(fit: Fit) -> str:
    if fit.unstable:
        return "pushes when pulled far enough, or has no stiffness at rest: no scene takes it"
    if "limit" in fit.bound:
        return "these data see no limit"
    return f"{' and '.join(fit.bound)} at the bound 0" if fit.bound else ""
