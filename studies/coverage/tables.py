"""The tables of the coverage study: a row per model and mesh, and the scenes with components outside."""

from __future__ import annotations

from itertools import groupby
from typing import TYPE_CHECKING

from sheetbench.answers.table import Column, Table

if TYPE_CHECKING:
    from studies.coverage.study import Coverage

_RATIO = ("", "", 1.0, ".3g")


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
