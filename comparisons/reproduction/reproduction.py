"""The seed's study again, part by part.

tables    tests 1 and 2: published model and experiment, our lattices, our shell with its error bar
settling  the run from rest, and what it takes

What in the published figures contradicts itself, and which sheets come nearest to them, is a study
(`studies.reproduction`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass
from typing import Any

from comparisons.models.grids import Elements
from comparisons.report.work import Work, silent
from comparisons.reproduction import findings, tables
from comparisons.reproduction.answers import Answer, answers
from comparisons.reproduction.settling import Settling, settling
from sheetbench.answers.report import Report
from sheetbench.choices import ELEMENTS
from sheetbench.scenes import Status
from sheetbench.scenes.seed import KNOWN_FAULTS, seed_inputs

PARTS = ("tables", "settling")


@dataclass(frozen=True)
class Reproduction:
    """What each part found; empty, or None, where a part was not asked for."""

    parts: tuple[str, ...]
    elements: Elements
    answers: tuple[Answer, ...] = ()
    settling: Settling | None = None

    @property
    def converged(self) -> bool:
        """Whether our own models have answers to what was asked: the seed's lattices need not."""
        runs = self.settling.runs.values() if self.settling is not None else ()
        return all(one.comparison.converged for one in self.answers) and all(
            run.status is Status.CONVERGED for run in runs
        )

    @property
    def folders(self) -> list[str]:
        """Folders of files that are written beside the others: frames of the settling runs."""
        return [f"settling-{model}/" for model in (self.settling.runs if self.settling is not None else ())]

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench reproduce`: SI units, errors as fractions."""
        document: dict[str, Any] = {
            "parts": list(self.parts),
            "inputs": seed_inputs(),
            "known_faults": list(KNOWN_FAULTS),
            "findings": [vars(one) for one in findings.all_of(self)],
        }
        if self.answers:
            document["tests"] = [
                {"test": one.test, "sense": one.sense, "name": one.name, **one.comparison.document()}
                for one in self.answers
            ]
        if self.settling is not None:
            document["settling"] = self.settling.as_dict()
        return document

    def report(self) -> Report:
        """What is shown of it."""
        return tables.report(self)


def reproduce(
    parts: Collection[str] = PARTS,
    *,
    elements: Elements = ELEMENTS,
    progress: Callable[[str | Work], None] = silent,
) -> Reproduction:
    """These parts of the seed's study; elements: of the shell; progress: told what is being done."""
    parts_done: dict[str, Any] = {}
    if "tables" in parts:
        parts_done["answers"] = tuple(answers(elements, progress))
    if "settling" in parts:
        parts_done["settling"] = settling(progress=progress)
    return Reproduction(tuple(part for part in PARTS if part in parts), elements, **parts_done)
