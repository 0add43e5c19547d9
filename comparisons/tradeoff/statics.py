"""Error against cost: many models of one scene, measured alike, beside the finest reference.

    error        at the probes, as `comparisons.comparison.comparison` defines it
    field error  (∫ |u − u_ref|² dA / ∫ |u_ref|² dA)^½ over the undeformed sheet
    uncertainty  of the reference, in both measures: its bar by the grid convergence index, from meshes of
                 n, ¾ n and ½ n elements a side (`fem_reference.uncertainty`)
    cost         see `comparisons.tradeoff.timing`

Orders: the slope of log error over log h, h the size of a cell, and of log time over log unknowns, over the
rows of a family whose errors are well above the uncertainty.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Unpack

import numpy as np

from comparisons.comparison.comparison import error as probe_error
from comparisons.models.context import large_in_context
from comparisons.models.resolve import resolve
from comparisons.models.spec import Elements, Spec
from comparisons.runs.campaign import CampaignKeywords, Run, carry_out
from comparisons.runs.store import Finished, Store
from comparisons.tradeoff import timing
from comparisons.tradeoff.answer import Tradeoff
from comparisons.tradeoff.row import measured_row
from fem_reference.edge_layer import missed_by
from fem_reference.uncertainty import coarser, estimate, mesh_size
from sheetbench.scenes import Scene, comparable, require_static

REFERENCE_ELEMENTS = 32  # at least; twice as many as the finest shell among the rows


@large_in_context
def tradeoff(
    scene: Scene,
    candidates: Sequence[Spec],
    store: Store,
    *,
    reference: Elements | None = None,
    repeats: int = 5,
    large: bool = False,
    reasons: tuple[str, ...] = (),
    **how: Unpack[CampaignKeywords],
) -> Tradeoff:
    """Measure every candidate on a scene, through the campaign's store.

    reference: by default the shell with twice as many elements as the finest shell among the candidates, and
    32 at least. large: even where one takes more memory than there is. reasons: sentences that the report
    shall give on the candidates.
    Raises SceneError for a scene without a static answer and, before anything is solved,
    BadInput for a model or setting that does not exist. A solve that fails is a row with its status.
    """
    require_static(scene)
    for candidate in candidates:
        resolve(scene, candidate, option=f"--{candidate.model}")
    fine = reference or finest_shell(candidates, REFERENCE_ELEMENTS)
    resolve(scene, fine)
    finer_runs = [timing.run(scene, fine.but(count=n), timed=False) for n in coarser(fine.elements)]
    model_runs = [timing.run(scene, candidate, repeats) for candidate in candidates]
    outcomes = carry_out([*finer_runs, *model_runs], store, **how)
    count = len(finer_runs)
    return replace(
        assemble(scene, finer_runs, outcomes[:count], model_runs, outcomes[count:]), reasons=reasons
    )


def assemble(
    scene: Scene,
    finer_runs: Sequence[Run],
    finer_outcomes: Sequence[Finished],
    model_runs: Sequence[Run],
    outcomes: Sequence[Finished],
) -> Tradeoff:
    """The trade-off of finished runs: the reference on meshes from fine to coarse, and the rows."""
    weights, truth = timing.field_points(scene)[1], finer_outcomes[0]
    rows = tuple(
        measured_row(scene, run, outcome, *_errors(outcome, truth, weights))
        for run, outcome in zip(model_runs, outcomes, strict=True)
    )
    meshes = [run.arguments["settings"]["elements"] for run in finer_runs]
    sizes = [mesh_size(scene, n if isinstance(n, int) else tuple(n)) for n in meshes]
    return Tradeoff(
        scene, rows, measured_row(scene, finer_runs[0], truth), *_bars(scene, finer_outcomes, sizes, weights)
    )


def _bars(
    scene: Scene, finer_outcomes: Sequence[Finished], sizes: Sequence[float], weights: np.ndarray
) -> tuple[float | None, float | None]:
    """Uncertainty of the finest of the reference's answers, at the probes and over the sheet."""
    usable = [(o.row, size) for o, size in zip(finer_outcomes, sizes, strict=True) if _comparable(o)]
    if len({size for _, size in usable}) < 2 or not _comparable(finer_outcomes[0]):
        return None, None
    used = [size for _, size in usable]
    layers = [missed_by(scene, row["settings"]) for row, _ in usable]
    at_probes = estimate([np.array(list(row["probes"].values())) for row, _ in usable], used, layers)
    field = estimate([np.array(row["field"]) for row, _ in usable], used, layers)
    bar, size = (float(weights @ np.sum(u**2, axis=1)) for u in (field.bar, field.answer))
    return at_probes.error, float(np.sqrt(bar / size)) if size > 0.0 else None


def finest_shell(candidates: Sequence[Spec], least: int) -> Elements:
    """Return the shell with twice as many elements as the finest among the candidates, `least` at least."""
    shells = [np.min(c.elements) for c in candidates if isinstance(c, Elements) and c.kind == "shell"]
    return Elements("shell", max([least, *(2 * int(n) for n in shells)]))


def _errors(outcome: Finished, truth: Finished, weights: np.ndarray) -> tuple[float | None, float | None]:
    if not (_comparable(outcome) and _comparable(truth)):
        return None, None
    u, ref = (np.array(list(o.row["probes"].values()), dtype=float) for o in (outcome, truth))
    field, field_ref = (np.array(o.row["field"], dtype=float) for o in (outcome, truth))
    size = float(weights @ np.sum(field_ref**2, axis=1))
    off = float(weights @ np.sum((field - field_ref) ** 2, axis=1))
    return probe_error(u, ref), float(np.sqrt(off / size)) if size > 0.0 and np.isfinite(off) else None


def _comparable(outcome: Finished) -> bool:
    return comparable(outcome.status, outcome.row.get("load_factor", 0.0))
