"""The discrete sheet of a scene by model: what modes, buckling and motions divide a sheet into."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np

from fem_reference.discrete.answer import equilibrium
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.plate.discrete import DiscretePlate
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.solid.discrete import DiscreteSolid
from fem_reference.solid.statics import plan_mesh
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.answers.solution import Status
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import BadInput, NoEquilibrium
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.scenes import EdgeMotion, Scene
from sheetbench.scenes.meaning.motion import NO_START, at_start, starts_flat

Sheet = TypeVar("Sheet", bound=DiscreteElements)


def plate(
    scene: Scene,
    elements: Elements = 16,
    section: Section | None = None,
    graded: bool | None = None,
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscreteElements:
    """Return the plate; graded: unless given at rest, and in motion where an edge lets twist go."""
    if moving:
        _refuse_edge_motions(scene, "plate")
    graded = (not moving or bool(scene.twisting_edges())) if graded is None else graded
    mesh = mesh_of(scene, elements, graded, reach)
    return _named(DiscretePlate(mesh, scene, section, moving=moving), elements, graded=graded)


def shell(
    scene: Scene,
    elements: Elements = 16,
    section: Section | None = None,
    graded: bool = True,
    law: str = STRAIN_LAW,
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscreteElements:
    """Return the shell."""
    mesh = mesh_of(scene, elements, graded, reach)
    return _named(DiscreteShell(mesh, scene, section, law, moving), elements, graded=graded, law=law)


def solid(
    scene: Scene,
    elements: Elements = 16,
    layers: int = 1,
    law: str = STRAIN_LAW,
    clamp: str = "shell-like",
    grading: str = "edges",
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscreteElements:
    """Return the solid, whose mesh is as in statics whatever the reach."""
    if moving:
        _refuse_edge_motions(scene, "solid")
    mesh = plan_mesh(scene, divisions(scene.sheet, elements), grading)
    made = DiscreteSolid(mesh, scene, layers, law, clamp, moving)
    return _named(made, elements, f" × {layers}", grading=grading, layers=layers, law=law, clamp=clamp)


SHEETS: dict[str, Callable[..., DiscreteElements]] = {"plate": plate, "shell": shell, "solid": solid}


def _named(sheet: Sheet, elements: Elements, through: str = "", **settings: Any) -> Sheet:
    if sheet.scene.sheet.mesh is not None and "graded" in settings:
        settings["graded"] = False
    counts = divisions(sheet.scene.sheet, elements)
    sheet.label = f"{sheet.model} {counts[0]} × {counts[1]}{through}"
    sheet.settings = {"elements": list(counts), **settings}
    return sheet


def _refuse_edge_motions(scene: Scene, model: str) -> None:
    for name, actuator in scene.named_actuators().items():
        if isinstance(actuator, EdgeMotion):
            raise BadInput(f"actuator {name}: the {model} in motion has no edge motions; the shell has")


def start(sheet: DiscreteElements) -> np.ndarray:
    """Return q (N,) of a sheet in motion at t = 0: flat, or the equilibrium to start from
    (`scenes.meaning.motion`). Raises NoEquilibrium where there is no stable one."""
    if starts_flat(sheet.scene):
        return sheet.placed(np.zeros(sheet.size), 0.0)
    q, status, notes = _equilibrium(sheet, at_start(sheet.scene))
    try:
        require_stable(sheet.model, status, notes)
    except NoEquilibrium as error:
        raise NoEquilibrium(f"{NO_START}: {error}") from None
    return sheet.placed(q, 0.0)


def _equilibrium(sheet: DiscreteElements, scene: Scene) -> tuple[np.ndarray, Status, Sequence[str]]:
    """q (N,) under the full load of a scene on a sheet's mesh, how the path there ended, and notes."""
    mesh, own = sheet.plan.mesh, sheet.settings
    of_sheet = {name: own[name] for name in ("layers", "law", "clamp") if name in own}
    kind: Any = type(sheet)
    return equilibrium(kind(mesh, scene, **of_sheet))
