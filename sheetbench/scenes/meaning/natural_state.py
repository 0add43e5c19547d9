"""The natural strain and curvature of a scene's sheet at points or of cells: of [natural], of patches with
their own, which win where they are, and of [temperature]; each with its history."""

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
    """strain, curvature: (3,), xx, yy, xy [-], [1/m]; where: the part of the plan that has them or, if not
    `within`, has not; None for all of it."""

    name: str
    of: Natural | Temperature
    strain: np.ndarray
    curvature: np.ndarray
    where: Polygon | None = None
    within: bool = True


class NaturalState:
    """Natural strains and curvatures (…, 2, 2) at points or of cells, or what a model makes of both (`made`),
    as a function of the load's share and the time; the last value is kept."""

    def __init__(self, sources: list[Source], shape: tuple[int, ...], share: Callable[[Polygon], np.ndarray]):
        """shape: of the points or cells; share: of each of them that a part of the plan has."""
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
        """Return the state of a strain and a curvature of every cell, (rows, columns, 6), xx, yy and xy."""
        units, shape = np.eye(6).reshape(6, 2, 3), fields.shape[:-1]
        state = cls([Source("cells", Natural(), *u) for u in units], shape, lambda _: np.ones(shape))
        state._weights = np.moveaxis(fields, -1, 0)
        return state

    def made(self, make: Callable[[np.ndarray, np.ndarray], Any]) -> Self:
        """Return the state as what this makes of strains and curvatures."""
        other = copy(self)
        other._make, other._kept = make, None
        return other

    def factors(self, time: float | None = None) -> np.ndarray:
        """Return the factor of every source at a time [s], without one the last."""
        return np.array([course.at(time) for course in self._courses])

    def rates(self, time: float, before: bool) -> np.ndarray:
        """Return their derivatives [1/s] from a time on, or until then."""
        return np.array([course.slope(time, before) for course in self._courses])

    def at(self, share: float = 1.0, time: float | None = None) -> Any:
        """Return a share of the natural state at a time [s], without one the last."""
        return self.of(share * self.factors(time))

    def of(self, factors: np.ndarray) -> Any:
        """Return so many times what each source has."""
        kept = self._kept
        if kept is None or not np.array_equal(factors, kept[0]):
            both = np.einsum("s,s...,skij->k...ij", factors, self._weights, self._forms)
            self._kept = kept = factors, self._make(*both)
        return kept[1]


def natural_at(scene: SceneFields, points: np.ndarray) -> NaturalState | None:
    """Return the state at plan points (…, 2) [m], None of a sheet that is flat at rest."""

    def share(area: Polygon) -> np.ndarray:
        import shapely

        return np.asarray(shapely.intersects_xy(area, points[..., 0], points[..., 1]), dtype=float)

    sources = list(sources_of(scene))
    return NaturalState(sources, points.shape[:-1], share) if sources else None


def natural_of_cells(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> NaturalState | None:
    """Return the state of the cells between lines at x and at y [m], (rows, columns): a cell that several
    parts share has their mean; None of a sheet that is flat at rest."""
    sources, shape = list(sources_of(scene)), (len(y) - 1, len(x) - 1)
    return NaturalState(sources, shape, lambda area: shares_of(area, x, y)) if sources else None


def sources_of(scene: SceneFields) -> Iterator[Source]:
    """Yield what makes a scene's sheet other than flat at rest."""
    taken: Polygon | None = None
    for n, patch in reversed([*enumerate(scene.patches, start=1)]):
        if patch.natural is not None:
            area = patch.shape.area if taken is None else patch.shape.area.difference(taken)
            yield Source(f"patch {n}", patch.natural, *_own(scene, patch.natural), area)
            taken = area if taken is None else taken.union(area)
    if scene.natural is not None:
        yield Source("natural", scene.natural, *_own(scene, scene.natural), taken, within=False)
    if scene.temperature is not None:
        yield Source("temperature", scene.temperature, *thermal(scene, scene.temperature))


def growth_of_cells(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> np.ndarray | None:
    """Return how many times as long and as wide cells are at rest, (rows, columns, 2); None where all are
    alike (`sheet_at_rest`)."""
    parts = any(patch.natural is not None for patch in scene.patches)
    if not parts or (state := natural_of_cells(scene, x, y)) is None or not state.at()[0].any():
        return None
    return 1.0 + np.diagonal(state.at()[0], axis1=-2, axis2=-1)


def sheet_at_rest(scene: SceneFields) -> Sheet:
    """Return the sheet as long and as wide as it is where nothing holds it, which its stiffness is that of,
    if it has grown alike all over (else `growth_of_cells`); a mesh keeps its size."""
    sources = list(sources_of(scene))
    if scene.sheet.mesh is not None or any(source.where is not None for source in sources):
        return scene.sheet
    along = sum((source.of.last_factor * source.strain[:2] for source in sources), np.zeros(2))
    (lx, ly), outline = (1.0 + along) * scene.sheet.lengths, scene.sheet.outline
    drawn = outline and tuple((x * (1.0 + along[0]), y * (1.0 + along[1])) for x, y in outline)
    return scene.sheet.replace(length_x=float(lx), length_y=float(ly), outline=drawn)


def held_at_drawn_size(scene: AnyFields, tension: Callable[[np.ndarray], np.ndarray]) -> AnyFields:
    """Return the scene with, in place of its pretension, the natural strain with which a sheet held where it
    is drawn has it by a model's own law, at the last factor of a history.

    tension: natural strain [xx, yy, xy] → [Nx, Ny, Nxy] [N/m] of the flat sheet so held. Raises Impossible
    where no strain gives it. Newton's method with the linear law's tangent, by Broyden's updates."""
    natural = scene.natural
    if natural is None or natural.pretension is None:
        return scene
    from scipy.optimize import root

    factor = natural.last_factor or 1.0
    compliance = -np.linalg.inv(resultants(plies_of(scene))[0] * scene.sheet.thickness) * TENSOR[:, None]
    begin = factor * compliance @ [*natural.pretension, 0.0]

    def left(strain: np.ndarray) -> np.ndarray:
        return np.asarray(compliance @ tension(strain) - begin)

    found = root(left, begin, jac=lambda _: np.eye(3), options={"xtol": 1e-15})
    if not np.abs(left(found.x)).max() <= 1e-9 * np.abs(begin).max():
        pull = ", ".join(f"{force:g}" for force in natural.pretension)
        raise Impossible(f"natural.pretension = [{pull}]: no natural strain gives it by this model's law")
    xx, yy, xy = (found.x / factor).tolist()
    return scene.replace(natural=natural.replace(pretension=None, strain=(xx, yy, xy)))


def _own(scene: SceneFields, natural: Natural) -> tuple[np.ndarray, np.ndarray]:
    strain, curvature = np.array(natural.strain), np.array(natural.curvature)
    if natural.pretension is not None:
        stiffness = resultants(plies_of(scene))[0] * scene.sheet.thickness
        strain = -np.linalg.solve(stiffness, [*natural.pretension, 0.0]) * TENSOR
    return strain, curvature


def plies_of(scene: SceneFields) -> tuple[Ply, ...]:
    """Return the plies of a scene's sheet, or the one that all of it is."""
    return of_sheet(scene).plies or (scene.material.ply,)


def expansion_of(scene: SceneFields, number: int) -> np.ndarray:
    """Return the thermal expansion (3,) [1/K] of a ply along x, along y and the shear, 2xy."""
    own = scene.layers[number].expansions if scene.layers else None
    along, across = own or scene.material.expansions or (0.0, 0.0)
    twice = 2.0 * plies_of(scene)[number].angle
    mean, half = 0.5 * (along + across), 0.5 * (along - across)
    return np.array([mean + half * np.cos(twice), mean - half * np.cos(twice), 2.0 * half * np.sin(twice)])


def thermal(scene: SceneFields, temperature: Temperature) -> tuple[np.ndarray, np.ndarray]:
    """Return natural strain and curvature (3,) of a temperature, all over the sheet."""
    h, found, (a, b, d) = scene.sheet.thickness, plies_of(scene), resultants(plies_of(scene))
    pulls = [plane_stress(ply) @ expansion_of(scene, number) for number, ply in enumerate(found)]
    one, two, three = moments(found, pulls)
    change, rise = temperature.change, temperature.gradient * h
    stress = np.concatenate([change * one + rise * two, change * two + rise * three])
    strain, curvature = np.linalg.solve(np.block([[a, -b], [b, -d]]), stress).reshape(2, 3) * TENSOR
    return strain, curvature / h
