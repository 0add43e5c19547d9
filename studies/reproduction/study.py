"""The study of Habibi et al. in depth, with what `sheetbench reproduce` answers.

errors    the published inputs held against one another, the printed error table computed again
tables    tests 1 and 2, as `reproduce` has them
settling  the run from rest, as `reproduce` has it
nearest   which sheets come nearest to the tables, and what in the tables none of them can have
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any

from comparisons.models.grids import Elements
from comparisons.report.work import Work, silent
from comparisons.reproduction import findings as of_models
from comparisons.reproduction.findings import Finding
from comparisons.reproduction.reproduction import reproduce
from comparisons.reproduction.tables import Reproduction, findings_table
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture, Write
from sheetbench.answers.table import Table
from sheetbench.choices import ELEMENTS
from sheetbench.scenes.seed import seed_inputs
from studies.reproduction import findings, tables
from studies.reproduction.chords import Chord, chords
from studies.reproduction.inputs import Check, checks
from studies.reproduction.nearest import Fit, Scan, nearest, scans
from studies.reproduction.printed_errors import Cell, cells, means
from studies.reproduction.ratios import Ratio, ratios

PARTS = ("errors", "tables", "settling", "nearest")


@dataclass(frozen=True, repr=False)
class Forensics(Answer):
    """What each part found; empty where a part was not asked for. models: what our models answer."""

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
        before, after = (
            [Finding(about, sentence) for part in parts for about, sentence in part(self)]
            for parts in (findings.BEFORE, findings.AFTER)
        )
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
                    "means": {**means(list(self.cells)), "quoted": seed_inputs()["mean_error"]},
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
        before = [tables.errors(self), tables.inputs(self)] if self.cells else []
        after = [tables.nearest(self), tables.ratios(self), tables.chords(self)] if self.scans else []
        return [findings_table(self.findings()), *before, *self.models.tables()[1:], *after]

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
