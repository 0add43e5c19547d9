"""Which plots a page draws of a verb's document; verbs that are not here show the pictures they left."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from typing import Any

from comparisons.pages.plots import Axis, Plot, Series
from comparisons.pages.studies import Study
from sheetbench.answers.table import number

Document = Mapping[str, Any]


def charts(study: Study) -> list[Plot]:
    """The plots of a study; none where its document has nothing that can be drawn."""
    draw = CHARTS.get(study.verb)
    if draw is None or not study.document:
        return []
    found = study.of_document(draw)
    return [plot for plot in found or [] if plot.shown]


def _history(document: Document) -> list[Plot]:
    time = document["time"]
    heights = [
        Series(probe, time, _thousandths([u[2] for u in values]))
        for probe, values in document["probes"].items()
    ]
    energies = [
        Series(name, time, _thousandths(values))
        for name, values in document.get("energies", {}).items()
        if any(values)
    ]
    return [
        Plot("Height of the probes over time", Axis("time [s]"), Axis("uz [mm]"), heights),
        Plot("Energies over time", Axis("time [s]"), Axis("energy [mJ]"), energies),
    ]


def _thousandths(values: Sequence[float | None]) -> list[float]:
    return [math.nan if value is None else 1e3 * value for value in values]


def _tradeoff(document: Document) -> list[Plot]:
    if "lowest_period" in document:
        return _motion_tradeoff(document)
    rows = [row for row in document["rows"] if row.get("error") and row.get("solve_seconds")]
    series = []
    for title, some in groupby(sorted(rows, key=_series), key=_series):
        of = sorted(some, key=lambda row: row["solve_seconds"]["median"])
        times = [1e3 * row["solve_seconds"]["median"] for row in of]
        errors = [100 * row["error"] for row in of]
        series.append(Series(title, times, errors, labels=[row.get("label", title) for row in of]))
    said = "Below and to the left is better: a smaller error in less time."
    return [Plot("Error against time", Axis("solve [ms]", True), Axis("error [%]", True), series, said)]


def _motion_tradeoff(document: Document) -> list[Plot]:
    rows = [row for row in document["rows"] if row.get("error") and row.get("seconds_per_second")]
    series = []
    for integrator, some in groupby(sorted(rows, key=_integrator), key=_integrator):
        of = sorted(some, key=lambda row: row["seconds_per_second"])
        costs = [row["seconds_per_second"] for row in of]
        labels = [f"{integrator}, step {number(1e3 * row['step'], '.3g')} ms" for row in of]
        series.append(Series(integrator, costs, [100 * row["error"] for row in of], labels=labels))
    said = "Below and to the left is better: a smaller error in less time."
    across = Axis("solve a simulated second [s]", True)
    return [Plot("Error of the motion against time", across, Axis("error [%]", True), series, said)]


def _integrator(row: Mapping[str, Any]) -> str:
    return str(row["integrator"])


def _series(row: Mapping[str, Any]) -> str:
    return str(row.get("series") or row["model"])


def _modes(document: Document) -> list[Plot]:
    series = [
        Series(one["model"], list(range(1, len(one["frequencies_hz"]) + 1)), one["frequencies_hz"])
        for one in document["solutions"]
    ]
    return [Plot("Natural frequencies", Axis("mode"), Axis("frequency [Hz]"), series)]


def _poles(document: Document) -> list[Plot]:
    poles = document["poles"]
    hertz = [[part / 6.283185307179586 for part in pole] for pole in poles]
    series = [Series("poles", [re for re, _ in hertz], [im for _, im in hertz], line=False)]
    return [Plot("Poles", Axis("real part / 2π [1/s]"), Axis("imaginary part / 2π [Hz]"), series)]


def _verification(document: Document) -> list[Plot]:
    rows = [row for row in document["rows"] if row.get("relative")]
    labels = [f"{row['case']}, {row['quantity']}" for row in rows]
    off = [100 * abs(row["relative"]) for row in rows]
    series = [Series("rows", list(range(1, len(rows) + 1)), off, False, labels)]
    return [Plot("Distance from the published value", Axis("row"), Axis("off by [%]", True), series)]


CHARTS: dict[str, Callable[[Document], list[Plot]]] = {
    "simulate": _history,
    "tradeoff": _tradeoff,
    "modes": _modes,
    "linearise": _poles,
    "verify": _verification,
}
