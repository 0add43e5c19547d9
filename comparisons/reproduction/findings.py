"""Findings of the reproduction, a sentence or two each, with their numbers.

Which sheets come nearest to the published tables is among them. Could the lattice of Habibi et al. have
computed the published model's table, and could a plate have shown the published experiment's? Each was tried
for both tests, alone and together, over a row of values and by searches in ever more numbers. The rows and
sentences are stored results, `data/nearest.json`, which names the commit that has the searches.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Annotated, Any

import numpy as np

from comparisons.reproduction.answers import RODS, ReproducedTest, published
from sheetbench.answers.solution import Status
from sheetbench.answers.table import (
    MEGAPASCALS,
    MILLIMETRES,
    PERCENT,
    Column,
    Table,
    TableUnit,
    percent,
)


@dataclass(frozen=True)
class Finding:
    """What it is about, and the finding."""

    about: str
    finding: Annotated[str, Column(prose=True)]


def of_tables(answers: Sequence[ReproducedTest]) -> Iterator[Finding]:
    for one in answers:
        comparison, table = one.comparison, published(one.test, "model")
        yield Finding(one.title, comparison.result())
        for solution in comparison.solutions[2:]:
            moved = np.array(list(comparison.probes(solution).values()))
            distance = np.nanmax(np.abs(moved - table)) / np.nanmax(np.abs(table))
            how = "" if solution.status is Status.CONVERGED else f" (its answer is {solution.status})"
            yield Finding(
                one.title,
                f"With the published k {solution.model}{how} differs from the published model by up to "
                f"{percent(float(distance), '.0f')} of its largest displacement.",
            )


SOUGHT = {
    "young": MEGAPASCALS(".3g", "E"),
    "k": TableUnit("N/m", "N/m")(".3g", "k"),
    "layer_distance": MILLIMETRES(".3g", "lz"),
    "tilt": TableUnit("rad", "°", 180.0 / np.pi)(".2g", "tilt"),
    "curvature": TableUnit("1/m", "1/m")(".3g", "κ"),
}
COLUMNS = (
    *("tests", "rod", "of", Column("table", detail=True), *SOUGHT.values(), "by"),
    *(PERCENT(".3g", "rms"), PERCENT(".3g", "error"), "met"),
)
TEXT = (
    "sheet: a plate (consistent springs), of the published experiment; lattice: equal springs, of the "
    "published model. A number is given where it was sought, else it is as published. tilt: the supports "
    "turned as one, > 0 downwards. by: nearest by the least misfit, or the one of the scan with most entries "
    "met. rms and error: of the differences, over the largest published component. met: entries within 10 % "
    "of themselves. Stored results of {}."
)


@cache
def stored() -> dict[str, Any]:
    """Return the results: `made` (by what), `findings`, `fits`."""
    file = resources.files("comparisons.reproduction").joinpath("data", "nearest.json")
    document: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return document


def nearest_table() -> Table:
    """Return a row per fit, the sheet of a kind that comes nearest to a published table: what was sought,
    what was found (SI), how near, and how many components of the table it has."""
    rows = [
        (
            " and ".join(map(str, fit["tests"])),
            "sought" if "curvature" in fit["sought"] else RODS[fit["sense"]],
            *(fit["kind"], fit["table"], *(fit["sought"].get(name) for name in SOUGHT), fit["by"]),
            *(fit["rms"], fit["error"], f"{fit['met']} of {fit['entries']}"),
        )
        for fit in stored()["fits"]
    ]
    return Table.listed("The nearest sheets", COLUMNS, rows, "nearest", text=TEXT.format(stored()["made"]))
