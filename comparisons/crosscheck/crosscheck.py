"""Scenes × models × meshes, through a campaign's store: one convergence a scene and model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Unpack

import numpy as np

from comparisons.crosscheck.answer import Crosscheck
from comparisons.crosscheck.convergence import Convergence
from comparisons.external import plugins
from comparisons.external.installed import InstalledCode
from comparisons.models.context import large_in_context, running
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Spec, counted, spec_of
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from sheetbench.choices import REFERENCES
from sheetbench.scenes import Scene, Status


@large_in_context
def crosscheck(
    scenes: Sequence[Scene],
    store: Store,
    *,
    models: Mapping[str, Sequence[Spec]],
    codes: Sequence[InstalledCode] = (),
    large: bool = False,
    **how: Unpack[CampaignKeywords],
) -> Crosscheck:
    """Carry out what the store does not have, and return every model's convergence.

    models: candidates by what tables call them, coarsest mesh first, those of external codes among them;
    codes: the external ones, absent too. Raises BadInput, before the first run, for candidates that cannot
    be and unless `large` for those that take more memory than there is.
    """
    for scene in scenes:
        for candidate in (c for of in models.values() for c in of):
            resolve(scene, candidate)
    versions = {one.model: one.version for one in codes}
    runs = {
        (scene.name, name): [_run(scene, name, candidate, versions.get(candidate.model)) for candidate in of]
        for scene in scenes
        for name, of in models.items()
    }
    every = [run for of in runs.values() for run in of]
    done = carry_out(every, store, **how)
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


def _run(scene: Scene, name: str, candidate: Spec, version: str | None) -> Run:
    arguments = {"scene": scene.document(), "model": candidate.model, "settings": candidate.settings}
    digest = plugins.digest(candidate.model)
    arguments |= {key: text for key, text in (("version", version), ("digest", digest)) if text is not None}
    size = candidate.settings.get("elements") or candidate.settings["grid"]
    return Run("crosscheck", arguments, f"{scene.name}, {name} {counted(size)}")


def _row(run: Run, outcome: Finished) -> dict[str, Any]:
    """Return a run's row; of a run without an answer its label, settings and status."""
    status = {"status": outcome.status, "message": outcome.message}
    refused = {"label": run.label, "settings": run.arguments["settings"], "advice": Status.REFUSED.advice}
    return {
        **(refused if outcome.status == Status.REFUSED else {"label": run.label}),
        **outcome.row,
        **status,
    }


def answer(
    scene: dict[str, Any],
    model: str,
    settings: dict[str, Any],
    version: str | None = None,
    digest: str | None = None,
) -> dict[str, Any]:
    """A model's answer, as `compare` has it, and the mean size [m] of its cells.

    version, digest: of an external code and of its plug-in, under which the row is kept.
    """
    parsed = Scene.model_validate(scene)
    with running(large=True):  # `crosscheck` has looked at the size
        solution = solve(resolve(parsed, spec_of(model, settings)))
    counts = solution.settings.get("elements") or [n - 1 for n in solution.settings["grid"]]
    size = float(np.sqrt(np.prod(parsed.sheet.lengths) / np.prod(counts[:2])))
    return {**solution.document(parsed), "size": size}
