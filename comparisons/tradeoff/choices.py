"""What is to be traded, from lists as people write them; each answer is carried out through a store."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
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
from sheetbench.scenes import AnyScene, Scene, load
from sheetbench.scenes.quantities import require_positive

Listed = str | Iterable[Any] | None


def trade(
    scene: AnyScene,
    lattice: Lattice,
    *,
    grid: Listed = None,
    lumped_pair: Listed = None,
    calibration: Listed = None,
    meshes: Mapping[str, Listed],
    models: Sequence[Spec | str] = (),
    symmetry: bool = False,
    elements: Count | str | None = None,
    repeats: int | None = None,
    duration: float | None = None,
    integrator: Listed = None,
    option: str = "",
) -> tuple[Scene, Callable[..., Tradeoff | DynamicTradeoff]]:
    """Return the scene, and the trade of what is listed, of what is usual where nothing is; the command's and
    the function's defaults. option: what stands before a name where the user reads it, as "--"."""
    pairs, sizes = _text(lumped_pair), None if elements is None else _text([elements])
    usual = MESHES if duration is None else MOVING
    listed = {name: usual[name] if of is None else _text(of) or "" for name, of in meshes.items()}
    if duration is not None:
        statics = {"symmetry": symmetry, "lumped-pair": lumped_pair, "repeats": repeats}
        require_effect(f"with {option}duration", {option + name: value for name, value in statics.items()})
        loaded = load(scene) if isinstance(scene, str | Path) else scene
        integrators = _text(integrator) or ",".join(sorted(INTEGRATORS))
        lists = (_text(grid), _text(calibration))
        return loaded, of_motion(loaded, duration, *lists, lattice, integrators, listed, models, sizes)
    require_effect(f"without {option}duration", {f"{option}integrator": integrator})
    loaded = load_static(scene) if isinstance(scene, str | Path) else scene
    named = _text(calibration) or (SPRINGS if lattice.k is None else "uniform")
    if pairs is None:
        pairs = PAIRS if grid is None and not {CALIBRATION, AUTO}.isdisjoint(items(named)) else ""
    grids = GRIDS if grid is None else _text(grid) or ""
    return loaded, of_statics(
        loaded, grids, named, lattice, listed, models, symmetry, sizes, repeats or REPEATS, pairs
    )


def _text(listed: Listed) -> str | None:
    """Return a list as people write it, 5,9x13; None of none."""
    if listed is None or isinstance(listed, str):
        return listed
    if not isinstance(listed, Iterable):
        return str(listed)
    return ",".join("x".join(map(str, one)) if isinstance(one, tuple | list) else str(one) for one in listed)


def of_statics(
    scene: Scene,
    grids: str,
    calibrations: str,
    lattice: Lattice,
    meshes: Mapping[str, str],
    models: Sequence[Spec | str] = (),
    symmetry: bool = False,
    elements: str | None = None,
    repeats: int = 5,
    of_two: str = "",
) -> Callable[..., Tradeoff]:
    """The trade of lattices, of references on meshes by name, and of models as `parse` reads them.

    symmetry: of all but solids and the models; elements: of the reference that all are held against;
    lattice: what all lattices have, the grading where their calibration takes one; of_two: pairs of grids,
    extrapolated. The calibration "auto" is the one for the scene (`comparisons.models.method`).
    Raises BadInput for what cannot be read, no model at all, and a reference of a single element.
    """
    named = items(calibrations)
    of_one = lattices(scene, items(grids), named, lattice)
    lattices_of_both = [*of_one, *pairs(scene, items(of_two), named, lattice)]
    resolved, reasons = resolve_each(scene, lattices_of_both, lattice.grading)
    candidates = [one for i, one in enumerate(resolved) if one not in resolved[:i]]
    for name, sizes in meshes.items():
        candidates += references(name, items(sizes))
    if symmetry:
        candidates = [c if c.model == "solid" else c.but(symmetry=True) for c in candidates]
    candidates += [parse(one) if isinstance(one, str) else one for one in models]
    if not candidates:
        raise BadInput("no model left to measure")
    finest = None if elements is None else Elements(REFERENCE, _halved_too(elements))
    return partial(tradeoff, scene, candidates, reference=finest, repeats=repeats, reasons=reasons)


def _halved_too(text: str) -> Count:
    found = parse_elements(text)
    if min([found] if isinstance(found, int) else found) < 2:
        raise BadInput(f"--elements = {text}: at least 2, for the reference is solved on half as many too")
    return found


def of_motion(
    scene: Scene,
    duration: float,
    grids: str | None,
    calibrations: str | None,
    lattice: Lattice,
    integrators: str,
    meshes: Mapping[str, str],
    models: Sequence[Spec | str] = (),
    elements: str | None = None,
) -> Callable[..., DynamicTradeoff]:
    """The trade of a motion over `duration` [s]: integrators and steps on lattices, as `of_statics` has them,
    references on meshes by name, models that move. elements: of the reference that all are held against.
    Raises BadInput."""
    require_positive("--duration", duration, "s")
    named, sizes = ([None] if text is None else items(text) for text in (calibrations, grids))
    others: list[Spec] = []
    for name, counts in meshes.items():
        others += references(name, items(counts))
    others += [parse(one) if isinstance(one, str) else one for one in models]
    return partial(
        dynamic_tradeoff,
        scene,
        duration,
        lattices=[lattice.but(grid=size, calibration=name) for name in named for size in sizes],
        others=others,
        reference=None if elements is None else Elements(REFERENCE, _halved_too(elements)),
        integrators=items(integrators),
    )
