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

from comparisons.reproduction.answers import ReproducedTest, of_model, published
from comparisons.reproduction.settling import PROBE, SETTLED, Settling
from sheetbench.answers.habibi import PROBES, published_inputs
from sheetbench.answers.solution import Status
from sheetbench.answers.table import (
    MEGAPASCALS,
    MILLIMETRES,
    PERCENT,
    Column,
    Table,
    TableUnit,
    number,
    percent,
    quantity,
)


@dataclass(frozen=True)
class Finding:
    """What it is about, and the finding."""

    about: str
    finding: Annotated[str, Column(prose=True)]


def of_tables(answers: Sequence[ReproducedTest]) -> Iterator[Finding]:
    for one in answers:
        comparison = one.comparison
        off = comparison.error(comparison.solutions[0])
        if off is not None and comparison.bar is not None:
            yield Finding(
                one.title,
                f"Our lattice with consistent springs is {percent(off)} from our shell, whose mesh error is "
                f"± {percent(comparison.bar.error)}.",
            )
        moved, wanted = _moved(one, comparison.reference.model), published(one.test, "experiment")
        pairs = ", ".join(
            f"{name} {number(1e3 * u, '.2f')} ({number(1e3 * p, '.2f')})"
            for name, u, p in zip(PROBES, moved[:, 2], wanted[:, 2], strict=True)
        )
        yield Finding(
            one.title,
            "With the published inputs the shell's uz, and the published experiment's in brackets, are in "
            f"mm: {pairs}.",
        )
        table = published(one.test, "model")
        for solution in comparison.solutions[2:]:
            distance = np.nanmax(np.abs(_moved(one, solution.model) - table)) / np.nanmax(np.abs(table))
            how = "" if solution.status is Status.CONVERGED else f" (its answer is {solution.status})"
            layers = quantity(solution.settings["layer_distance"], "m", ".3g")
            yield Finding(
                one.title,
                f"With the published k and layers {layers} apart{how} the lattice differs from the published "
                f"model by up to {percent(float(distance), '.0f')} of its largest displacement.",
            )


def _moved(one: ReproducedTest, model: str) -> np.ndarray:
    return np.array(list(one.comparison.probes(of_model(one, model)).values()))


def of_settling(settling: Settling) -> Iterator[Finding]:
    for model, run in settling.runs.items():
        lattice = "Consistent springs" if model == "lumped" else f"The published k, {model}"
        settled = settling.settled(model)
        still = "is not at rest at its end"
        if settled is not None:
            still = f"stays within {percent(SETTLED)} of it from {settled:.2f} s on"
        yield Finding(
            "settling",
            f"{lattice}: uz of {PROBE} swings to {settling.largest(model):.2f} times its static value "
            f"and {still}. The {run.time[-1]:g} s took {settling.seconds(model):.1f} s here, set-up "
            f"included; {published_inputs()['run_time']:g} s are published as the average of one simulation, "
            "whose length and machine are not named.",
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
RODS = {0: "–", 1: "ends up", -1: "ends down"}
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
