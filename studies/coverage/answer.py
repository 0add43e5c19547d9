"""The answer of the coverage study: components, a row per model and mesh, and what lies outside its bars."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from functools import partial
from itertools import groupby
from typing import Annotated, Any

import numpy as np

from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import NUMBER, PERCENT, Column, Table
from sheetbench.scenes.summary import few

GOAL, LOOSE = 0.95, 5.0  # share inside, and median of bar/error, that are asked for
_METRES = Column(unit="m")


@dataclass(frozen=True)
class Component:
    """A component of the displacement at a probe: answer, truth and bar [m], observed order, nan if none."""

    scene: str
    model: str
    elements: int
    probe: str
    component: str
    answer: Annotated[float, _METRES]
    truth: Annotated[float, _METRES]
    bar: Annotated[float, _METRES]
    order: float

    @property
    def error(self) -> float:
        """|u − u_true| [m]."""
        return abs(self.answer - self.truth)

    @property
    def inside(self) -> Annotated[bool, Column(words=("True", "False"))]:
        """Whether the bar holds the error."""
        return self.error <= self.bar


@dataclass(frozen=True)
class Share:
    """A model on a mesh: the share of its components inside their bars, the median of bar over error, the
    largest error over its bar."""

    model: str
    elements: Annotated[int, NUMBER("d")]
    scenes: Annotated[int, NUMBER("d")]
    components: Annotated[int, NUMBER("d")]
    inside: Annotated[float, PERCENT(".1f")]
    loose: Annotated[float, NUMBER(".3g", "median bar/error")]
    farthest: Annotated[float, NUMBER(".3g", "largest error/bar")]
    met: Annotated[bool, Column("ok", words=("yes", "NO"))]


@dataclass(frozen=True)
class Miss:
    """A scene with components outside their bars, and the worst of them in parts of the largest
    displacement."""

    model: str
    elements: Annotated[int, NUMBER("d")]
    scene: str
    outside: Annotated[int, NUMBER("d")]
    worst: str
    error: Annotated[float, PERCENT(".2g", "its error")]
    bar: Annotated[float, PERCENT(".2g", "its bar")]
    order: Annotated[float, NUMBER(".1f")]


@dataclass(frozen=True, repr=False)
class Coverage(Answer):
    """components: of all scenes, models and meshes; scenes: their names; skipped: scenes that were replaced,
    and why; truth: elements of the truth by model."""

    file_name = "coverage"

    components: tuple[Component, ...]
    scenes: tuple[str, ...]
    skipped: dict[str, str]
    truth: Mapping[str, int]

    def shares(self) -> list[Share]:
        """Return a row per model and mesh."""
        keys = dict.fromkeys((c.model, c.elements) for c in self.components)
        return [self._share(model, elements) for model, elements in keys]

    def _of(self, model: str, elements: int) -> list[Component]:
        return [c for c in self.components if (c.model, c.elements) == (model, elements)]

    def _share(self, model: str, elements: int) -> Share:
        of = self._of(model, elements)
        inside = float(np.mean([c.inside for c in of]))
        ratios = [c.bar / c.error for c in of if c.error > 0.0]
        loose = float(np.median(ratios)) if ratios else float("nan")
        farthest = max((c.error / c.bar for c in of if c.bar > 0.0), default=float("nan"))
        met = inside >= GOAL and not loose > LOOSE
        return Share(model, elements, len({c.scene for c in of}), len(of), inside, loose, farthest, met)

    def _misses(self) -> list[Miss]:
        rows = []
        outside = [c for c in self.components if not c.inside]
        for (model, elements, scene), some in groupby(outside, key=lambda c: (c.model, c.elements, c.scene)):
            of_scene = list(some)
            worst = max(of_scene, key=lambda c: c.error / c.bar if c.bar > 0.0 else float("inf"))
            size = max(abs(c.truth) for c in self._of(model, elements) if c.scene == scene)
            where, off, bar = f"{worst.component} of {worst.probe}", worst.error / size, worst.bar / size
            rows.append(Miss(model, elements, scene, len(of_scene), where, off, bar, worst.order))
        return sorted(rows, key=lambda row: (row.model, row.elements))

    @property
    def succeeded(self) -> bool:
        """Whether every bar holds as often as is asked for, and is no looser."""
        return all(row.met for row in self.shares())

    def heading(self) -> tuple[str, str, str]:
        return "coverage", "how often the references' error bars hold the error, on drawn scenes", ""

    def document(self) -> dict[str, Any]:
        return {
            "rows": [asdict(row) for row in self.shares()],
            "scenes": list(self.scenes),
            "skipped": self.skipped,
            "truth": dict(self.truth),
            "components": [{**asdict(c), "inside": c.inside} for c in self.components],
        }

    def tables(self) -> tuple[Table, ...]:
        inside = "Components of the displacement inside their error bars"
        outside = "Scenes with components outside, in per cent of the largest displacement"
        return (
            Table.of(Share, self.shares(), inside, "coverage"),
            Table.of(Miss, self._misses(), outside, "misses", grouped=True),
        )

    def notes(self) -> list[str]:
        inside = (
            "inside: error ≤ bar. The truth is the same model on a finer graded mesh. Asked for: at least "
            "95 % inside, and a median bar of no more than five times the error."
        )
        replaced = f"Replaced, for a model did not converge on a mesh: {', '.join(self.skipped)}."
        return [inside, *([replaced] if self.skipped else [])]

    def complaints(self) -> list[str]:
        return [
            f"{row.model}, {row.elements} elements: {100.0 * row.inside:.1f} % inside, "
            f"the median bar {few(row.loose)} times the error"
            for row in self.shares()
            if not row.met
        ]

    def files(self) -> dict[str, Write]:
        fields = (*Component.__dataclass_fields__, "inside")
        components = Table.of(Component, self.components, "", fields=fields)
        return {"components.csv": partial(write_text, text=components.to_csv())}

    def choices(self) -> dict[str, Any]:
        return {"scenes": len(self.scenes)}
