"""Converged limits and error bars of models on scenes, and their differences: the answer of `sheetbench
crosscheck`."""

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
    """The converged limits of all models, by scene; codes: external codes, installed or not."""

    file_name = "crosscheck"
    scenes: tuple[Scene, ...]
    limits: dict[str, tuple[Limit, ...]]
    codes: Mapping[str, ExternalCode]

    def reference_limit(self, scene: str) -> Limit | None:
        """Return the limit for comparisons on a scene: the shell's, else the first with a bar."""
        with_bar = [limit for limit in self.limits[scene] if limit.uncertainty is not None]
        return next(
            (limit for limit in with_bar if limit.name == REFERENCE), with_bar[0] if with_bar else None
        )

    @cached_property
    def pairs(self) -> list[Pair]:
        """Pairs of models of a scene that both have error bars."""
        return [pair for limits in self.limits.values() for pair in pairs(limits)]

    def document(self) -> dict[str, Any]:
        names = {"distinguishable_at": "apart"}
        return {
            "solutions": [_document(limit) for limit in self._all_limits()],
            "pairs": [{names.get(key, key): v for key, v in asdict(pair).items()} for pair in self.pairs],
            "judges": [
                {"name": code.name, "version": (version := code.version()), "needs": code.needs}
                | {"status": "absent" if version is None else "found"}
                for code in self.codes.values()
            ],
            "failed": self.failures,
        }

    @property
    def failures(self) -> list[str]:
        """Failed meshes, a sentence each; refusals are not failures."""
        return [
            f"{limit.scene.name}, {limit.name}: {text}"
            for limit in self._all_limits()
            for text in limit.failures
        ]

    def _all_limits(self) -> Iterator[Limit]:
        """Yield the limits of all models of all scenes."""
        return (limit for limits in self.limits.values() for limit in limits)

    def heading(self) -> tuple[str, str, str]:
        if len(self.scenes) == 1:
            return self.scenes[0].name, self.scenes[0].title, ""
        return "crosscheck", f"{len(self.scenes)} scenes, every model on its own meshes", ""

    def tables(self) -> tuple[Table, ...]:
        limits, *codes = self.printed()
        return (limits, Table.of(Pair, self.pairs, "Every two models", "pairs"), *codes)

    def printed(self) -> tuple[Table, ...]:
        """Return the tables without the pairs of models."""
        single = len(self.scenes) == 1
        columns = (Column("scene", detail=single), *LIMITS)
        limits = [(limit.scene.name, limit.name, *self._limit(limit)) for limit in self._all_limits()]
        codes = [(c.name, c.called, c.version() or f"absent: needs {c.needs}") for c in self.codes.values()]
        return (
            Table.listed("Extrapolated answers", columns, limits, "crosscheck", grouped=not single),
            *([Table.listed("External codes", CODES, codes, "judges")] if codes else []),
        )

    def _limit(self, limit: Limit) -> tuple[Any, ...]:
        """Return the values of `LIMITS` from the second on, for the component of largest displacement."""
        truth, bar, scene = self.reference_limit(limit.scene.name), limit.uncertainty, limit.scene
        if truth is None or truth.uncertainty is None or bar is None:
            status = Status.REFUSED if limit.refused else "no answer"
            return (limit.meshes or None, *[None] * 5, str(status))
        u = truth.uncertainty.extrapolated
        probe, axis = np.unravel_index(np.argmax(np.abs(u)), u.shape)
        pairs = [p for p in self.pairs if p.scene == scene.name and limit.name in (p.a, p.b)]
        differing = [p.b if p.a == limit.name else p.a for p in pairs if p.distinguishable_at]
        at = f"{list(scene.probes)[int(probe)]} u{'xyz'[int(axis)]}"
        pair = self._pair_with_truth(limit)
        difference = (None, None) if pair is None else (pair.difference, pair.bars)
        value = (float(bar.extrapolated[probe, axis]), float(bar.bar[probe, axis]))
        return (limit.meshes, at, *value, *difference, ", ".join(differing) or "none")

    def _pair_with_truth(self, limit: Limit) -> Pair | None:
        """Return the pair of a model and the model of `reference_limit`, None for the latter itself."""
        truth = self.reference_limit(limit.scene.name)
        names = {limit.name, truth.name if truth else ""}
        return next((p for p in self.pairs if p.scene == limit.scene.name and {p.a, p.b} == names), None)

    def result(self) -> str:
        """Return the differences of all models from the model of `reference_limit`, scene by scene."""
        return "; ".join(filter(None, map(self._difference, self.scenes)))

    def _difference(self, scene: Scene) -> str:
        pairs = [(limit.name, self._pair_with_truth(limit)) for limit in self.limits[scene.name]]
        texts = [f"{name} {few(100 * pair.difference)} %" for name, pair in pairs if pair is not None]
        truth = self.reference_limit(scene.name)
        return f"{scene.name}: {', '.join(texts)} from {truth.name}" if texts and truth is not None else ""

    def notes(self) -> list[str]:
        """Return the reasons of refusals, and an explanation of the columns."""
        refusals: dict[tuple[str, str], list[str]] = {}
        for limit in self._all_limits():
            if limit.refused:
                refusals.setdefault((limit.name, limit.finest.message), []).append(limit.scene.name)
        notes = (f"{name} leaves out {', '.join(of)}: {reason}." for (name, reason), of in refusals.items())
        return [*notes, EXPLANATION]

    def complaints(self) -> list[str]:
        """Return the failed meshes, and the meshes with an unstable or unphysical answer."""
        unsound = (f"{limit.scene.name}: {text}" for limit in self._all_limits() for text in limit.unsound)
        return [*self.failures, *unsound]

    def choices(self) -> dict[str, Any]:
        codes = {code.name: code.version() for code in self.codes.values()}
        return {"scenes": [scene.name for scene in self.scenes], "judges": codes}

    @property
    def succeeded(self) -> bool:
        """Whether every model has an error bar on every scene that it does not refuse."""
        return not self.failures and all(limit.refused or limit.uncertainty for limit in self._all_limits())


def _document(limit: Limit) -> dict[str, Any]:
    """Return a model's finest answer in the form of `compare`, with its bars."""
    finest = limit.finest
    row: dict[str, Any] = {"label": finest.label}
    if finest.status == Status.REFUSED:
        row |= {"settings": finest.request.spec.settings, "advice": Status.REFUSED.advice}
    row |= finest.document | {"status": finest.status, "message": finest.message}
    row |= {"scene": limit.scene.name, "model": limit.name, "version": finest.request.version}
    row |= {"meshes": limit.meshes, "failed": limit.failures}
    if (bar := limit.uncertainty) is not None:
        row["uncertainty"] = dict(zip(limit.scene.probes, bar.bar, strict=True))
        row["extrapolated"] = dict(zip(limit.scene.probes, bar.extrapolated, strict=True))
        row["order"] = bar.overall_order
    return row
