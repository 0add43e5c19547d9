"""Scenes × models × meshes, through a campaign's store: one convergence a scene and model."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from comparisons.crosscheck import tables
from comparisons.crosscheck.convergence import Convergence, Pair, pair
from comparisons.external.installed import InstalledCode
from comparisons.models import plugins
from comparisons.models.candidate import Candidate
from comparisons.models.registry import check
from comparisons.runs.campaign import Progress, Run, carry_out
from comparisons.runs.executors import Pool, processes
from comparisons.runs.store import Finished, Store
from sheetbench.answers.report import Report
from sheetbench.choices import REFERENCE, REFERENCES
from sheetbench.scenes import Scene, Status


@dataclass(frozen=True)
class Crosscheck:
    """The convergence of every model, by scene; codes: the external ones, absent too."""

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

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench crosscheck`: metres, seconds, fractions."""
        return {
            "solutions": [
                _document(scene, one) for scene in self.scenes for one in self.convergences[scene.name]
            ],
            "pairs": [
                {
                    "scene": scene.name,
                    "a": one.a,
                    "b": one.b,
                    "difference": one.difference,
                    "bars": one.bars,
                    "apart": one.distinguishable_at,
                }
                for scene in self.scenes
                for one in self.pairs(scene)
            ],
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

    def report(self) -> Report:
        """Return the tables and notes of the cross-check."""
        return tables.report(self)


def _document(scene: Scene, one: Convergence) -> dict[str, Any]:
    """A model's finest answer as `compare` has it, with its bars."""
    row = {
        key: value for key, value in one.finest.items() if key not in ("displacement", "size", "traceback")
    }
    row |= {"scene": scene.name, "model": one.name, "version": one.version, "meshes": one.meshes}
    row |= {"failed": one.failures}
    if "displacement" in one.finest:
        row["probes"] = dict(zip(scene.probes, one.finest["displacement"], strict=True))
    if (bar := one.uncertainty) is not None:
        row["uncertainty"] = dict(zip(scene.probes, bar.bar, strict=True))
        row["extrapolated"] = dict(zip(scene.probes, bar.extrapolated, strict=True))
        row["order"] = bar.overall_order
    return row


def crosscheck(
    scenes: Sequence[Scene],
    store: Store,
    *,
    models: Mapping[str, Sequence[Candidate]],
    codes: Sequence[InstalledCode] = (),
    workers: int = 1,
    pool: Pool = processes,
    retry: bool = False,
    large: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> Crosscheck:
    """Carry out what the store does not have, and return every model's convergence.

    models: candidates by what tables call them, coarsest mesh first, those of external codes among them;
    codes: the external ones, absent too. Raises BadInput, before the first run, for candidates that cannot
    be and unless `large` for those that take more memory than there is.
    """
    for scene in scenes:
        for candidate in (c for of in models.values() for c in of):
            check(scene, candidate, large)
    versions = {one.model: one.version for one in codes}
    runs = {
        (scene.name, name): [_run(scene, name, candidate, versions.get(candidate.model)) for candidate in of]
        for scene in scenes
        for name, of in models.items()
    }
    every = [run for of in runs.values() for run in of]
    done = carry_out(every, store, workers=workers, pool=pool, retry=retry, progress=progress)
    rows = {run.key: _row(run, outcome) for run, outcome in zip(every, done, strict=True)}
    version_of = {name: versions.get(of[0].model) for name, of in models.items()}
    layered = {*REFERENCES, *(one.code.name for one in codes if one.code.layered)}
    convergences = {
        scene.name: tuple(
            Convergence.of(
                scene,
                name,
                version_of[name],
                [rows[run.key] for run in runs[scene.name, name]],
                name in layered,
            )
            for name in models
        )
        for scene in scenes
    }
    return Crosscheck(tuple(scenes), convergences, tuple(codes))


def _run(scene: Scene, name: str, candidate: Candidate, version: str | None) -> Run:
    arguments = {"scene": scene.document(), "model": candidate.model, "settings": candidate.settings}
    digest = plugins.digest(candidate.model)
    arguments |= {key: text for key, text in (("version", version), ("digest", digest)) if text is not None}
    size = candidate.settings.get("elements") or candidate.settings["grid"]
    counts = "×".join(map(str, size)) if isinstance(size, list | tuple) else str(size)
    return Run("crosscheck", arguments, f"{scene.name}, {name} {counts}")


def _row(run: Run, outcome: Finished) -> dict[str, Any]:
    """Return a run's row; of a run without an answer its label, settings and status."""
    status = {"status": outcome.status, "message": outcome.message}
    refused = {"label": run.label, "settings": run.arguments["settings"], "advice": Status.REFUSED.advice}
    return {
        **(refused if outcome.status == Status.REFUSED else {"label": run.label}),
        **outcome.row,
        **status,
    }
