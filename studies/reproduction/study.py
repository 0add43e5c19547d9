"""Reproduction of the study of Habibi et al. in parts: findings, then a table per part, and figures.

errors    the printed error table, recomputed
tables    tests 1 and 2: published model and experiment, our lattices, our shell with its error bar
settling  the simulation from rest and its time
nearest   the sheets nearest to the published tables, and values of the tables that no sheet reproduces
"""

from collections.abc import Collection
from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

import numpy as np

from comparisons.models.grids import Elements
from comparisons.pictures.array_files import write_mesh
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Picture, Write, drawn_from
from sheetbench.answers.solution import Status
from sheetbench.answers.table import MILLIMETRES, NUMBER, PERCENT, SECONDS, Column, Table, percent
from sheetbench.choices import ELEMENTS
from sheetbench.scenes.meaning.words import sheet_in_words
from studies.reproduction import findings, printed_errors
from studies.reproduction.answers import (
    COMPONENTS,
    SETS,
    SOURCES,
    ReproducedTest,
    answer,
    published,
    scene,
)
from studies.reproduction.findings import Finding
from studies.reproduction.published import KNOWN_FAULTS, PROBES, published_inputs
from studies.reproduction.settling import PROBE, SETTLED, Settling, settling

PARTS = ("errors", "tables", "settling", "nearest")
STUDY = (
    "Habibi, Yang, Godage, Kang, Walker, Branson: a lumped-mass model for large-deformation "
    "continuum surfaces"
)
DISPLACEMENTS = (
    "In the axes of our scene: the published y of test 1 is reversed; a dash stands for a misprint. lumped: "
    "consistent springs. k…-lz…: the published k for all springs, equal masses, layers at this distance in "
    "mm. ±: mesh error of the shell. difference: |u − u_model|/|u_model| from the published model."
)
POINTS = "P1 is the centre, P2 and P3 the middles of two free sides, P4 the corner farthest from the support."


@dataclass(frozen=True)
class ProbeRow:
    """Displacement of a probe by a published source or a model, [m]; bars: the shell's mesh error."""

    probe: str
    source: str
    displacement: dict[Column, float]
    bars: dict[Column, float | None]
    difference: Annotated[float | None, PERCENT(".0f")]


@dataclass(frozen=True)
class RunRow:
    """A settling run: its time and steps, and uz of P4 as `runs` describes it."""

    model: str
    by: str
    time: Annotated[float, SECONDS(".3g")]
    times_faster: Annotated[float | None, NUMBER(".3g")]
    steps: Annotated[int | None, NUMBER("d")]
    swing: Annotated[float | None, NUMBER(".2f")]
    settled: Annotated[float | None, SECONDS(".3f")]
    rest: Annotated[float | None, MILLIMETRES("z.2f")]


@dataclass(frozen=True, repr=False)
class Reproduction(Answer):
    """The results of the requested parts; a part that was not requested is empty or None."""

    file_name = "reproduction"
    parts: tuple[str, ...]
    elements: Elements
    answers: tuple[ReproducedTest, ...] = ()
    settling: Settling | None = None

    @property
    def cells(self) -> list[printed_errors.Cell]:
        """The printed errors, recomputed."""
        return printed_errors.cells() if "errors" in self.parts else []

    def findings(self) -> list[Finding]:
        """Return the findings of all requested parts."""
        return [
            *(printed_errors.findings(self.cells) if self.cells else ()),
            *findings.of_tables(self.answers),
            *(Finding(**entry) for entry in findings.stored()["findings"] if "nearest" in self.parts),
        ]

    @property
    def succeeded(self) -> bool:
        """Whether our own models have answers; lattices of the published k may fail."""
        runs = self.settling.runs.values() if self.settling is not None else ()
        settled = all(run.status is Status.CONVERGED for run in runs)
        return settled and all(test.comparison.succeeded for test in self.answers)

    def document(self) -> dict[str, Any]:
        document: dict[str, Any] = {
            "parts": list(self.parts),
            "inputs": published_inputs(),
            "known_faults": list(KNOWN_FAULTS),
            "findings": [vars(finding) for finding in self.findings()],
        }
        if self.cells:
            document["errors"] = printed_errors.as_dict(self.cells)
        if "nearest" in self.parts:
            document["nearest"] = findings.stored()["fits"]
        if self.answers:
            document["tests"] = [
                {"test": a.test, "sense": a.sense, "name": a.name, **a.comparison.document()}
                for a in self.answers
            ]
        if self.settling is not None:
            document["settling"] = self.settling.as_dict()
        return document

    def heading(self) -> tuple[str, str, str]:
        """Return the title, and a lead with the publication, its tests and its sheet."""
        first, second = scene(1), scene(2)
        sheet = sheet_in_words(first.sheet, first.material)
        lead = f"{STUDY}. {first.title}. {second.title}. {sheet}. {POINTS}"
        subtitle = "published values, our results for the published inputs, and the nearest fits"
        return "The study of Habibi et al., reproduced", subtitle, lead

    def tables(self) -> list[Table]:
        return [
            Table.of(Finding, self.findings(), "Findings", "findings", grouped=True),
            *([printed_errors.table(self.cells)] if self.cells else ()),
            *map(displacements, self.answers),
            *([runs(self.settling)] if self.settling else ()),
            *([findings.nearest_table()] if "nearest" in self.parts else ()),
        ]

    def figures(self) -> list[Picture]:
        compose = "studies.reproduction.figure:test"
        return [Picture(a.name, compose, (a,), drawn_from([displacements(a)])) for a in self.answers]

    def notes(self) -> list[str]:
        return [DISPLACEMENTS] if self.answers else []

    def complaints(self) -> list[str]:
        """Return a sentence for every model without a converged answer."""
        return [
            f"{test.title}, {s.model}: {s.status}: {s.status.advice}"
            for test in self.answers
            for s in test.comparison.solutions
            if s.status is not Status.CONVERGED
        ]

    def files(self) -> dict[str, Write]:
        """Return the sheets of every test as VTU, and the histories."""
        files: dict[str, Write] = {}
        for test in self.answers:
            files[f"{test.name}.vtu"] = test.comparison.write_plan
            for solution in test.comparison.solutions:
                files[f"{test.name}-{solution.model}.vtu"] = partial(write_mesh, mesh=solution.mesh)
        for model, run in self.settling.runs.items() if self.settling is not None else ():
            files[f"settling-{model}.csv"] = partial(write_text, text=run.series().to_csv())
        return files

    def choices(self) -> dict[str, Any]:
        return {"parts": list(self.parts), "elements": self.elements}


def reproduce(parts: Collection[str] = PARTS, elements: Elements = ELEMENTS) -> Reproduction:
    """Reproduce parts of the study; elements: of the shell."""
    results: dict[str, Any] = {}
    if "tables" in parts:
        results["answers"] = tuple(answer(test, sense, elements) for test, sense in SETS)
    if "settling" in parts:
        results["settling"] = settling()
    return Reproduction(tuple(part for part in PARTS if part in parts), elements, **results)


def displacements(reproduced: ReproducedTest) -> Table:
    """Return a table of displacements with a row per probe and source, published or a model of ours."""
    comparison = reproduced.comparison
    tables = {f"published {source}": published(reproduced.test, source) for source in SOURCES}
    ordered = sorted(comparison.solutions, key=lambda s: s is not comparison.reference)
    computed = {s.model: np.array(list(comparison.probes(s).values())) for s in ordered}
    bars = comparison.bar.uncertainty.bar if comparison.bar is not None else np.full((len(PROBES), 3), np.nan)
    truth = tables["published model"]
    values = [MILLIMETRES("z.2f", name) for name in COMPONENTS]
    margins = [MILLIMETRES(".1g", f"± {name}", detail=name != "uz") for name in COMPONENTS]
    rows = []
    for i, probe in enumerate(PROBES):
        for name, table in (tables | computed).items():
            bar = bars[i].tolist() if name == comparison.reference.model else [None] * 3
            difference = float(np.linalg.norm(table[i] - truth[i]) / np.linalg.norm(truth[i]))
            rows.append(
                ProbeRow(
                    *(probe, name),
                    dict(zip(values, table[i].tolist(), strict=True)),
                    dict(zip(margins, bar, strict=True)),
                    None if name in tables else difference,
                )
            )
    text = "Displacements as published, and of our models with the published inputs."
    return Table.of(ProbeRow, rows, reproduced.title, reproduced.name, grouped=True, text=text)


def runs(settling: Settling) -> Table:
    """Return a table of the settling runs, beside the published run time."""
    seconds = published_inputs()["run_time"]
    rows = [RunRow("published", "MATLAB R2016a", seconds, None, None, None, None, None)]
    for model, run in settling.runs.items():
        rows.append(
            RunRow(
                *(model, run.integrator, settling.seconds(model), settling.faster(model), run.steps),
                *(settling.largest(model), settling.settled(model), float(settling.rest[model][2])),
            )
        )
    text = (
        f"Test 1 from rest, gravity on at t = 0, dampers of our scene {settling.scene.name} (none are "
        f"published); uz of {PROBE}. time: a run on warm code, set-up included. swing: its largest value "
        f"over its static one. settled: time from which it stays within {percent(SETTLED)} of that. "
        "The published curve is a picture without values."
    )
    return Table.of(RunRow, rows, "The settling run", "settling", text=text)
