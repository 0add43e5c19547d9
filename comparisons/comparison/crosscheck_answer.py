"""Every model's limit and bar on every scene, how far from the shell, and where they differ: the answer of
`sheetbench crosscheck`."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cached_property
from typing import Any

import numpy as np

from comparisons.external.answer import ExternalCode
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


LIMITS = (
    *("model", "elements", "at", MILLIMETRES("z.4f", "u"), MILLIMETRES(".2g", "± u")),
    *(PERCENT("z.2f", "off"), PERCENT(".2g", "± off"), Column("differs from", prose=True)),
)
CODES = ("code", Column("what it is", prose=True), Column("version", prose=True))


@dataclass(frozen=True, repr=False)
class Crosscheck(Answer):
    """The limit of every model, by scene; codes: the external ones, absent too."""

    file_name = "crosscheck"
    scenes: tuple[Scene, ...]
    limits: dict[str, tuple[Limit, ...]]
    codes: Mapping[str, ExternalCode]

    def against(self, scene: str) -> Limit | None:
        """Return what the other models of a scene are compared with: the shell, else the first with a bar."""
        with_bar = [one for one in self.limits[scene] if one.uncertainty is not None]
        return next((one for one in with_bar if one.name == REFERENCE), with_bar[0] if with_bar else None)

    @cached_property
    def pairs(self) -> list[Pair]:
        """Every two models of a scene that have bars."""
        return [pair for limits in self.limits.values() for pair in pairs(limits)]

    def document(self) -> dict[str, Any]:
        names = {"distinguishable_at": "apart"}
        return {
            "solutions": [_document(one) for one in self._each()],
            "pairs": [{names.get(key, key): v for key, v in asdict(pair).items()} for pair in self.pairs],
            "judges": [
                {"name": one.name, "version": (version := one.version()), "needs": one.needs}
                | {"status": "absent" if version is None else "found"}
                for one in self.codes.values()
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

    def heading(self) -> tuple[str, str, str]:
        if len(self.scenes) == 1:
            return self.scenes[0].name, self.scenes[0].title, ""
        return "crosscheck", f"{len(self.scenes)} scenes, every model on meshes of its own", ""

    def tables(self) -> tuple[Table, ...]:
        limits, *codes = self.printed()
        return (limits, Table.of(Pair, self.pairs, "Every two models", "pairs"), *codes)

    def printed(self) -> tuple[Table, ...]:
        """All but every two models."""
        single = len(self.scenes) == 1
        columns = (Column("scene", detail=single), *LIMITS)
        limits = [(one.scene.name, one.name, *self._limit(one)) for one in self._each()]
        needs = "absent: needs {}".format
        codes = [(one.name, one.called, one.version() or needs(one.needs)) for one in self.codes.values()]
        return (
            Table.listed("Extrapolated answers", columns, limits, "crosscheck", grouped=not single),
            *([Table.listed("External codes", CODES, codes, "judges")] if codes else []),
        )

    def _limit(self, one: Limit) -> tuple[Any, ...]:
        """Return a model's limit where the sheet moves most, how far off it is, and from whom it differs."""
        truth, bar, scene = self.against(one.scene.name), one.uncertainty, one.scene
        if truth is None or truth.uncertainty is None or bar is None:
            status = Status.REFUSED if one.refused else "no answer"
            return (one.meshes or None, *[None] * 5, str(status))
        u = truth.uncertainty.extrapolated
        probe, axis = np.unravel_index(np.argmax(np.abs(u)), u.shape)
        own = [p for p in self.pairs if p.scene == scene.name and one.name in (p.a, p.b)]
        differing = [p.b if p.a == one.name else p.a for p in own if p.distinguishable_at]
        at = f"{list(scene.probes)[int(probe)]} u{'xyz'[int(axis)]}"
        off = self._off(one)
        apart = (None, None) if off is None else (off.difference, off.bars)
        own_u = (float(bar.extrapolated[probe, axis]), float(bar.bar[probe, axis]))
        return (one.meshes, at, *own_u, *apart, ", ".join(differing) or "none")

    def _off(self, one: Limit) -> Pair | None:
        """Return how far a model is from the one that others are compared with, None of that one itself."""
        truth = self.against(one.scene.name)
        names = {one.name, truth.name if truth else ""}
        return next((p for p in self.pairs if p.scene == one.scene.name and {p.a, p.b} == names), None)

    def result(self) -> str:
        """Return how far the models are from the one that they are compared with, scene by scene."""
        return "; ".join(filter(None, map(self._difference, self.scenes)))

    def _difference(self, scene: Scene) -> str:
        both = [(one.name, self._off(one)) for one in self.limits[scene.name]]
        off = [f"{name} {few(100 * pair.difference)} %" for name, pair in both if pair is not None]
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
        codes = {one.name: one.version() for one in self.codes.values()}
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
