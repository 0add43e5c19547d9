"""The tables of the coverage study: a row per model and mesh, and the scenes with components outside."""

from __future__ import annotations

from functools import partial
from itertools import groupby
from typing import TYPE_CHECKING

from sheetbench.answers.files import write_text
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table
from sheetbench.scenes.summary import few

if TYPE_CHECKING:
    from studies.coverage.study import Coverage

_RATIO = ("", "", 1.0, ".3g")


def report(coverage: Coverage) -> Report:
    """What `sheetbench study coverage` shows."""
    return Report(
        name="coverage",
        title="coverage",
        subtitle="how often the references' error bars hold the error, on drawn scenes",
        document=coverage.as_dict(),
        tables=(shares(coverage), misses(coverage)),
        notes=tuple(_notes(coverage)),
        complaints=tuple(
            f"{row['model']}, {row['elements']} elements: {100.0 * row['inside']:.1f} % inside, "
            f"the median bar {few(row['loose'])} times the error"
            for row in coverage.rows()
            if not row["met"]
        ),
        attachments={"components.csv": partial(write_text, text=components(coverage).to_csv())},
        settings={"scenes": len(coverage.scenes)},
        met=coverage.met,
    )


def _notes(coverage: Coverage) -> list[str]:
    sentences = [
        "inside: error ≤ bar. The truth is the same model on a finer graded mesh. Asked for: at least 95 % "
        "inside, and a median bar of no more than five times the error."
    ]
    if coverage.skipped:
        sentences.append(
            "Replaced, for a model did not converge on a mesh: " + ", ".join(coverage.skipped) + "."
        )
    return sentences


def shares(coverage: Coverage) -> Table:
    """A row per model and mesh."""
    keys = ("model", "elements", "scenes", "components", "inside", "loose", "farthest")
    columns = (
        Column("model"),
        Column("elements", form="d"),
        Column("scenes", form="d"),
        Column("components", form="d"),
        Column("inside", "", "%", 100.0, ".1f"),
        Column("median bar/error", *_RATIO),
        Column("largest error/bar", *_RATIO),
        Column("ok"),
    )
    rows = tuple((*(row[key] for key in keys), "yes" if row["met"] else "NO") for row in coverage.rows())
    return Table("Components of the displacement inside their error bars", columns, rows, "coverage")


def misses(coverage: Coverage) -> Table:
    """A row per model, mesh and scene with components outside their bars."""
    rows = []
    outside = [c for c in coverage.components if not c.inside]
    for (model, elements, scene), some in groupby(outside, key=lambda c: (c.model, c.elements, c.scene)):
        of_scene = list(some)
        worst = max(of_scene, key=lambda c: c.error / c.bar if c.bar > 0.0 else float("inf"))
        size = max(abs(c.truth) for c in coverage.of(model, elements) if c.scene == scene)
        where, shares = f"{worst.component} of {worst.probe}", (worst.error / size, worst.bar / size)
        rows.append((model, elements, scene, len(of_scene), where, *shares, worst.order))
    columns = (
        Column("model"),
        Column("elements", form="d"),
        Column("scene"),
        Column("outside", form="d"),
        Column("worst"),
        Column("its error", "", "%", 100.0, ".2g"),
        Column("its bar", "", "%", 100.0, ".2g"),
        Column("order", form=".1f"),
    )
    rows.sort(key=lambda row: row[:2])
    caption = "Scenes with components outside, in per cent of the largest displacement"
    return Table(caption, columns, tuple(rows), "misses", grouped=True)


def components(coverage: Coverage) -> Table:
    """A row per component, lengths in metres."""
    names = ("scene", "model", "elements", "probe", "component", "answer", "truth", "bar", "order", "inside")
    units = {"answer": "m", "truth": "m", "bar": "m"}
    rows = tuple(tuple(getattr(c, name) for name in names) for c in coverage.components)
    return Table("", tuple(Column(name, units.get(name, "")) for name in names), rows)
