"""A judge, as the crosscheck knows it, and the Solution of one that answers on bricks."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from typing import Any, Protocol, runtime_checkable

import numpy as np

from comparisons.judges.bricks import Bricks
from comparisons.models.plugins import Model
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import FieldMesh, Scene, Solution, Status


@runtime_checkable
class Judge(Model, Protocol):
    """A plug-in that is somebody else's program: how people call it, what it needs to be here, and numbers of
    elements along the shorter side, coarsest first, on which its convergence is looked at."""

    @property
    def called(self) -> str: ...

    @property
    def needs(self) -> str: ...

    @property
    def meshes(self) -> tuple[int, ...]: ...

    @property
    def layered(self) -> bool:
        """Whether its elements are quadratic and shear, so that their edges let twist go."""
        ...

    def version(self) -> str | None:
        """Its version, None where it is not installed."""
        ...


def require(elements: Any, layers: Any, grading: str, gradings: Collection[str]) -> None:
    """Raise BadInput for settings of bricks that make no mesh."""
    if type(elements) is not int or elements < 1:
        raise BadInput(f"elements = {elements!r}: a whole number along the shorter side, at least 1")
    if type(layers) is not int or layers < 2 or layers % 2:
        raise BadInput(f"layers = {layers!r}: an even number, so that nodes lie in the mid-surface")
    require_choice("grading", grading, gradings)


def moving_supports(scene: Scene) -> str:
    """A sentence where supports move, which bricks and other programs' meshes are not told."""
    if any(support.motion is not None for support in scene.supports):
        return (
            'supports that move are not handed over: a clamp may be written as an actuator, kind = "motion"'
        )
    return ""


def answered(
    judge: Judge,
    scene: Scene,
    settings: Mapping[str, Any],
    bricks: Bricks,
    displacement: np.ndarray,
    status: Status,
    load_factor: float,
    note: str,
    iterations: int,
    seconds: tuple[float, float],
) -> Solution:
    """The answer of nodal displacements (n, 3) [m]; seconds: set-up and solve."""
    counts = " × ".join(map(str, bricks.shape))
    return Solution(
        model=judge.name,
        label=f"{judge.called} {counts} bricks",
        settings={**settings, "elements": list(bricks.shape[:2])},
        status=status,
        unknowns=displacement.size,
        iterations=iterations,
        setup_seconds=seconds[0],
        solve_seconds=seconds[1],
        sample=lambda points: bricks.sample(displacement, points),
        reactions={},
        energies={},
        mesh=FieldMesh(bricks.positions, [("hexahedron20", bricks.elements)], {"displacement": displacement}),
        load_factor=load_factor,
        notes=(note,) if note else (),
    )
