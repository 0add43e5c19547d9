"""Error against cost: many models of one scene, measured alike, beside the finest reference.

    error        at the probes, as `comparisons.comparison.comparison` defines it
    field error  (∫ |u − u_ref|² dA / ∫ |u_ref|² dA)^½ over the undeformed sheet
    uncertainty  of the reference, in both measures: its bar by the grid convergence index, from meshes of
                 n, ¾ n and ½ n elements a side (`fem_reference.uncertainty`)
    cost         see `comparisons.sweep.task`

Orders: the slope of log error over log h, h the size of a cell, and of log time over log unknowns, over the
rows of a family whose errors are well above the uncertainty.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np

from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Spec
from comparisons.sweep.campaign import CampaignKeywords
from comparisons.sweep.columns import field_points
from comparisons.sweep.differences import error
from comparisons.sweep.limits import limit
from comparisons.sweep.solved import Ask, Solved, sweep
from comparisons.sweep.store import Store
from comparisons.tradeoff.answer import Tradeoff
from comparisons.tradeoff.row import TradeoffRow
from fem_reference.uncertainty import coarser
from sheetbench.scenes import Scene, require_static

REFERENCE_ELEMENTS = 32  # at least; twice as many as the finest shell among the rows
TRADED = ("field", "bar", "model_error")  # columns


def tradeoff(
    scene: Scene,
    candidates: Sequence[Spec],
    store: Store,
    *,
    reference: Elements | None = None,
    repeats: int = 5,
    reasons: tuple[str, ...] = (),
    **how: Unpack[CampaignKeywords],
) -> Tradeoff:
    """Measure every candidate on a scene, through the campaign's store.

    reference: by default the shell with twice as many elements as the finest shell among the candidates, and
    32 at least. reasons: sentences that the report shall give on the candidates.
    Raises SceneError for a scene without a static answer and, before anything is solved,
    BadInput for a model or setting that does not exist. A solve that fails is a row with its status.
    """
    require_static(scene)
    for candidate in candidates:
        resolve(scene, candidate, option=f"--{candidate.model}")
    fine = resolve(scene, reference or finest_shell(candidates, REFERENCE_ELEMENTS)).spec
    meshes = [Ask(scene, fine.but(count=n), columns=TRADED) for n in coarser(fine.elements)]
    asks = [Ask(scene, candidate, repeats, TRADED) for candidate in candidates]
    found = sweep([*meshes, *asks], store, **how)
    finer, rows = found[: len(meshes)], found[len(meshes) :]
    truth, shares = finer[0], field_points(scene)[1]
    at_probes, field = (limit(finer, of) if truth.usable else None for of in ("probes", "field"))
    return Tradeoff(
        scene,
        tuple(TradeoffRow(**vars(row), **_errors(row, truth, shares)) for row in rows),
        TradeoffRow(**vars(truth)),
        None if at_probes is None else at_probes.error,
        None if field is None else _ratio(field.bar, field.answer, shares),
        reasons,
    )


def finest_shell(candidates: Sequence[Spec], least: int) -> Elements:
    """Return the shell with twice as many elements as the finest among the candidates, `least` at least."""
    shells = [np.min(c.elements) for c in candidates if isinstance(c, Elements) and c.kind == "shell"]
    return Elements("shell", max([least, *(2 * int(n) for n in shells)]))


def _errors(row: Solved, truth: Solved, shares: np.ndarray) -> dict[str, Any]:
    if not (row.usable and truth.usable):
        return {}
    field, known = row.values("field"), truth.values("field")
    return {"error": error(row.u, truth.u), "field_error": _ratio(field - known, known, shares)}


def _ratio(off: np.ndarray, known: np.ndarray, shares: np.ndarray) -> float | None:
    """Return the root mean square of one field (n, 3) over another's; shares (n,): of the area."""
    part, whole = (float(shares @ np.sum(u**2, axis=1)) for u in (off, known))
    return float(np.sqrt(part / whole)) if whole > 0.0 and np.isfinite(part) else None
