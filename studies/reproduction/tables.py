"""The tables of the forensics: printed errors, inputs, nearest sheets, ratios, chords."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from comparisons.reproduction.published import SOURCES
from comparisons.reproduction.tables import length
from comparisons.reproduction.words import percent
from sheetbench.answers.table import Column, Table, Unit, unit
from studies.reproduction.nearest import NEAR

if TYPE_CHECKING:
    from studies.reproduction.chords import Chord
    from studies.reproduction.nearest import Fit
    from studies.reproduction.ratios import Ratio
    from studies.reproduction.study import Forensics

PERCENT = ("", "%", 100.0)
RODS = {0: "–", 1: "ends up", -1: "ends down"}
TURNING = np.pi / 6.0  # rad: chords that ask for less, and for no stretch, are in the document alone


def errors(forensics: Forensics) -> Table:
    """A row per printed error: of the experiment, of the model, and which of the two it is."""
    rows = [
        (
            c.test, c.component, c.probe, c.printed, c.of_experiment, c.of_model,
            f"{c.of} *" if c.changes else c.of, c.digits or "no",
        )
        for c in forensics.cells
    ]  # fmt: skip
    columns = (
        Column("test"),
        Column("u"),
        Column("probe"),
        Column("printed", *PERCENT, ".1f"),
        Column("of experiment", *PERCENT, ".2f"),
        Column("of model", *PERCENT, ".2f"),
        Column("relative to"),
        Column("digits"),
    )
    text = (
        "|model − experiment| of the published tables, relative to the one and to the other. * the printed "
        "error is not relative to the experiment: the normalisation changes there."
    )
    return Table("Printed errors, computed again", columns, tuple(rows), "errors", grouped=True, text=text)


def inputs(forensics: Forensics) -> Table:
    """A row per printed figure that others should give."""
    words = {True: "yes", False: "no", None: "–"}
    shown = {"": Unit("", ""), "kg": Unit("kg", "g", 1e3)}
    rows = [
        (
            one.what,
            Unit("", "%", 100.0) if one.what.startswith("mean") else shown.get(one.unit) or unit(one.unit),
            one.printed,
            one.computed,
            one.follows,
            words[one.agrees],
        )
        for one in forensics.checks
    ]
    columns = (
        Column("figure"),
        Column("unit"),
        Column("printed", form=".4g"),
        Column("others give", form=".4g"),
        Column("by"),
        Column("agrees"),
    )
    text = (
        "What the other inputs give for a printed figure. D = E h³/12(1 − ν²), I = l h³/12, l the distance "
        "of the masses; the layer distance is not published."
    )
    return Table("Published inputs held against one another", columns, tuple(rows), "inputs", text=text)


def nearest(forensics: Forensics) -> Table:
    """A row per fit: what was sought, what was found, how near."""
    rows = [
        (
            " and ".join(map(str, fit.tests)), _rod(fit), fit.kind, fit.source,
            *(fit.sought.get(name) for name in ("young", "k", "layer_distance", "tilt", "curvature")),
            fit.by, fit.rms, fit.error, f"{int(fit.matches.sum())} of {fit.entries}",
        )
        for fit in forensics.fits
    ]  # fmt: skip
    columns = (
        Column("tests"),
        Column("rod"),
        Column("of"),
        Column("table", detail=True),
        Column("E", "Pa", "MPa", 1e-6, ".3g"),
        Column("k", "N/m", "N/m", 1.0, ".3g"),
        length("lz", ".3g"),
        Column("tilt", "rad", "°", 180.0 / np.pi, ".2g"),
        Column("κ", "1/m", "1/m", 1.0, ".3g"),
        Column("by"),
        Column("rms", *PERCENT, ".3g"),
        Column("error", *PERCENT, ".3g"),
        Column("met"),
    )
    text = (
        "sheet: a plate (consistent springs), of the published experiment; lattice: equal springs, of the "
        "published model. A number is given where it was sought, else it is as published. tilt: the supports "
        "turned as one, > 0 downwards. by: nearest by the least misfit, or the one of the scan with most "
        "entries met. rms and error: of the differences, over the largest published component. met: entries "
        f"within {percent(NEAR)} of themselves. The picture: misfit over E, and over the layer distance."
    )
    return Table("The nearest sheets", columns, tuple(rows), "nearest", text=text)


def _rod(fit: Fit) -> str:
    return "sought" if "curvature" in fit.sought else RODS[fit.sense]


def ratios(forensics: Forensics) -> Table:
    """A row per ratio and scan."""
    rows = [
        (
            r.test, RODS[r.sense], r.name, *(r.published[source] for source in SOURCES), r.kind, r.least,
            r.most, _matches(r),
        )
        for r in forensics.ratios
    ]  # fmt: skip
    columns = (
        Column("test"),
        Column("rod"),
        Column("ratio"),
        Column("model", form=".3g"),
        Column("experiment", form=".3g"),
        Column("of"),
        Column("least", form=".3g"),
        Column("most", form=".3g"),
        Column("met"),
    )
    text = (
        "Published ratios beside the range that they run through as E (of a sheet) or the layer distance (of "
        "a lattice, k as published) varies, where both entries have the published sign."
    )
    return Table("Ratios between entries", columns, tuple(rows), "ratios", text=text)


def _matches(ratio: Ratio) -> str:
    return " and ".join(source for source in SOURCES if ratio.met(source)) or "neither"


def chords(forensics: Forensics) -> Table:
    """A row per pair of points whose distance asks for stretch or for much turning."""
    telling: list[Chord] = [c for c in forensics.chords if c.stretch > 0.0 or c.turning > TURNING]
    rows = [
        (
            c.test,
            RODS[c.sense],
            c.source,
            c.start,
            c.end,
            c.flat,
            c.published,
            c.stretch or None,
            c.turning or None,
        )
        for c in telling
    ]
    columns = (
        Column("test"),
        Column("rod"),
        Column("table"),
        Column("from"),
        Column("to"),
        length("flat"),
        length("published"),
        Column("stretch ≥", *PERCENT, ".2f"),
        Column("span ≥", "rad", "°", 180.0 / np.pi, ".0f"),
    )
    text = (
        "Distances of points, as published and on the flat sheet, where the line of the sheet between them "
        "is stretched for certain, or where its directions span 30° or more unless it is compressed. No "
        "material, support or load enters."
    )
    return Table("What distances ask of any sheet", columns, tuple(rows), "chords", text=text)
