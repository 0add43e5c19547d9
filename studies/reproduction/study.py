"""The study of Habibi et al. in depth, with what `sheetbench reproduce` answers.

errors    the published inputs held against one another, the printed error table computed again
tables    tests 1 and 2, as `reproduce` has them
settling  the run from rest, as `reproduce` has it
nearest   which sheets come nearest to the tables, and what in the tables none of them can have
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons.models.grids import Elements
from comparisons.report.work import Work, silent
from comparisons.reproduction import findings as of_models
from comparisons.reproduction.findings import Finding
from comparisons.reproduction.reproduction import Reproduction, findings_table, reproduce
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture, Write
from sheetbench.answers.table import Table, percent
from sheetbench.choices import ELEMENTS
from sheetbench.scenes.habibi import published_inputs
from studies.reproduction import findings
from studies.reproduction.chords import Chord, chords
from studies.reproduction.inputs import Check, checks
from studies.reproduction.nearest import NEAR, Fit, Scan, nearest, scans
from studies.reproduction.printed_errors import Cell, cells, means
from studies.reproduction.ratios import Ratio, ratios

PARTS = ("errors", "tables", "settling", "nearest")
TURNING = np.pi / 6.0  # rad: chords that ask for less, and for no stretch, are in the document alone
TEXTS = {
    "errors": "|model − experiment| of the published tables, relative to the one and to the other. * the "
    "printed error is not relative to the experiment: the normalisation changes there.",
    "inputs": "What the other inputs give for a printed figure. D = E h³/12(1 − ν²), I = l h³/12, l the "
    "distance of the masses; the layer distance is not published.",
    "nearest": "sheet: a plate (consistent springs), of the published experiment; lattice: equal springs, of "
    "the published model. A number is given where it was sought, else it is as published. tilt: the supports "
    "turned as one, > 0 downwards. by: nearest by the least misfit, or the one of the scan with most "
    "entries met. rms and error: of the differences, over the largest published component. met: entries "
    f"within {percent(NEAR)} of themselves. The picture: misfit over E, and over the layer distance.",
    "ratios": "Published ratios beside the range that they run through as E (of a sheet) or the layer "
    "distance (of a lattice, k as published) varies, where both entries have the published sign.",
    "chords": "Distances of points, as published and on the flat sheet, where the line of the sheet between "
    "them is stretched for certain, or where its directions span 30° or more unless it is compressed. No "
    "material, support or load enters.",
}


@dataclass(frozen=True, repr=False)
class Forensics(Answer):
    """What each part found; empty where a part was not requested. models: what our models answer."""

    file_name = Reproduction.file_name
    parts: tuple[str, ...]
    models: Reproduction
    checks: tuple[Check, ...] = ()
    cells: tuple[Cell, ...] = ()
    scans: tuple[Scan, ...] = ()
    fits: tuple[Fit, ...] = ()
    ratios: tuple[Ratio, ...] = ()
    chords: tuple[Chord, ...] = ()

    def findings(self) -> list[Finding]:
        """Every finding of the parts there are."""
        before = [*findings.of_errors(self.cells), *findings.of_inputs(self.checks)]
        after = [
            *findings.of_fits(self.fits),
            *findings.of_senses(self.fits),
            *findings.of_ratios(self.ratios),
            *findings.of_stretch(self.chords, self.fits),
            *findings.of_shortening(self.chords, self.fits),
        ]
        return [*before, *of_models.all_of(self.models.answers, self.models.settling), *after]

    def document(self) -> dict[str, Any]:
        document: dict[str, Any] = {
            **self.models.document(),
            "parts": list(self.parts),
            "findings": [vars(one) for one in self.findings()],
        }
        if self.cells:
            document |= {
                "checks": [{**vars(one), "agrees": one.agrees} for one in self.checks],
                "errors": {
                    "cells": [{**vars(one), "changes": one.changes} for one in self.cells],
                    "means": {**means(list(self.cells)), "quoted": published_inputs()["mean_error"]},
                },
            }
        if self.scans:
            document |= {
                "scans": [vars(one) for one in self.scans],
                "nearest": [one.as_dict() for one in self.fits],
                "ratios": [vars(one) for one in self.ratios],
                "chords": [vars(one) for one in self.chords],
            }
        return document

    def heading(self) -> tuple[str, str, str]:
        title, _, lead = self.models.heading()
        return title, "what was published, what the same inputs give, and what comes nearest to it", lead

    def tables(self) -> list[Table]:
        """What `reproduce` shows, the other parts before and after."""
        tables = [findings_table(self.findings())]
        if self.cells:
            tables += [errors(self.cells), inputs(self.checks)]
        tables += self.models.tables()[1:]
        if self.scans:
            tables += [nearest_sheets(self.fits), of_ratios(self.ratios), of_chords(self.chords)]
        return tables

    def figures(self) -> list[Picture]:
        drawn = [Picture("nearest", "studies.reproduction.figure:misfit", (self,))] if self.scans else []
        return [*self.models.figures(), *drawn]

    def complaints(self) -> list[str]:
        return self.models.complaints()

    def files(self) -> Mapping[str, Write]:
        return self.models.files()

    def choices(self) -> dict[str, Any]:
        return {**self.models.choices(), "parts": list(self.parts)}

    @property
    def succeeded(self) -> bool:
        return self.models.succeeded


def errors(cells: Sequence[Cell]) -> Table:
    """A row per printed error: of the experiment, of the model, and which of the two it is."""
    fields = (
        "test", "component", "probe", "printed", "of_experiment", "of_model", "relative_to", "digits_kept"
    )  # fmt: skip
    caption = "Printed errors, computed again"
    return Table.of(Cell, cells, caption, "errors", fields=fields, grouped=True, text=TEXTS["errors"])


def inputs(checks: Sequence[Check]) -> Table:
    """A row per printed figure that others should give."""
    fields = ("what", "shown_unit", "printed", "computed", "follows", "agrees")
    caption = "Published inputs held against one another"
    return Table.of(Check, checks, caption, "inputs", fields=fields, text=TEXTS["inputs"])


def nearest_sheets(fits: Sequence[Fit]) -> Table:
    """A row per fit: what was sought, what was found, how near."""
    fields = ("test_names", "rod", "kind", "source", "values", "by", "rms", "error", "met")
    return Table.of(Fit, fits, "The nearest sheets", "nearest", fields=fields, text=TEXTS["nearest"])


def of_ratios(ratios: Sequence[Ratio]) -> Table:
    """A row per ratio and scan."""
    fields = ("test", "rod", "name", "published", "kind", "least", "most", "matches")
    caption = "Ratios between entries"
    return Table.of(Ratio, ratios, caption, "ratios", fields=fields, grouped=True, text=TEXTS["ratios"])


def of_chords(chords: Sequence[Chord]) -> Table:
    """A row per pair of points whose distance asks for stretch or for much turning."""
    telling = (c for c in chords if c.stretch > 0.0 or c.turning > TURNING)
    fields = ("test", "rod", "source", "start", "end", "flat", "published", "least_stretch", "least_span")
    caption = "What distances ask of any sheet"
    return Table.of(Chord, telling, caption, "chords", fields=fields, grouped=True, text=TEXTS["chords"])


def study(
    parts: Collection[str] = PARTS,
    *,
    elements: Elements = ELEMENTS,
    progress: Callable[[str | Work], None] = silent,
) -> Forensics:
    """These parts; elements: of the shell; progress: called with what is being done."""
    results: dict[str, Any] = {}
    if "errors" in parts:
        results |= {"checks": tuple(checks()), "cells": tuple(cells())}
    models = reproduce(parts, elements=elements, progress=progress)
    if "nearest" in parts:
        scanned = scans(progress)
        results |= {
            "scans": tuple(scanned),
            "fits": tuple(nearest(scanned, progress)),
            "ratios": tuple(ratios(scanned)),
            "chords": tuple(chords()),
        }
    return Forensics(tuple(part for part in PARTS if part in parts), models, **results)
