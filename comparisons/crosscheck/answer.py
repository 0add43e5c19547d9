"""Every model's limit and bar on every scene, how far from the shell, and where they differ: the answer of
`sheetbench crosscheck`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import combinations
from typing import Annotated, Any

import numpy as np

from comparisons.crosscheck.convergence import Convergence, Pair, pair
from comparisons.external.installed import InstalledCode
from sheetbench.answers.answer import Answer
from sheetbench.answers.table import MILLIMETRES, PERCENT, Column, Table
from sheetbench.choices import REFERENCE
from sheetbench.scenes import Scene, Status
from sheetbench.scenes.summary import few

EXPLANATION = (
    "u: the largest component of the displacements at the probes, extrapolated from the meshes (Richardson); "
    "± u: its grid convergence index. off: largest component of u − u_shell over the probes / largest "
    "component of u_shell, both extrapolated; ± off: both bars there. differs from: models whose difference "
    "at some probe exceeds both bars; the others may still differ."
)


@dataclass(frozen=True)
class LimitRow:
    """A model's limit where the sheet moves most, how far off it is, and from whom it differs."""

    scene: str
    model: str
    elements: str | None
    at: str | None = None
    u: Annotated[float | None, MILLIMETRES("z.4f")] = None
    bar: Annotated[float | None, MILLIMETRES(".2g", "± u")] = None
    off: Annotated[float | None, PERCENT("z.2f")] = None
    bars: Annotated[float | None, PERCENT(".2g", "± off")] = None
    differs_from: Annotated[str, Column("differs from", prose=True)] = "none"


@dataclass(frozen=True)
class DisplacementRow:
    """The extrapolated displacement of a probe with its bar."""

    scene: str
    probe: str
    model: str
    displacement: Annotated[Mapping[str, float], MILLIMETRES("z.4f")]
    bar: Annotated[Mapping[str, float], MILLIMETRES(".1g")]


@dataclass(frozen=True)
class CodeRow:
    """An external code: its version, or what it needs to be here."""

    code: str
    called: Annotated[str, Column("what it is", prose=True)]
    version: Annotated[str, Column(prose=True)]


@dataclass(frozen=True, repr=False)
class Crosscheck(Answer):
    """The convergence of every model, by scene; codes: the external ones, absent too."""

    file_name = "crosscheck"
    scenes: tuple[Scene, ...]
    convergences: dict[str, tuple[Convergence, ...]]
    codes: tuple[InstalledCode, ...]

    def against(self, scene: str) -> Convergence | None:
        """Return what the other models of a scene are compared with: the shell, else the first with a bar."""
        with_bar = [one for one in self.convergences[scene] if one.uncertainty is not None]
        return next((one for one in with_bar if one.name == REFERENCE), with_bar[0] if with_bar else None)

    def pairs(self, scene: Scene) -> list[Pair]:
        """Every two models of a scene that have bars."""
        both = combinations(self.convergences[scene.name], 2)
        every = (pair(a, b, list(scene.probes)) for a, b in both)
        return [one for one in every if one is not None]

    def document(self) -> dict[str, Any]:
        """The JSON document of `sheetbench crosscheck`: metres, seconds, fractions."""
        return {
            "solutions": [_document(scene, one) for scene, one in self._each()],
            "pairs": [one.document() for scene in self.scenes for one in self.pairs(scene)],
            "judges": [
                {
                    "name": one.code.name,
                    "version": one.version,
                    "status": "absent" if one.version is None else "found",
                    "needs": one.code.needs,
                }
                for one in self.codes
            ],
            "failed": self.failures,
        }

    @property
    def failures(self) -> list[str]:
        """A sentence for every mesh that has no answer without having been refused."""
        every = (one for of in self.convergences.values() for one in of)
        return [f"{one.scene}, {one.name}: {failure}" for one in every for failure in one.failures]

    def _each(self) -> Iterator[tuple[Scene, Convergence]]:
        """Every scene with every model."""
        return ((scene, one) for scene in self.scenes for one in self.convergences[scene.name])

    @property
    def _single(self) -> bool:
        return len(self.scenes) == 1

    def heading(self) -> tuple[str, str, str]:
        """The scene, or how many there are."""
        if self._single:
            return self.scenes[0].name, self.scenes[0].title, ""
        return "crosscheck", f"{len(self.scenes)} scenes, every model on meshes of its own", ""

    def tables(self) -> tuple[Table, ...]:
        """Limits, displacements, every two models, external codes."""
        pairs = (one for scene in self.scenes for one in self.pairs(scene))
        limits, moved, *codes = self._shown()
        return (limits, moved, Table.of(Pair, pairs, "Every two models", "pairs"), *codes)

    def printed(self) -> tuple[Table, ...]:
        """All but every two models, and displacements of one scene alone."""
        limits, moved, *codes = self._shown()
        return (limits, moved, *codes) if self._single else (limits, *codes)

    def _shown(self) -> list[Table]:
        scene = ("scene",) if self._single else ()
        rows = (self._limit(scene, one) for scene, one in self._each())
        limits = Table.of(
            LimitRow, rows, "Extrapolated answers", "crosscheck", details=scene, grouped=not self._single
        )
        moved = [
            DisplacementRow(
                scene.name,
                probe,
                one.name,
                dict(zip(("ux", "uy", "uz"), bar.extrapolated[i], strict=True)),
                dict(zip(("± ux", "± uy", "± uz"), bar.bar[i], strict=True)),
            )
            for scene in self.scenes
            for i, probe in enumerate(scene.probes)
            for one in self.convergences[scene.name]
            if (bar := one.uncertainty) is not None
        ]
        codes = [
            CodeRow(one.code.name, one.code.called, one.version or f"absent: needs {one.code.needs}")
            for one in self.codes
        ]
        return [
            limits,
            Table.of(DisplacementRow, moved, "Extrapolated displacements", "displacements", details=scene),
            *([Table.of(CodeRow, codes, "External codes", "judges")] if codes else []),
        ]

    def _limit(self, scene: Scene, one: Convergence) -> LimitRow:
        truth = self.against(scene.name)
        if truth is None or truth.uncertainty is None or one.uncertainty is None:
            status = str(Status.REFUSED) if one.refused else "no answer"
            return LimitRow(scene.name, one.name, one.meshes or None, differs_from=status)
        bar, limit = one.uncertainty, truth.uncertainty.extrapolated
        probe, axis = np.unravel_index(np.argmax(np.abs(limit)), limit.shape)
        pairs = self.pairs(scene)
        between = next((p for p in pairs if {p.a, p.b} == {truth.name, one.name}), None)
        differing = [
            p.b if p.a == one.name else p.a for p in pairs if p.distinguishable_at and one.name in (p.a, p.b)
        ]
        return LimitRow(
            scene.name,
            one.name,
            one.meshes,
            f"{list(scene.probes)[int(probe)]} u{'xyz'[int(axis)]}",
            float(bar.extrapolated[probe, axis]),
            float(bar.bar[probe, axis]),
            None if between is None else between.difference,
            None if between is None else between.bars,
            ", ".join(differing) or "none",
        )

    def result(self) -> str:
        """Return how far the models are from the one that they are compared with, scene by scene."""
        return "; ".join(filter(None, map(self._apart, self.scenes)))

    def _apart(self, scene: Scene) -> str:
        rows = [self._limit(scene, one) for one in self.convergences[scene.name]]
        off = [f"{r.model} {few(100 * r.off)} %" for r in rows if r.off is not None]
        truth = self.against(scene.name)
        return f"{scene.name}: {', '.join(off)} from {truth.name}" if off and truth is not None else ""

    def notes(self) -> list[str]:
        """Why models leave scenes out, and what the columns mean."""
        reasons: dict[tuple[str, str], list[str]] = {}
        for scene, one in self._each():
            if one.refused:
                reasons.setdefault((one.name, one.finest["message"]), []).append(scene.name)
        left = (f"{name} leaves out {', '.join(of)}: {why}." for (name, why), of in reasons.items())
        return [*left, EXPLANATION]

    def complaints(self) -> list[str]:
        """The meshes without an answer, and those whose answer is no stable or no physical one."""
        return [
            *self.failures,
            *(f"{scene.name}: {said}" for scene, one in self._each() for said in one.unsound),
        ]

    def choices(self) -> dict[str, Any]:
        """The scenes and the external codes."""
        codes = {one.code.name: one.version for one in self.codes}
        return {"scenes": [scene.name for scene in self.scenes], "judges": codes}

    @property
    def succeeded(self) -> bool:
        """Whether every model that takes a scene has a bar there."""
        return not self.failures and all(one.refused or one.uncertainty for _, one in self._each())


def _document(scene: Scene, one: Convergence) -> dict[str, Any]:
    """A model's finest answer as `compare` has it, with its bars."""
    row = {key: value for key, value in one.finest.items() if key not in ("size", "traceback")}
    row |= {"scene": scene.name, "model": one.name, "version": one.version, "meshes": one.meshes}
    row |= {"failed": one.failures}
    if (bar := one.uncertainty) is not None:
        row["uncertainty"] = dict(zip(scene.probes, bar.bar, strict=True))
        row["extrapolated"] = dict(zip(scene.probes, bar.extrapolated, strict=True))
        row["order"] = bar.overall_order
    return row
