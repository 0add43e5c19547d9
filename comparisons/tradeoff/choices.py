"""What is to be traded, from lists as people write them; each answer is carried out through a store."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any

from comparisons.comparison.comparison import load_static
from comparisons.models.grids import Elements as Count
from comparisons.models.grids import parse_elements
from comparisons.models.resolve import resolve_each
from comparisons.models.spec import Elements, Lattice, Spec, items, lattices, pairs, parse, references
from comparisons.tradeoff.answer import DynamicTradeoff, Tradeoff
from comparisons.tradeoff.motion import dynamic_tradeoff
from comparisons.tradeoff.statics import tradeoff
from comparisons.tradeoff.usual import GRIDS, MESHES, MOVING, PAIRS, REPEATS, SPRINGS
from sheetbench.choices import AUTO, CALIBRATION, INTEGRATORS, REFERENCE
from sheetbench.errors import BadInput, require_effect
from sheetbench.scenes import AnyScene, Scene, scene_of
from sheetbench.scenes.objects.quantities import require_positive


def trade(
    scene: AnyScene,
    lattice: Lattice,
    *,
    grid: str | None = None,
    lumped_pair: str | None = None,
    calibration: str | None = None,
    meshes: Mapping[str, str | None],
    models: Sequence[Spec | str] = (),
    symmetry: bool = False,
    elements: Count | str | None = None,
    repeats: int | None = None,
    duration: float | None = None,
    integrator: str | None = None,
) -> tuple[Scene, Callable[..., Tradeoff | DynamicTradeoff]]:
    """Return the scene, and the trade of what is listed, of what is usual where nothing is: at rest of
    lattices on every grid with every calibration, of pairs of grids, of references on meshes by name, of
    models; over a `duration` [s] of integrators and their steps on the lattices, and of models that move.

    lattice: what all lattices have, the grading where their calibration takes one; symmetry: of all but
    solids and the models; elements: of the reference that all are held against. The calibration "auto" is
    the one for the scene (`comparisons.models.method`). Raises BadInput for what cannot be read, for options
    without effect, no model at all, and a reference of a single element.
    """
    usual = MESHES if duration is None else MOVING
    others: list[Spec] = []
    for name, sizes in meshes.items():
        others += references(name, items(usual[name] if sizes is None else sizes))
    named = [parse(one) if isinstance(one, str) else one for one in models]
    finest = None if elements is None else Elements(REFERENCE, _halved_too(elements))
    if duration is not None:
        statics = {"--symmetry": symmetry, "--lumped-pair": lumped_pair, "--repeats": repeats}
        require_effect("with --duration", statics)
        require_positive("--duration", duration, "s")
        methods, grids = ([None] if text is None else items(text) for text in (calibration, grid))
        loaded = scene_of(scene)
        return loaded, partial(
            dynamic_tradeoff,
            loaded,
            duration,
            lattices=[lattice.but(grid=size, calibration=name) for name in methods for size in grids],
            others=[*others, *named],
            reference=finest,
            integrators=items(integrator) or sorted(INTEGRATORS),
        )
    require_effect("without --duration", {"--integrator": integrator})
    loaded = load_static(scene)
    methods = items(calibration) or items(SPRINGS if lattice.k is None else "uniform")
    if lumped_pair is None and grid is None and not {CALIBRATION, AUTO}.isdisjoint(methods):
        lumped_pair = PAIRS
    of_one = lattices(loaded, items(GRIDS if grid is None else grid), methods, lattice)
    of_both = [*of_one, *pairs(loaded, items(lumped_pair), methods, lattice)]
    resolved, reasons = resolve_each(loaded, of_both, lattice.grading)
    candidates: list[Any] = [one for i, one in enumerate(resolved) if one not in resolved[:i]] + others
    if symmetry:
        candidates = [one if one.model == "solid" else one.but(symmetry=True) for one in candidates]
    candidates += named
    if not candidates:
        raise BadInput("no model left to measure")
    more: dict[str, Any] = {"reference": finest, "repeats": repeats or REPEATS, "reasons": reasons}
    return loaded, partial(tradeoff, loaded, candidates, **more)


def _halved_too(elements: Count | str) -> Count:
    found = parse_elements(elements) if isinstance(elements, str) else elements
    if min([found] if isinstance(found, int) else found) < 2:
        text = f"--elements = {elements}"
        raise BadInput(f"{text}: at least 2, for the reference is solved on half as many too")
    return found
