"""Scenes × models × meshes, through a campaign's store: a model's limit on every scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Unpack

from comparisons.comparison.crosscheck_answer import Crosscheck
from comparisons.external.installed import InstalledCode
from comparisons.models.resolve import resolve
from comparisons.models.spec import Spec
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.limits import Limit
from comparisons.sweep.solved import Ask, sweep
from comparisons.sweep.store import Store
from sheetbench.scenes import Scene


def crosscheck(
    scenes: Sequence[Scene],
    store: Store,
    *,
    models: Mapping[str, Sequence[Spec]],
    codes: Sequence[InstalledCode] = (),
    **how: Unpack[CampaignKeywords],
) -> Crosscheck:
    """Carry out what the store does not have, and return every model's limit on every scene.

    models: candidates by what tables call them, coarsest mesh first, those of external codes among them;
    codes: the external ones, absent too. Raises BadInput, before the first run, for candidates that cannot
    be and for those that take more memory than there is.
    """
    versions = {one.model: one.version for one in codes}
    asks = [
        Ask(
            resolve(scene, spec).scene,
            spec,
            version=versions.get(spec.model),
            tags={"scene": scene.name, "model": name},
            label=f"{scene.name}, {name} {spec.size}",
        )
        for scene in scenes
        for name, specs in models.items()
        for spec in specs
    ]
    rows = sweep(asks, store, **how)

    def limit(scene: Scene, name: str) -> Limit:
        tags = {"scene": scene.name, "model": name}
        return Limit.of(name, [row for row in rows if row.ask.tags == tags])

    limits = {scene.name: tuple(limit(scene, name) for name in models) for scene in scenes}
    return Crosscheck(tuple(scenes), limits, tuple(codes))
