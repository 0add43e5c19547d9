"""Rows of a comparison: what models differ by at a probe, what each cost, and forces of the supports."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from sheetbench.answers.table import MILLIMETRES, MILLISECONDS, NEWTONS, NUMBER, PERCENT, SECONDS, Column


@dataclass(frozen=True)
class Difference:
    """How far one model is from another at one probe, as a fraction of the other's displacement there.

    distinguishable: whether that is more than the other's own error bar; None where there is no bar.
    """

    probe: str
    of: str
    against: str
    relative: float | None
    distinguishable: bool | None = None


@dataclass(frozen=True)
class ProbeRow:
    """Displacement (by component) of a model at a probe, how far off it is, and its own error bar over it."""

    probe: str
    x: Annotated[float, MILLIMETRES(".4g", detail=True)]
    y: Annotated[float, MILLIMETRES(".4g", detail=True)]
    model: str
    displacement: Annotated[Mapping[str, float], MILLIMETRES("z.3f")]
    relative: Annotated[float | None, PERCENT("z.2f", "difference")]
    bar: Annotated[float | None, PERCENT(".2g", "±")]


@dataclass(frozen=True)
class CostRow:
    """What a model is, what it cost, how far it is from the reference."""

    model: str
    label: Annotated[str, Column("what it is", prose=True, detail=True)]
    unknowns: Annotated[int, NUMBER("d")]
    iterations: Annotated[int, NUMBER("d", "factorisations")]
    setup_seconds: Annotated[float, SECONDS("z.2f", "set-up")]
    solve_seconds: Annotated[float, MILLISECONDS(".1f", "solve")]
    error: Annotated[float | None, PERCENT("z.2f")]
    expected: Annotated[float | None, PERCENT("z.2f", "est.")]
    status: Annotated[str, Column(prose=True)]


@dataclass(frozen=True)
class ReactionRow:
    """Force (by component) of a support on the sheet."""

    edge: str
    model: str
    force: Annotated[Mapping[str, float], NEWTONS("z.4f")]
