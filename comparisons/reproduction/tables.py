"""What a reproduction shows: findings first, then a table a part, and their pictures."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from comparisons.comparison.tables import sheet, write_plan
from comparisons.motion.frames import frames, write_series
from comparisons.motion.history import series
from comparisons.report.files import write_text
from comparisons.report.look import Look
from comparisons.report.report import Picture, Report, Write
from comparisons.report.table import Column, Table, Unit, unit
from comparisons.report.vtk import write_solution
from comparisons.reproduction import findings
from comparisons.reproduction.answers import Answer
from comparisons.reproduction.nearest import NEAR
from comparisons.reproduction.published import SOURCES, published, scene
from comparisons.reproduction.settling import PROBE, SETTLED
from comparisons.reproduction.words import percent
from sheetbench.scenes import Status
from sheetbench.scenes.seed import PROBES, seed_inputs

if TYPE_CHECKING:
    from comparisons.reproduction.chords import Chord
    from comparisons.reproduction.nearest import Fit
    from comparisons.reproduction.ratios import Ratio
    from comparisons.reproduction.reproduction import Reproduction

SEED = (
    "Habibi, Yang, Godage, Kang, Walker, Branson: a lumped-mass model for large-deformation "
    "continuum surfaces"
)
PERCENT = ("", "%", 100.0)
RODS = {0: "–", 1: "ends up", -1: "ends down"}
TURNING = np.pi / 6.0  # rad: chords that ask for less, and for no stretch, are in the document alone


def _length(name: str, form: str = "z.2f", **kind: bool) -> Column:
    return Column(name, "m", "mm", 1e3, form, **kind)


def report(found: Reproduction) -> Report:
    """What `sheetbench reproduce` shows."""
    parts: list[tuple[Table, Callable[[Sequence[Path], Look], str | None] | None]] = [(said(found), None)]
    if found.cells:
        parts += [(errors(found), None), (inputs(found), None)]
    parts += [(displacements(one), partial(_draw, "test", one)) for one in found.answers]
    if found.settling is not None:
        parts.append((runs(found), partial(_draw, "motion", found.settling)))
    if found.scans:
        parts += [
            (nearest(found), partial(_draw, "misfit", found)),
            (ratios(found), None),
            (chords(found), None),
        ]
    return Report(
        name="reproduction",
        title="The study of Habibi et al., reproduced",
        subtitle="what was published, what the same inputs give, and what comes nearest to it",
        lead=_asked(),
        document=found.as_dict(),
        tables=tuple(table for table, _ in parts),
        complaints=tuple(_complaints(found)),
        pictures=tuple(
            Picture((f"{table.name}.png", f"{table.name}.pdf"), draw)
            for table, draw in parts
            if draw is not None
        ),
        attachments=_attachments(found),
        settings={"parts": list(found.parts), "elements": found.elements},
        met=found.converged,
    )


def _asked() -> str:
    """What was published, its tests and its sheet."""
    first, second = scene(1), scene(2)
    points = (
        "P1 is the centre, P2 and P3 the middles of two free sides, P4 the corner farthest from the support."
    )
    return f"{SEED}. {first.title}. {second.title}. {sheet(first.sheet, first.material)}. {points}"


def said(found: Reproduction) -> Table:
    """A row per finding."""
    rows = tuple((one.about, one.finding) for one in findings.all_of(found))
    return Table("Findings", (Column("about"), Column("finding", prose=True)), rows, "findings", grouped=True)


def errors(found: Reproduction) -> Table:
    """A row per printed error: of the experiment, of the model, and which of the two it is."""
    rows = [
        (
            c.test, c.component, c.probe, c.printed, c.of_experiment, c.of_model,
            f"{c.of} *" if c.changes else c.of, c.digits or "no",
        )
        for c in found.cells
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


def inputs(found: Reproduction) -> Table:
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
        for one in found.checks
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


def displacements(one: Answer) -> Table:
    """A row per probe and source: published, our lattices, our shell with its bar."""
    comparison = one.comparison
    tables = {f"published {source}": published(one.test, source) for source in SOURCES}
    ordered = sorted(comparison.solutions, key=lambda s: s is not comparison.reference)
    moved = {s.model: np.array(list(comparison.probes(s).values())) for s in ordered}
    bars = comparison.bar.uncertainty.bar if comparison.bar is not None else np.full((len(PROBES), 3), np.nan)
    nothing = (None, None, None)
    truth = tables["published model"]
    rows = []
    for i, probe in enumerate(PROBES):
        for name, table in (tables | moved).items():
            of_shell = name == comparison.reference.model
            size = float(np.linalg.norm(truth[i]))
            off = None if name in tables else float(np.linalg.norm(table[i] - truth[i])) / size
            rows.append(
                (probe, name, *map(float, table[i]), *(map(float, bars[i]) if of_shell else nothing), off)
            )
    columns = (
        Column("probe"),
        Column("source"),
        *(_length(name) for name in ("ux", "uy", "uz")),
        *(_length(f"± {name}", ".1g", detail=name != "uz") for name in ("ux", "uy", "uz")),
        Column("off", *PERCENT, ".0f"),
    )
    text = (
        "In the axes of our scene: of test 1 the published y is turned round; a dash where the print cannot "
        "be meant. lumped: consistent springs. k…-lz…: the published k for all springs, equal masses, layers "
        "so many mm apart. ±: what the shell's mesh leaves open. "
        "off: |u − u_model|/|u_model|, of the published model."
    )
    return Table(one.title, columns, tuple(rows), one.name, grouped=True, text=text)


def runs(found: Reproduction) -> Table:
    """A row per run: what it took beside what is published, how far it swings and when it is at rest."""
    settling = found.settling
    assert settling is not None
    rows: list[tuple[Any, ...]] = [("published", "MATLAB R2016a", seed_inputs()["run_time"], *5 * (None,))]
    for model, run in settling.runs.items():
        rows.append(
            (
                model, run.integrator, settling.seconds(model), settling.faster(model), run.steps,
                settling.largest(model), settling.settled(model), float(settling.rest[model][2]),
            )
        )  # fmt: skip
    columns = (
        Column("model"),
        Column("by"),
        Column("time", "s", "s", 1.0, ".3g"),
        Column("times faster", form=".3g"),
        Column("steps", form="d"),
        Column("swing", form=".2f"),
        Column("settled", "s", "s", 1.0, ".3f"),
        _length("rest"),
    )
    text = (
        f"Test 1 from rest, gravity on at t = 0, dampers of our scene {settling.scene.name} (none are "
        f"published); uz of {PROBE}. time: a run on warm code, set-up included. swing: its largest value "
        f"over its static one. settled: from when on it is within {percent(SETTLED)} of that. The published "
        "figure has no numbers to compare with."
    )
    return Table("The settling run", columns, tuple(rows), "settling", text=text)


def nearest(found: Reproduction) -> Table:
    """A row per fit: what was sought, what was found, how near."""
    rows = [
        (
            " and ".join(map(str, fit.tests)), _rod(fit), fit.kind, fit.source,
            *(fit.sought.get(name) for name in ("young", "k", "layer_distance", "tilt", "curvature")),
            fit.by, fit.rms, fit.error, f"{int(fit.met.sum())} of {fit.entries}",
        )
        for fit in found.fits
    ]  # fmt: skip
    columns = (
        Column("tests"),
        Column("rod"),
        Column("of"),
        Column("table", detail=True),
        Column("E", "Pa", "MPa", 1e-6, ".3g"),
        Column("k", "N/m", "N/m", 1.0, ".3g"),
        _length("lz", ".3g"),
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


def ratios(found: Reproduction) -> Table:
    """A row per ratio and scan."""
    rows = [
        (
            r.test, RODS[r.sense], r.name, *(r.published[source] for source in SOURCES), r.kind, r.least,
            r.most, _met(r),
        )
        for r in found.ratios
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


def _met(ratio: Ratio) -> str:
    return " and ".join(source for source in SOURCES if ratio.met(source)) or "neither"


def chords(found: Reproduction) -> Table:
    """A row per pair of points whose distance asks for stretch or for much turning."""
    telling: list[Chord] = [c for c in found.chords if c.stretch > 0.0 or c.turning > TURNING]
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
        _length("flat"),
        _length("published"),
        Column("stretch ≥", *PERCENT, ".2f"),
        Column("span ≥", "rad", "°", 180.0 / np.pi, ".0f"),
    )
    text = (
        "Distances of points, as published and on the flat sheet, where the line of the sheet between them "
        "is stretched for certain, or where its directions span 30° or more unless it is compressed. No "
        "material, support or load enters."
    )
    return Table("What distances ask of any sheet", columns, tuple(rows), "chords", text=text)


def _complaints(found: Reproduction) -> list[str]:
    """A sentence for every model of ours without an answer."""
    return [
        f"{one.title}, {s.model}: {s.status}: {s.status.advice}"
        for one in found.answers
        for s in one.comparison.solutions
        if s.status is not Status.CONVERGED
    ]


def _attachments(found: Reproduction) -> dict[str, Write]:
    """The sheets of every test as VTU, and the histories."""
    files: dict[str, Write] = {}
    for one in found.answers:
        files[f"{one.name}.vtu"] = partial(write_plan, comparison=one.comparison)
        for solution in one.comparison.solutions:
            files[f"{one.name}-{solution.model}.vtu"] = partial(write_solution, solution=solution)
    if found.settling is not None:
        for model, run in found.settling.runs.items():
            files[f"settling-{model}.csv"] = partial(write_text, text=series(run).to_csv())
            files[f"settling-{model}.pvd"] = partial(write_series, shown=frames(run))
    return files


def _draw(kind: str, of: Any, paths: Sequence[Path], look: Look) -> None:
    from comparisons.reproduction.figure import PICTURES, picture

    picture(paths, PICTURES[kind], of, look)
