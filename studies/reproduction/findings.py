"""Findings of the reproduction, a sentence or two each, with their numbers.

Some are results of fits: can the lattice of Habibi et al. give the published model's table, and can a plate
give the published experiment's? Both were tried for each test and for both tests together, by scans of one
parameter and searches in more and more parameters. The fits are stored results, `data/nearest.json`, which
names the commit with the searches.
"""

import json
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from importlib import resources
from typing import Annotated, Any

import numpy as np

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
from studies.reproduction.answers import RODS, ReproducedTest, published


@dataclass(frozen=True)
class Finding:
    """A finding and its topic."""

    about: str
    finding: Annotated[str, Column(prose=True)]


def of_tables(answers: Sequence[ReproducedTest]) -> Iterator[Finding]:
    """Yield the findings of each reproduced test."""
    for answer in answers:
        comparison, table = answer.comparison, published(answer.test, "model")
        yield Finding(answer.title, comparison.result())
        for solution in comparison.solutions[2:]:
            displacement = np.array(list(comparison.probes(solution).values()))
            distance = np.nanmax(np.abs(displacement - table)) / np.nanmax(np.abs(table))
            status = "" if solution.status is Status.CONVERGED else f" (its answer is {solution.status})"
            yield Finding(
                answer.title,
                f"With the published k the lattice {solution.model}{status} differs from the published model "
                f"by up to {percent(float(distance), '.0f')} of its largest displacement.",
            )


FITTED = {
    "young": MEGAPASCALS(".3g", "E"),
    "k": TableUnit("N/m", "N/m")(".3g", "k"),
    "layer_distance": MILLIMETRES(".3g", "lz"),
    "tilt": TableUnit("rad", "°", 180.0 / np.pi)(".2g", "tilt"),
    "curvature": TableUnit("1/m", "1/m")(".3g", "κ"),
}
COLUMNS = (
    *("tests", "rod", "of", Column("table", detail=True), *FITTED.values(), "by"),
    *(PERCENT(".3g", "rms"), PERCENT(".3g", "error"), "met"),
)
TEXT = (
    "sheet: a plate (consistent springs), fitted to the published experiment; lattice: equal springs, fitted "
    "to the published model. A number is given if it was fitted, else it is as published. tilt: common "
    "rotation of the supports, > 0 downwards. by: criterion of the fit, the least misfit or the most entries "
    "met in a scan. rms and error: of the differences, over the largest published component. met: entries "
    "within 10 % of the published value. Stored results of {}."
)


@cache
def stored() -> dict[str, Any]:
    """Return the stored results: `made` (their origin), `findings`, `fits`."""
    file = resources.files("studies.reproduction").joinpath("data", "nearest.json")
    document: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    return document


def nearest_table() -> Table:
    """Return a table with a row per fit: fitted parameters (SI), misfit, and the number of entries met."""
    rows = [
        (
            " and ".join(map(str, fit["tests"])),
            "sought" if "curvature" in fit["sought"] else RODS[fit["sense"]],
            *(fit["kind"], fit["table"], *(fit["sought"].get(name) for name in FITTED), fit["by"]),
            *(fit["rms"], fit["error"], f"{fit['met']} of {fit['entries']}"),
        )
        for fit in stored()["fits"]
    ]
    return Table.listed("The nearest sheets", COLUMNS, rows, "nearest", text=TEXT.format(stored()["made"]))
