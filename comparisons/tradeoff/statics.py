"""Error against cost of many models of one scene, measured in one way against the finest reference.

    error        at the probes, and field_error over the sheet (`comparisons.sweep.differences`)
    uncertainty  the reference's error bar by the grid convergence index, from meshes of n, ¾ n and ½ n
                 elements per side (`fem_reference.uncertainty`)
    cost         see `comparisons.sweep.task`

Orders: the slope of log error over log h, h the size of a cell, and of log time over log unknowns, over the
rows of a family whose errors are well above the uncertainty.
"""

from collections.abc import Sequence
from typing import Unpack

import numpy as np

from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Spec
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.differences import error
from comparisons.sweep.limits import limit
from comparisons.sweep.solved import Request, Solved, sweep
from comparisons.sweep.store import Store
from comparisons.tradeoff.answer import Tradeoff
from comparisons.tradeoff.row import TradeoffRow
from fem_reference.uncertainty import coarser
from sheetbench.scenes import Scene, require_static

REFERENCE_ELEMENTS = 32  # least number for the reference
TRADED = ("field", "model_error")  # columns


def tradeoff(
    scene: Scene,
    candidates: Sequence[Spec],
    store: Store,
    *,
    reference: Elements | None = None,
    repeats: int = 5,
    reasons: tuple[str, ...] = (),
    **campaign: Unpack[CampaignKeywords],
) -> Tradeoff:
    """Measure every candidate on a scene, through the campaign's store.

    reference: by default the shell with twice as many elements as the finest shell among the candidates, at
    least 32. reasons: sentences on the candidates for the report. Raises, before the first solve, SceneError
    for a scene without a static answer and BadInput for an unknown model or setting. A failed solve is a row
    with its status.
    """
    require_static(scene)
    for candidate in candidates:
        resolve(scene, candidate, option=f"--{candidate.model}")
    fine = resolve(scene, reference or finest_shell(candidates, REFERENCE_ELEMENTS)).spec
    meshes = [Request(scene, fine.but(count=n), columns=TRADED) for n in coarser(fine.elements)]
    requests = [Request(scene, candidate, repeats, TRADED) for candidate in candidates]
    solved = sweep([*meshes, *requests], store, **campaign)
    by_mesh, rows = solved[: len(meshes)], solved[len(meshes) :]
    truth = by_mesh[0]
    bar = limit(by_mesh) if truth.usable else None
    return Tradeoff(
        scene,
        tuple(_measured(row, truth) for row in rows),
        TradeoffRow(**vars(truth)),
        None if bar is None else bar.error,
        reasons,
    )


def finest_shell(candidates: Sequence[Spec], least: int) -> Elements:
    """Return the shell with twice as many elements as the finest candidate, at least `least`."""
    shells = [np.min(c.elements) for c in candidates if isinstance(c, Elements) and c.kind == "shell"]
    return Elements("shell", max([least, *(2 * int(n) for n in shells)]))


def _measured(row: Solved, truth: Solved) -> TradeoffRow:
    if not (row.usable and truth.usable):
        return TradeoffRow(**vars(row))
    return TradeoffRow(**vars(row), error=error(row.u, truth.u), field_error=error(row.field, truth.field))
