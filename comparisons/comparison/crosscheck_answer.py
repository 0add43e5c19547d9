"""Every model's limit and bar on every scene, how far from the shell, and where they differ: the answer of
`sheetbench crosscheck`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Annotated, Any

import numpy as np

from comparisons.external.installed import InstalledCode
from comparisons.sweep.limits import Limit, Pair, pairs
from sheetbench.answers.answer import Answer
from sheetbench.answers.solution import Status
from sheetbench.answers.table import MILLIMETRES, PERCENT, Column, Table
from sheetbench.choices import REFERENCE
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few

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
    """The limit of every model, by scene; codes: the external ones, absent too."""

    file_name = "crosscheck"
    scenes: tuple[Scene, ...]
    limits: dict[str, tuple[Limit, ...]]
    codes: tuple[InstalledCode, ...]

    def against(self, scene: str) -> Limit | None:
        """Return what the other models of a scene are compared with: the shell, else the first with a bar."""
        with_bar = [one for one in self.limits[scene] if one.uncertainty is not None]
        return next((one for one in with_bar if one.name == REFERENCE), with_bar[0] if with_bar else None)

    @cached_property
    def pairs(self) -> list[Pair]:
        """Every two models of a scene that have bars."""
        return [pair for limits in self.limits.values() for pair in pairs(limits)]

    def document(self) -> dict[str, Any]:
        """The JSON document of `sheetbench crosscheck`: metres, seconds, fractions."""
        names = {"distinguishable_at": "apart"}
        return {
            "solutions": [_document(one) for one in self._each()],
            "pairs": [{names.get(key, key): v for key, v in asdict(pair).items()} for pair in self.pairs],
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
        return [f"{one.scene.name}, {one.name}: {ended}" for one in self._each() for ended in one.failures]

    def _each(self) -> Iterator[Limit]:
        """Every model of every scene."""
        return (one for limits in self.limits.values() for one in limits)

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
        limits, moved, *codes = self._shown()
        return (limits, moved, Table.of(Pair, self.pairs, "Every two models", "pairs"), *codes)

    def printed(self) -> tuple[Table, ...]:
        """All but every two models, and displacements of one scene alone."""
        limits, moved, *codes = self._shown()
        return (limits, moved, *codes) if self._single else (limits, *codes)

    def _shown(self) -> list[Table]:
        scene = ("scene",) if self._single else ()
        limits = Table.of(
            LimitRow,
            map(self._limit, self._each()),
            "Extrapolated answers",
            "crosscheck",
            details=scene,
            grouped=not self._single,
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
            for one in self.limits[scene.name]
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

    def _limit(self, one: Limit) -> LimitRow:
        scene, bar = one.scene, one.uncertainty
        truth = self.against(scene.name)
        if truth is None or truth.uncertainty is None or bar is None:
            status = str(Status.REFUSED) if one.refused else "no answer"
            return LimitRow(scene.name, one.name, one.meshes or None, differs_from=status)
        u = truth.uncertainty.extrapolated
        probe, axis = np.unravel_index(np.argmax(np.abs(u)), u.shape)
        own = [p for p in self.pairs if p.scene == scene.name and one.name in (p.a, p.b)]
        between = next((p for p in own if {p.a, p.b} == {truth.name, one.name}), None)
        differing = [p.b if p.a == one.name else p.a for p in own if p.distinguishable_at]
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
        return "; ".join(filter(None, map(self._difference, self.scenes)))

    def _difference(self, scene: Scene) -> str:
        rows = map(self._limit, self.limits[scene.name])
        off = [f"{r.model} {few(100 * r.off)} %" for r in rows if r.off is not None]
        truth = self.against(scene.name)
        return f"{scene.name}: {', '.join(off)} from {truth.name}" if off and truth is not None else ""

    def notes(self) -> list[str]:
        """Why models leave scenes out, and what the columns mean."""
        reasons: dict[tuple[str, str], list[str]] = {}
        for one in self._each():
            if one.refused:
                reasons.setdefault((one.name, one.finest.message), []).append(one.scene.name)
        left = (f"{name} leaves out {', '.join(of)}: {why}." for (name, why), of in reasons.items())
        return [*left, EXPLANATION]

    def complaints(self) -> list[str]:
        """The meshes without an answer, and those whose answer is no stable or no physical one."""
        unsound = (f"{one.scene.name}: {ending}" for one in self._each() for ending in one.unsound)
        return [*self.failures, *unsound]

    def choices(self) -> dict[str, Any]:
        """The scenes and the external codes."""
        codes = {one.code.name: one.version for one in self.codes}
        return {"scenes": [scene.name for scene in self.scenes], "judges": codes}

    @property
    def succeeded(self) -> bool:
        """Whether every model that takes a scene has a bar there."""
        return not self.failures and all(one.refused or one.uncertainty for one in self._each())


def _document(one: Limit) -> dict[str, Any]:
    """A model's finest answer as `compare` has it, with its bars."""
    finest = one.finest
    row: dict[str, Any] = {"label": finest.label}
    if finest.status == Status.REFUSED:
        row |= {"settings": finest.ask.spec.settings, "advice": Status.REFUSED.advice}
    row |= finest.document | {"status": finest.status, "message": finest.message}
    row |= {"scene": one.scene.name, "model": one.name, "version": finest.ask.version, "meshes": one.meshes}
    row |= {"failed": one.failures}
    if (bar := one.uncertainty) is not None:
        row["uncertainty"] = dict(zip(one.scene.probes, bar.bar, strict=True))
        row["extrapolated"] = dict(zip(one.scene.probes, bar.extrapolated, strict=True))
        row["order"] = bar.overall_order
    return row
