"""The discrete sheet of a scene by model: what statics, modes, buckling and motions divide a sheet into."""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fem_reference.discrete.answer import equilibrium
from fem_reference.discrete.elements import DiscreteElements
from fem_reference.shell.coarse_start import coarse
from fem_reference.shell.discrete import DiscreteShell
from fem_reference.surface.borders import borders_of, has_lines
from fem_reference.surface.materials import Section
from fem_reference.surface.mesh import Elements, divisions, mesh_of
from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import NoEquilibrium, require_choice
from sheetbench.numerics.continuation.stability import require_stable
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.motion import NO_START, at_start, starts_flat

if TYPE_CHECKING:  # of a model that nobody asked for nothing is loaded
    from fem_reference.plate.discrete import DiscretePlate
    from fem_reference.solid.discrete import DiscreteSolid

GRADINGS = ("edges", "uniform")


def plate(
    scene: Scene,
    elements: Elements = 16,
    section: Section | None = None,
    graded: bool | None = None,
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscretePlate:
    """Return the discrete plate on elements along the shorter side (near-square), or (nx, ny).

    graded: finer towards the edges, or equal elements; unless given, where an edge lets twist go. section:
    stiffness per width, from material and thickness unless given; reach: of the grading (`mesh.mesh_of`).
    """
    from fem_reference.plate.discrete import DiscretePlate

    if graded is None:
        graded = bool(scene.twisting_edges())
    made = DiscretePlate(mesh_of(scene, elements, graded, reach), scene, section, moving)
    return made.named(elements, graded=graded, section=section and section._asdict())


def shell(
    scene: Scene,
    elements: Elements = 16,
    graded: bool = True,
    section: Section | None = None,
    law: str = STRAIN_LAW,
    *,
    moving: bool = False,
    reach: float = 1.0,
) -> DiscreteShell:
    """Return the discrete shell; law: one of `shell.laws.LAWS`; other options: as of the plate."""
    made = DiscreteShell(mesh_of(scene, elements, graded, reach), scene, section, law, moving)
    return made.named(elements, graded=graded, law=law, section=section and section._asdict())


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
) -> DiscreteSolid:
    """Return the discrete solid, whose mesh is the same whatever the reach. Without lines along x and y it
    has no rows along its rim, for thin curved bricks keep corrections from shrinking.

    layers: bricks through the thickness; law: a key of `solid.materials.LAWS`; clamp: one of
    `solid.supports.CLAMPS`; grading: one of `GRADINGS`.
    """
    from fem_reference.solid.discrete import DiscreteSolid

    require_choice("grading", grading, GRADINGS)
    mesh = mesh_of(scene, elements, graded=grading == "edges" and has_lines(scene))
    made = DiscreteSolid(mesh, scene, layers, law, clamp, moving)
    layers = made.columns.layers
    return made.named(elements, f" × {layers}", grading=grading, layers=layers, law=law, clamp=clamp)


SHEETS: dict[str, Callable[..., DiscreteElements]] = {"plate": plate, "shell": shell, "solid": solid}


class Division(NamedTuple):
    """A scene's sheet as a model divides it: elements along x and y, the model's options, and whether meshes
    are of lines along x and y."""

    scene: Scene
    model: str
    counts: tuple[int, int]
    options: dict[str, Any]
    of_lines: bool

    def sheet(self, **more: Any) -> Any:
        """Return the discrete sheet; more: `moving`, `reach`, as of `SHEETS`."""
        return SHEETS[self.model](self.scene, self.counts, **self.options, **more)

    @property
    def graded(self) -> bool:
        """Whether the elements of a plate or shell are finer towards the edges."""
        return bool(self.options.get("graded", True))

    def coarser(self) -> Division | None:
        """Return a shell's division to begin with, if there is one (`coarse_start`)."""
        counts = coarse(self.counts, self.scene) if self.model == "shell" else None
        # rows along an outline are half of a coarse mesh
        return counts and self._replace(counts=counts).with_grading(self.graded and self.of_lines)

    def with_grading(self, graded: bool) -> Division:
        """Return the same division, finer towards the edges or not."""
        return self._replace(options=self.options | {"graded": graded})


def division_of(scene: Scene, model: str, elements: Elements = 16, **requested: Any) -> Division:
    """Return how a model divides a scene's sheet. Unless requested, of options that the model has: the law of
    the scene's rubber; not graded, where the mesh is the user's own or all edges are clamped.

    Clamped edges have no layer of twist (`edge_layer`); elements finer towards them are only larger
    elsewhere: with 8 a sheet bent by less than its thickness is 3 to 30 times as far off, and its error bars
    miss."""
    known, decided, borders = signature(SHEETS[model]).parameters, dict[str, Any](), borders_of(scene)
    if scene.material.law is not None:
        decided["law"] = scene.material.law
    if scene.sheet.mesh is not None or not (scene.twisting_edges() or borders):
        decided["graded"] = False
    options = {name: value for name, value in decided.items() if name in known} | requested
    of_lines = borders is None or borders.along_axes
    return Division(scene, model, divisions(scene.sheet, elements), options, of_lines)


def start(sheet: DiscreteElements) -> np.ndarray:
    """Return q (N,) of a sheet in motion at t = 0: flat, or the equilibrium to start from
    (`scenes.meaning.motion`). Raises NoEquilibrium where there is no stable one."""
    if starts_flat(sheet.scene):
        return sheet.placed(np.zeros(sheet.size), 0.0)
    kind: Any = type(sheet)
    of_sheet = {name: sheet.settings[name] for name in ("layers", "law", "clamp") if name in sheet.settings}
    q, status, notes = equilibrium(kind(sheet.plan.mesh, at_start(sheet.scene), **of_sheet))
    try:
        require_stable(sheet.model, status, notes)
    except NoEquilibrium as error:
        raise NoEquilibrium(f"{NO_START}: {error}") from None
    return sheet.placed(q, 0.0)
