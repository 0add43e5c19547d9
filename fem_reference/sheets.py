"""Discrete sheets of a scene by model, for statics, modes, buckling and motions."""

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

if TYPE_CHECKING:  # models are loaded when requested
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
    """Return the discrete plate on elements along the shorter side (near-square), or (nx, ny). graded: finer
    towards the edges, or equal elements; by default graded where an edge has no twisting moment. section:
    stiffness per width, by default of material and thickness; reach: of the grading (`mesh.mesh_of`)."""
    from fem_reference.plate.discrete import DiscretePlate

    if graded is None:
        graded = bool(scene.twisting_edges())
    sheet = DiscretePlate(mesh_of(scene, elements, graded, reach), scene, section, moving)
    return sheet.named(elements, graded=graded, section=section and section._asdict())


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
    """Return the discrete shell; law: one of `shell.laws.LAWS`; for the other options see `plate`."""
    sheet = DiscreteShell(mesh_of(scene, elements, graded, reach), scene, section, law, moving)
    return sheet.named(elements, graded=graded, law=law, section=section and section._asdict())


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
    """Return the discrete solid. Its mesh does not depend on the reach. Without lines along x and y it has no
    rows along its rim: thin curved bricks keep corrections from shrinking. layers: bricks through the
    thickness; law: a key of `solid.materials.LAWS`; clamp: one of `solid.supports.CLAMPS`; grading: one of
    `GRADINGS`."""
    from fem_reference.solid.discrete import DiscreteSolid

    require_choice("grading", grading, GRADINGS)
    mesh = mesh_of(scene, elements, graded=grading == "edges" and has_lines(scene))
    sheet = DiscreteSolid(mesh, scene, layers, law, clamp, moving)
    layers = sheet.columns.layers
    return sheet.named(elements, f" × {layers}", grading=grading, layers=layers, law=law, clamp=clamp)


SHEETS: dict[str, Callable[..., DiscreteElements]] = {"plate": plate, "shell": shell, "solid": solid}


class Division(NamedTuple):
    """Division of a scene's sheet into elements by a model. counts: elements along x and y; options: the
    model's; of_lines: whether meshes consist of lines along x and y."""

    scene: Scene
    model: str
    counts: tuple[int, int]
    options: dict[str, Any]
    of_lines: bool

    def sheet(self, **more: Any) -> Any:
        """Return the discrete sheet; more: `moving` and `reach`, options of each function of `SHEETS`."""
        return SHEETS[self.model](self.scene, self.counts, **self.options, **more)

    @property
    def graded(self) -> bool:
        """Return whether the elements of a plate or shell are finer towards the edges."""
        return bool(self.options.get("graded", True))

    def coarser(self) -> Division | None:
        """Return a shell's coarser division to begin with, if there is one (`coarse_start`)."""
        counts = coarse(self.counts, self.scene) if self.model == "shell" else None
        # rows along an outline are half of a coarse mesh
        return counts and self._replace(counts=counts).with_grading(self.graded and self.of_lines)

    def with_grading(self, graded: bool) -> Division:
        """Return this division with elements finer towards the edges, or equal ones."""
        return self._replace(options=self.options | {"graded": graded})


def division_of(scene: Scene, model: str, elements: Elements = 16, **requested: Any) -> Division:
    """Return the division of a scene's sheet by a model. Options that the model has and that are not
    requested: the law of the scene's rubber; no grading, where the mesh is the user's own or all edges are
    clamped. Clamped edges have no layer of twist (`edge_layer`); elements finer towards them are only larger
    elsewhere: with 8 a sheet bent by less than its thickness is 3 to 30 times as far off, and its error bars
    miss."""
    parameters, defaults, borders = signature(SHEETS[model]).parameters, dict[str, Any](), borders_of(scene)
    if scene.material.law is not None:
        defaults["law"] = scene.material.law
    if scene.sheet.mesh is not None or not (scene.twisting_edges() or borders):
        defaults["graded"] = False
    options = {name: value for name, value in defaults.items() if name in parameters} | requested
    of_lines = borders is None or borders.along_axes
    return Division(scene, model, divisions(scene.sheet, elements), options, of_lines)


def start(sheet: DiscreteElements) -> np.ndarray:
    """Return q (N,) of a sheet in motion at t = 0: flat, or the equilibrium to start from
    (`scenes.meaning.motion`). Raises NoEquilibrium where no equilibrium is stable."""
    if starts_flat(sheet.scene):
        return sheet.on_supports(np.zeros(sheet.size), 0.0)
    kind: Any = type(sheet)
    options = {name: sheet.settings[name] for name in ("layers", "law", "clamp") if name in sheet.settings}
    q, status, notes = equilibrium(kind(sheet.plan.mesh, at_start(sheet.scene), **options))
    try:
        require_stable(sheet.model, status, notes)
    except NoEquilibrium as error:
        raise NoEquilibrium(f"{NO_START}: {error}") from None
    return sheet.on_supports(q, 0.0)
