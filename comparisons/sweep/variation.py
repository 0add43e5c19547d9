"""Models on variants of a scene: the computation and the answer of `sheetbench sweep`.

Every variant is solved by every model, through a campaign's store; errors at the probes and over the sheet
are against the reference on the variant (`comparisons.sweep.differences`).
"""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, Unpack

import numpy as np

from comparisons.models.resolve import resolve
from comparisons.models.spec import Spec, unique_name
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.differences import error
from comparisons.sweep.solved import Request, Solved, sweep
from comparisons.sweep.store import Store
from comparisons.sweep.variants import in_words, unit_of, variants
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import MILLIMETRES, MILLISECONDS, PERCENT, Column, Table, unit
from sheetbench.scenes import Scene, require_static
from sheetbench.scenes.language.summary import few

AXES = ("ux", "uy", "uz")


@dataclass(frozen=True)
class VariedRow(Solved):
    """A model's answer to a variant, and its errors against the reference, if known."""

    error: float | None = None
    field_error: float | None = None

    @property
    def varied(self) -> dict[str, Any]:
        """Values [SI] by key."""
        return dict(self.request.tags["varied"])

    @property
    def model(self) -> str:
        return str(self.request.tags["model"])


@dataclass(frozen=True, repr=False)
class Variation(Answer):
    """Rows of all variants and models; reference: name of the model that errors refer to, "" without one."""

    file_name = "sweep"
    scene: Scene
    reference: str
    rows: tuple[VariedRow, ...]

    def document(self) -> dict[str, Any]:
        rows = [
            {
                **{"varied": row.varied, "model": row.model, "label": row.label, "status": row.status},
                **{"message": row.message, "probes": row.row.get("probes"), "error": row.error},
                **{"field_error": row.field_error, "load_factor": row.row.get("load_factor")},
                "solve_seconds": row.seconds,
            }
            for row in self.rows
        ]
        return {"scene": self.scene.document(), "reference": self.reference, "rows": rows}

    @property
    def keys(self) -> list[str]:
        """The varied keys."""
        return list(self.rows[0].varied)

    def numeric(self, key: str) -> bool:
        """Return whether all values of a key are numbers."""
        values = [row.varied[key] for row in self.rows]
        return all(isinstance(value, int | float) and not isinstance(value, bool) for value in values)

    @cached_property
    def largest_component(self) -> tuple[str, int]:
        """The probe and the component with the largest displacement of any variant."""
        values = [np.abs(row.u) for row in self.rows if row.usable]
        largest = np.max(values, axis=0) if values else np.zeros((len(self.scene.probes), 3))
        probe, axis = np.unravel_index(int(np.argmax(largest)), largest.shape)
        return list(self.scene.probes)[probe], int(axis)

    def tables(self) -> tuple[Table, ...]:
        main = self.largest_component
        places = [(probe, axis) for probe in self.scene.probes for axis in range(3)]
        columns = (
            *(unit(unit_of(key))(".4g", key) if self.numeric(key) else Column(key) for key in self.keys),
            *("model", *(MILLIMETRES(".4g", f"{p} {AXES[a]}", detail=(p, a) != main) for p, a in places)),
            *(PERCENT(".2g", "error"), PERCENT(".2g", "field error")),
            *(MILLISECONDS(".3g", "solve", detail=True), Column("status", prose=True)),
        )
        rows = (
            (
                *row.varied.values(),
                *(row.model, *(row.u.ravel().tolist() if row.usable else [None] * len(places))),
                *(row.error, row.field_error, row.seconds, row.status),
            )
            for row in self.rows
        )
        return (Table.listed("Variants", columns, rows, "sweep", grouped=True),)

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("sweep", "comparisons.sweep.variation_figure:compose", (self,)),)

    def result(self) -> str:
        count = len({str(row.varied) for row in self.rows})
        with_error = [row for row in self.rows if row.error is not None]
        if not with_error:
            return f"{count} variants of {', '.join(self.keys)}"
        worst = max(with_error, key=lambda row: row.error or 0.0)
        error = f"up to {few(100.0 * (worst.error or 0.0))} % off the {self.reference}"
        return f"{count} variants: {worst.model} is {error}, at {in_words(worst.varied)}."

    def notes(self) -> tuple[str, ...]:
        text = f"error: at the probes, from the {self.reference} of each variant; `compare` has its bar."
        return (self.result(), *([text] if self.reference else []))

    def complaints(self) -> list[str]:
        """Return a sentence for every row without a stable equilibrium."""
        return [f"{row.request.label}: {row.ending}" for row in self.rows if not row.stable]

    def choices(self) -> dict[str, Any]:
        return {row.model: row.row.get("settings") or row.request.spec.settings for row in self.rows}

    @property
    def succeeded(self) -> bool:
        return not self.complaints()


def vary(
    scene: Scene,
    values: Sequence[str],
    store: Store,
    *,
    models: Sequence[Spec],
    reference: Spec | None,
    **campaign: Unpack[CampaignKeywords],
) -> Variation:
    """Return every model's answer to every variant (`comparisons.sweep.variants`).

    Raises, before the first solve, SceneError for a variant that is invalid or has no static answer, and
    BadInput for an unknown model or setting. A failed solve is a row with its status.
    """
    specs: dict[str, Spec] = {} if reference is None else {reference.model: reference}
    for spec in models:
        specs[unique_name(spec.model, specs)] = spec
    requests = []
    for variant in variants(scene, values):
        require_static(variant.scene)
        for name, spec in specs.items():
            resolve(variant.scene, spec)
            tags, label = {"varied": variant.varied, "model": name}, f"{name} {variant}"
            requests.append(Request(variant.scene, spec, columns=("field",), tags=tags, label=label))
    solved, rows = sweep(requests, store, **campaign), []
    for n in range(0, len(solved), len(specs)):
        truth = solved[n] if reference is not None and solved[n].usable else None
        rows += [_row(row, truth) for row in solved[n : n + len(specs)]]
    return Variation(scene, "" if reference is None else reference.model, tuple(rows))


def _row(row: Solved, truth: Solved | None) -> VariedRow:
    if truth is None or row is truth or not row.usable:
        return VariedRow(**vars(row))
    return VariedRow(**vars(row), error=error(row.u, truth.u), field_error=error(row.field, truth.field))
