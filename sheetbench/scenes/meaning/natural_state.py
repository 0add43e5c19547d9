"""Natural strain and curvature of a scene's sheet, at points or of cells, over time.

Their sources are [natural], patches with a natural state of their own in place of the sheet's, and
[temperature]; each has its history.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from copy import copy
from typing import TYPE_CHECKING, Any, NamedTuple, Self, TypeVar

import numpy as np

from sheetbench.errors import Impossible
from sheetbench.scenes.meaning.composition import of_sheet, shares_of
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.layers import moments, plane_stress, resultants
from sheetbench.scenes.objects.natural import Natural, Temperature
from sheetbench.scenes.objects.orthotropy import Ply
from sheetbench.scenes.objects.sheet import Sheet

if TYPE_CHECKING:
    from shapely import Polygon

AnyFields = TypeVar("AnyFields", bound=SceneFields)
TENSOR = np.array([1.0, 1.0, 0.5])  # components over (xx, yy, 2xy)


class Source(NamedTuple):
    """A source of natural strain [-] and curvature [1/m], (3,) each: xx, yy, xy. where: the part of the plan
    inside which (`within`) or outside which they hold, or None: the whole plan."""

    name: str
    of: Natural | Temperature
    strain: np.ndarray
    curvature: np.ndarray
    where: Polygon | None = None
    within: bool = True


class NaturalState:
    """Natural strains and curvatures (…, 2, 2) at points or of cells, or a model's function of both (`made`).
    They depend on the load's share and the time; the last value is cached."""

    def __init__(self, sources: list[Source], shape: tuple[int, ...], share: Callable[[Polygon], np.ndarray]):
        """Add up sources on points or cells of a shape; share: a plan part's share of each of them."""
        self._courses = [source.of.course for source in sources]
        self.moves = any(source.of.history is not None for source in sources)
        self._forms = np.array([(s.strain, s.curvature) for s in sources])[..., [[0, 2], [2, 1]]]
        self._weights = np.ones((len(sources), *shape))
        for weight, source in zip(self._weights, sources, strict=True):
            if source.where is not None:
                weight[...] = share(source.where) if source.within else 1.0 - share(source.where)
        self._make: Callable[[np.ndarray, np.ndarray], Any] = lambda *both: both
        self._kept: tuple[np.ndarray, Any] | None = None

    @classmethod
    def given(cls, fields: np.ndarray) -> Self:
        """Return the state with a given strain and curvature of every cell, (rows, columns, 6)."""
        units, shape = np.eye(6).reshape(6, 2, 3), fields.shape[:-1]
        state = cls([Source("cells", Natural(), *u) for u in units], shape, lambda _: np.ones(shape))
        state._weights = np.moveaxis(fields, -1, 0)
        return state

    def made(self, make: Callable[[np.ndarray, np.ndarray], Any]) -> Self:
        """Return the state whose values are a function of strains and curvatures."""
        other = copy(self)
        other._make, other._kept = make, None
        return other

    def factors(self, time: float | None = None) -> np.ndarray:
        """Return the factor of every source at a time [s], the last without a time."""
        return np.array([course.at(time) for course in self._courses])

    def rates(self, time: float, before: bool) -> np.ndarray:
        """Return the derivatives [1/s] of the factors just after a time [s], or just before."""
        return np.array([course.slope(time, before) for course in self._courses])

    def at(self, share: float = 1.0, time: float | None = None) -> Any:
        """Return a share of the natural state at a time [s], the last without a time."""
        return self.of(share * self.factors(time))

    def of(self, factors: np.ndarray) -> Any:
        """Return the natural state with a factor for each source."""
        kept = self._kept
        if kept is None or not np.array_equal(factors, kept[0]):
            both = np.einsum("s,s...,skij->k...ij", factors, self._weights, self._forms)
            self._kept = kept = factors, self._make(*both)
        return kept[1]


def natural_at(scene: SceneFields, points: np.ndarray) -> NaturalState | None:
    """Return the state at plan points (…, 2) [m], None for a sheet that is flat at rest."""

    def share(area: Polygon) -> np.ndarray:
        import shapely

        return np.asarray(shapely.intersects_xy(area, points[..., 0], points[..., 1]), dtype=float)

    sources = list(sources_of(scene))
    return NaturalState(sources, points.shape[:-1], share) if sources else None


def natural_of_cells(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> NaturalState | None:
    """Return the state of the cells (rows, columns) between lines at x and at y [m]. A cell that several
    parts share has their mean. Return None for a sheet that is flat at rest."""
    sources, shape = list(sources_of(scene)), (len(y) - 1, len(x) - 1)
    return NaturalState(sources, shape, lambda area: shares_of(area, x, y)) if sources else None


def sources_of(scene: SceneFields) -> Iterator[Source]:
    """Yield the sources of natural strain and curvature in a scene."""
    taken: Polygon | None = None
    for n, patch in reversed([*enumerate(scene.patches, start=1)]):
        if patch.natural is not None:
            area = patch.shape.area if taken is None else patch.shape.area.difference(taken)
            yield Source(f"patch {n}", patch.natural, *_strain_and_curvature(scene, patch.natural), area)
            taken = area if taken is None else taken.union(area)
    if (natural := scene.natural) is not None:
        yield Source("natural", natural, *_strain_and_curvature(scene, natural), taken, within=False)
    if scene.temperature is not None:
        yield Source("temperature", scene.temperature, *thermal(scene, scene.temperature))


def growth_of_cells(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> np.ndarray | None:
    """Return the factors of the cells' sides at rest, (rows, columns, 2), None if they are uniform. The sides
    of a sheet with uniform growth are in `sheet_at_rest`."""
    parts = any(patch.natural is not None for patch in scene.patches)
    if not parts or (state := natural_of_cells(scene, x, y)) is None or not state.at()[0].any():
        return None
    return 1.0 + np.diagonal(state.at()[0], axis1=-2, axis2=-1)


def sheet_at_rest(scene: SceneFields) -> Sheet:
    """Return the sheet with the sides of the free sheet, to which its stiffness refers. Growth that is not
    uniform is left to `growth_of_cells`; a mesh keeps its size."""
    sources = list(sources_of(scene))
    if scene.sheet.mesh is not None or any(source.where is not None for source in sources):
        return scene.sheet
    along = sum((source.of.last_factor * source.strain[:2] for source in sources), np.zeros(2))
    (lx, ly), outline = (1.0 + along) * scene.sheet.lengths, scene.sheet.outline
    drawn = outline and tuple((x * (1.0 + along[0]), y * (1.0 + along[1])) for x, y in outline)
    return scene.sheet.replace(length_x=float(lx), length_y=float(ly), outline=drawn)


def held_at_drawn_size(scene: AnyFields, tension: Callable[[np.ndarray], np.ndarray]) -> AnyFields:
    """Return the scene with a natural strain in place of its pretension, by a model's law.

    The flat sheet, held at its drawn size, has the pretension at the last factor of its history. tension: the
    model's forces per length [Nx, Ny, Nxy] [N/m] of the held flat sheet as a function of its natural strain
    [xx, yy, xy]. Raises Impossible if no strain gives the pretension. Method: Newton's with the linear law's
    tangent, by Broyden's updates.
    """
    natural = scene.natural
    if natural is None or natural.pretension is None:
        return scene
    from scipy.optimize import root

    factor = natural.last_factor or 1.0
    compliance = -np.linalg.inv(resultants(plies_of(scene))[0] * scene.sheet.thickness) * TENSOR[:, None]
    begin = factor * compliance @ [*natural.pretension, 0.0]

    def residual(strain: np.ndarray) -> np.ndarray:
        return np.asarray(compliance @ tension(strain) - begin)

    solved = root(residual, begin, jac=lambda _: np.eye(3), options={"xtol": 1e-15})
    if not np.abs(residual(solved.x)).max() <= 1e-9 * np.abs(begin).max():
        pull = ", ".join(f"{force:g}" for force in natural.pretension)
        raise Impossible(f"natural.pretension = [{pull}]: no natural strain gives it by this model's law")
    xx, yy, xy = (solved.x / factor).tolist()
    return scene.replace(natural=natural.replace(pretension=None, strain=(xx, yy, xy)))


def _strain_and_curvature(scene: SceneFields, natural: Natural) -> tuple[np.ndarray, np.ndarray]:
    strain, curvature = np.array(natural.strain), np.array(natural.curvature)
    if natural.pretension is not None:
        stiffness = resultants(plies_of(scene))[0] * scene.sheet.thickness
        strain = -np.linalg.solve(stiffness, [*natural.pretension, 0.0]) * TENSOR
    return strain, curvature


def plies_of(scene: SceneFields) -> tuple[Ply, ...]:
    """Return the plies of a scene's sheet, one for a sheet without layers."""
    return of_sheet(scene).plies or (scene.material.ply,)


def expansion_of(scene: SceneFields, number: int) -> np.ndarray:
    """Return the thermal expansion (3,) [1/K] of a ply along x, along y and the shear, 2xy."""
    own = scene.layers[number].expansions if scene.layers else None
    along, across = own or scene.material.expansions or (0.0, 0.0)
    twice = 2.0 * plies_of(scene)[number].angle
    mean, half = 0.5 * (along + across), 0.5 * (along - across)
    return np.array([mean + half * np.cos(twice), mean - half * np.cos(twice), 2.0 * half * np.sin(twice)])


def thermal(scene: SceneFields, temperature: Temperature) -> tuple[np.ndarray, np.ndarray]:
    """Return the natural strain and curvature (3,) of a temperature, constant over the sheet."""
    h, plies, (a, b, d) = scene.sheet.thickness, plies_of(scene), resultants(plies_of(scene))
    stresses = [plane_stress(ply) @ expansion_of(scene, number) for number, ply in enumerate(plies)]
    zeroth, first, second = moments(plies, stresses)
    change, rise = temperature.change, temperature.gradient * h
    stress = np.concatenate([change * zeroth + rise * first, change * first + rise * second])
    strain, curvature = np.linalg.solve(np.block([[a, -b], [b, -d]]), stress).reshape(2, 3) * TENSOR
    return strain, curvature / h
