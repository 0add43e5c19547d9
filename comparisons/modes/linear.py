"""Linearise a scene's lattice about its equilibrium: the lowest modes or the most important states."""

from __future__ import annotations

import numpy as np

from comparisons.models.context import context
from comparisons.models.resolve import resolve
from comparisons.models.spec import Lattice
from comparisons.modes.state_space import Linearisation
from comparisons.pictures.work import Work
from sheetbench.answers.solution import About
from sheetbench.errors import BadInput
from sheetbench.scenes import AnyScene, scene_of

MODES = 20
BALANCED = "balanced"


def linearise(
    scene: AnyScene,
    lattice: Lattice = Lattice(),  # noqa: B008  # frozen
    *,
    modes: int | None = MODES,
    reduce: str | None = None,
    about: About = "deformed",
) -> Linearisation:
    """Return the lattice of a scene about its equilibrium under its loads, or about the flat sheet.

    modes: of the state space, all for None; those that there are where they are fewer. reduce: them further,
    "balanced:8" to that many states, "balanced:0.01" to as few as keep the bound on the error within that
    share of what an input does at rest. Raises BadInput for choices that do not exist, for what has no linear
    form (`lumped.linearise`) and what cannot be balanced (`lumped.StateSpace`).
    """
    import lumped

    scene = scene_of(scene)
    if modes is not None and modes < 1:
        raise BadInput(f"modes = {modes}: at least 1")
    order, tolerance = _balance(reduce)
    model = resolve(scene, lattice, "motion")
    springs = model.springs
    context().progress(Work("linearising the lattice", model.size))
    found = lumped.linearise(scene, springs, about)
    most = found.mass.shape[0]
    space = found.state_space(None if modes is None else min(modes, most))
    balanced = None if reduce is None else space.balanced(order, tolerance)
    return Linearisation(scene, f"lumped {springs.title}", about, found, space, balanced)


def _balance(reduce: str | None) -> tuple[int | None, float | None]:
    """Return the order or the tolerance that "balanced:8" or "balanced:0.01" asks for."""
    if reduce is None:
        return None, None
    name, _, number = reduce.partition(":")
    if name == BALANCED and number.isdecimal() and len(number) < 10:
        return int(number), None
    try:
        tolerance = float(number) if name == BALANCED else np.nan
    except ValueError:
        tolerance = np.nan
    if not 0.0 < tolerance < np.inf:
        raise BadInput(f"--reduce = '{reduce}': {BALANCED}:8 for states, {BALANCED}:0.01 for a bound")
    return None, tolerance
