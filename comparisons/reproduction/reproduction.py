"""The study of Habibi et al. again, part by part: findings first, then a table a part, and their pictures.

errors    the printed error table computed again
tables    tests 1 and 2: published model and experiment, our lattices, our shell with its error bar
settling  the run from rest, and what it takes
nearest   which sheets come nearest to the tables, and what in the tables none of them can have
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np

from comparisons.models.grids import Elements
from comparisons.pictures.array_files import write_mesh
from comparisons.reproduction import findings, printed_errors
from comparisons.reproduction.answers import (
    COMPONENTS,
    SETS,
    SOURCES,
    ReproducedTest,
    answer,
    published,
    scene,
)
from comparisons.reproduction.findings import Finding
from comparisons.reproduction.published import KNOWN_FAULTS, PROBES, published_inputs
from comparisons.reproduction.settling import PROBE, SETTLED, Settling, settling
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Picture, Write, drawn_from
from sheetbench.answers.solution import Status
from sheetbench.answers.table import MILLIMETRES, NUMBER, PERCENT, SECONDS, Table, percent
from sheetbench.choices import ELEMENTS, REPRODUCED
from sheetbench.scenes.meaning.words import sheet_in_words

SEED = (
    "Habibi, Yang, Godage, Kang, Walker, Branson: a lumped-mass model for large-deformation "
    "continuum surfaces"
)
DISPLACEMENTS = (
    "In the axes of our scene: the published y of test 1 is reversed; a dash where a printed value must be "
    "a misprint. lumped: consistent springs. k…-lz…: the published k everywhere, equal masses, layers "
    "at this distance in mm. ±: mesh error of the shell. off: |u − u_model|/|u_model|, against the published "
    "model."
)
MOVED = (
    *("probe", "source"),
    *(MILLIMETRES("z.2f", name) for name in COMPONENTS),
    *(MILLIMETRES(".1g", f"± {name}", detail=name != "uz") for name in COMPONENTS),
    PERCENT(".0f", "off"),
)
RUNS = (
    *("model", "by", SECONDS(".3g", "time"), NUMBER(".3g", "times faster"), NUMBER("d", "steps")),
    *(NUMBER(".2f", "swing"), SECONDS(".3f", "settled"), MILLIMETRES("z.2f", "rest")),
)
POINTS = "P1 is the centre, P2 and P3 the middles of two free sides, P4 the corner farthest from the support."


@dataclass(frozen=True, repr=False)
class Reproduction(Answer):
    """What each part found; empty, or None, where a part was not requested."""

    file_name = "reproduction"
    parts: tuple[str, ...]
    elements: Elements
    answers: tuple[ReproducedTest, ...] = ()
    settling: Settling | None = None

    @property
    def cells(self) -> list[printed_errors.Cell]:
        """The printed errors, computed again."""
        return printed_errors.cells() if "errors" in self.parts else []

    def findings(self) -> list[Finding]:
        """Return every finding of the parts there are."""
        return [
            *(printed_errors.findings(self.cells) if self.cells else ()),
            *findings.of_tables(self.answers),
            *(Finding(**one) for one in findings.stored()["findings"] if "nearest" in self.parts),
        ]

    @property
    def succeeded(self) -> bool:
        """Whether our own models have answers; lattices of the published k need not."""
        runs = self.settling.runs.values() if self.settling is not None else ()
        moved = all(run.status is Status.CONVERGED for run in runs)
        return moved and all(one.comparison.succeeded for one in self.answers)

    def document(self) -> dict[str, Any]:
        document: dict[str, Any] = {
            "parts": list(self.parts),
            "inputs": published_inputs(),
            "known_faults": list(KNOWN_FAULTS),
            "findings": [vars(one) for one in self.findings()],
        }
        if self.cells:
            document["errors"] = printed_errors.as_dict(self.cells)
        if "nearest" in self.parts:
            document["nearest"] = findings.stored()["fits"]
        if self.answers:
            document["tests"] = [
                {"test": one.test, "sense": one.sense, "name": one.name, **one.comparison.document()}
                for one in self.answers
            ]
        if self.settling is not None:
            document["settling"] = self.settling.as_dict()
        return document

    def heading(self) -> tuple[str, str, str]:
        """Return what was published, its tests and its sheet."""
        first, second = scene(1), scene(2)
        sheet = sheet_in_words(first.sheet, first.material)
        lead = f"{SEED}. {first.title}. {second.title}. {sheet}. {POINTS}"
        return (
            "The study of Habibi et al., reproduced",
            "what was published, what the same inputs give, and what comes nearest to it",
            lead,
        )

    def tables(self) -> list[Table]:
        return [
            Table.of(Finding, self.findings(), "Findings", "findings", grouped=True),
            *([printed_errors.table(self.cells)] if self.cells else ()),
            *map(displacements, self.answers),
            *([runs(self.settling)] if self.settling else ()),
            *([findings.nearest_table()] if "nearest" in self.parts else ()),
        ]

    def figures(self) -> list[Picture]:
        compose = "comparisons.reproduction.figure:test"
        return [Picture(one.name, compose, (one,), drawn_from([displacements(one)])) for one in self.answers]

    def notes(self) -> list[str]:
        return [DISPLACEMENTS] if self.answers else []

    def complaints(self) -> list[str]:
        """Return a sentence for every model of ours without an answer."""
        return [
            f"{one.title}, {s.model}: {s.status}: {s.status.advice}"
            for one in self.answers
            for s in one.comparison.solutions
            if s.status is not Status.CONVERGED
        ]

    def files(self) -> dict[str, Write]:
        """Return the sheets of every test as VTU, and the histories."""
        files: dict[str, Write] = {}
        for one in self.answers:
            files[f"{one.name}.vtu"] = one.comparison.write_plan
            for solution in one.comparison.solutions:
                files[f"{one.name}-{solution.model}.vtu"] = partial(write_mesh, mesh=solution.mesh)
        for model, run in self.settling.runs.items() if self.settling is not None else ():
            files[f"settling-{model}.csv"] = partial(write_text, text=run.series().to_csv())
        return files

    def choices(self) -> dict[str, Any]:
        return {"parts": list(self.parts), "elements": self.elements}


def reproduce(parts: Collection[str] = REPRODUCED, elements: Elements = ELEMENTS) -> Reproduction:
    """Return these parts of the study; elements: of the shell."""
    parts_done: dict[str, Any] = {}
    if "tables" in parts:
        parts_done["answers"] = tuple(answer(*one, elements) for one in SETS)
    if "settling" in parts:
        parts_done["settling"] = settling()
    return Reproduction(tuple(part for part in REPRODUCED if part in parts), elements, **parts_done)


def displacements(one: ReproducedTest) -> Table:
    """Return a row per probe and source: published, our lattices, our shell with its bar, and the difference
    from the published model."""
    comparison = one.comparison
    tables = {f"published {source}": published(one.test, source) for source in SOURCES}
    ordered = sorted(comparison.solutions, key=lambda s: s is not comparison.reference)
    moved = {s.model: np.array(list(comparison.probes(s).values())) for s in ordered}
    bars = comparison.bar.uncertainty.bar if comparison.bar is not None else np.full((len(PROBES), 3), np.nan)
    truth = tables["published model"]
    rows = []
    for i, probe in enumerate(PROBES):
        for name, table in (tables | moved).items():
            own = bars[i].tolist() if name == comparison.reference.model else [None] * 3
            off = float(np.linalg.norm(table[i] - truth[i])) / float(np.linalg.norm(truth[i]))
            rows.append([probe, name, *table[i].tolist(), *own, None if name in tables else off])
    text = "Displacements as published, and of our models with the published inputs."
    return Table.listed(one.title, MOVED, rows, one.name, grouped=True, text=text)


def runs(settling: Settling) -> Table:
    """Return a row per run: what it took beside what is published, how far it swings and when it is at
    rest."""
    rows: list[list[Any]] = [["published", "MATLAB R2016a", published_inputs()["run_time"], *[None] * 5]]
    for model, run in settling.runs.items():
        took, swing = [settling.seconds(model), settling.faster(model)], settling.largest(model)
        rest = [swing, settling.settled(model), float(settling.rest[model][2])]
        rows.append([model, run.integrator, *took, run.steps, *rest])
    text = (
        f"Test 1 from rest, gravity on at t = 0, dampers of our scene {settling.scene.name} (none are "
        f"published); uz of {PROBE}. time: a run on warm code, set-up included. swing: its largest value "
        f"over its static one. settled: time from which it stays within {percent(SETTLED)} of that. "
        "The published curve is a picture without values."
    )
    return Table.listed("The settling run", RUNS, rows, "settling", text=text)
