"""The natural strain and curvature of a scene's sheet at points or of cells: of [natural], of patches with
their own, which win where they are, and of [temperature]; each with its history."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from sheetbench.scenes.meaning.composition import boxes_of, of_sheet, shares_in
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.layers import plane_stress, resultants
from sheetbench.scenes.objects.natural import Natural, Temperature
from sheetbench.scenes.objects.orthotropy import Ply
from sheetbench.scenes.objects.sheet import Sheet
from sheetbench.scenes.objects.tables import PiecewiseLinear

if TYPE_CHECKING:
    from shapely import Polygon


@dataclass(frozen=True, eq=False)
class Source:
    """strain, curvature: (3,), xx, yy, xy [-], [1/m]; where: the part of the plan that has them, `beyond` the
    part that has not, None for all of it and none."""

    of: Natural | Temperature
    strain: np.ndarray
    curvature: np.ndarray
    where: Polygon | None = None
    beyond: Polygon | None = None

    @cached_property
    def course(self) -> PiecewiseLinear | None:
        """Return its factor over time, None of one that is constant."""
        history = self.of.history
        return None if history is None else PiecewiseLinear(history.time, history.factor)


class NaturalState:
    """Natural strains and curvatures at points or of cells (…), at any share and time."""

    def __init__(self, sources: list[Source], shape: tuple[int, ...], share: Callable[[Polygon], np.ndarray]):
        """shape: of the points or cells; share: of each of them that a part of the plan has."""
        self._sources = sources
        self._weights = []
        for source in sources:
            weight = np.ones(shape) if source.where is None else share(source.where)
            self._weights.append(weight if source.beyond is None else weight - share(source.beyond))

    @property
    def moves(self) -> bool:
        """Whether it changes over time."""
        return any(source.of.history is not None for source in self._sources)

    def factors(self, time: float | None = None) -> np.ndarray:
        """Return the factor of every source at a time [s], without one the last."""
        return np.array([1.0 if s.course is None else float(s.course.at(time)) for s in self._sources])

    def rates(self, time: float, before: bool) -> np.ndarray:
        """Return their derivatives [1/s] from a time on, or until then."""
        return np.array(
            [0.0 if s.course is None else float(s.course.slope(time, before)) for s in self._sources]
        )

    def at(self, factors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return strains and curvatures, both (…, 2, 2)."""
        parts = list(zip(factors, self._weights, self._sources, strict=True))
        strain = sum(f * np.multiply.outer(w, _matrix(s.strain)) for f, w, s in parts)
        curvature = sum(f * np.multiply.outer(w, _matrix(s.curvature)) for f, w, s in parts)
        return np.asarray(strain), np.asarray(curvature)


def _matrix(parts: np.ndarray) -> np.ndarray:
    return np.array([[parts[0], parts[2]], [parts[2], parts[1]]])


def natural_at(scene: SceneFields, points: np.ndarray) -> NaturalState | None:
    """Return the state at plan points (…, 2) [m], None of a sheet that is flat at rest."""
    import shapely

    x, y = np.moveaxis(points, -1, 0)
    return _state(scene, x.shape, lambda area: np.asarray(shapely.intersects_xy(area, x, y), dtype=float))


def natural_of_cells(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> NaturalState | None:
    """Return the state of the cells between lines at x and at y [m], (rows, columns): a cell that several
    parts share has their mean; None of a sheet that is flat at rest."""
    return _state(scene, (len(y) - 1, len(x) - 1), lambda area: shares_in(area, boxes_of(x, y)))


def _state(
    scene: SceneFields, shape: tuple[int, ...], share: Callable[[Polygon], np.ndarray]
) -> NaturalState | None:
    sources = list(sources_of(scene))
    return NaturalState(sources, shape, share) if sources else None


def sources_of(scene: SceneFields) -> Iterator[Source]:
    """Yield what makes a scene's sheet other than flat at rest."""
    import shapely

    taken: Polygon | None = None
    for patch in scene.patches[::-1]:
        if patch.natural is None:
            continue
        area = patch.shape.area if taken is None else patch.shape.area.difference(taken)
        yield Source(patch.natural, *_own(scene, patch.natural), where=area)
        taken = area if taken is None else shapely.union_all([taken, area])
    if scene.natural is not None:
        yield Source(scene.natural, *_own(scene, scene.natural), beyond=taken)
    if scene.temperature is not None:
        yield Source(scene.temperature, *thermal(scene, scene.temperature))


def growth_of_cells(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> np.ndarray | None:
    """Return how many times as long and as wide cells are at rest, (rows, columns, 2); None where all are
    alike (`sheet_at_rest`)."""
    if all(patch.natural is None for patch in scene.patches):
        return None
    state = natural_of_cells(scene, x, y)
    assert state is not None
    strain = state.at(state.factors())[0]
    return 1.0 + np.diagonal(strain, axis1=-2, axis2=-1) if strain.any() else None


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


def _own(scene: SceneFields, natural: Natural) -> tuple[np.ndarray, np.ndarray]:
    strain, curvature = np.array(natural.strain), np.array(natural.curvature)
    if natural.pretension is not None:
        section = plies_of(scene)
        stiffness = resultants(section)[0] * scene.sheet.thickness
        xx, yy, twice = np.linalg.solve(stiffness, [*natural.pretension, 0.0])
        strain = -np.array([xx, yy, 0.5 * twice])
    return strain, curvature


def plies_of(scene: SceneFields) -> tuple[Ply, ...]:
    """Return the plies of a scene's sheet, or the one that all of it is."""
    return of_sheet(scene).plies or (scene.material.ply,)


def expansion_of(scene: SceneFields, number: int) -> np.ndarray:
    """Return the thermal expansion (3,) [1/K] of a ply along x, along y and the shear, 2xy."""
    own = scene.layers[number].expansions if scene.layers else None
    along, across = own or scene.material.expansions or (0.0, 0.0)
    angle = plies_of(scene)[number].angle
    c, s = np.cos(angle), np.sin(angle)
    mixed = 2.0 * (along - across) * c * s
    return np.array([along * c * c + across * s * s, along * s * s + across * c * c, mixed])


def thermal(scene: SceneFields, temperature: Temperature) -> tuple[np.ndarray, np.ndarray]:
    """Return natural strain and curvature (3,) of a temperature, all over the sheet."""
    h, found = scene.sheet.thickness, plies_of(scene)
    stretch, bend = np.zeros(3), np.zeros(3)
    for number, ply in enumerate(found):
        pull = plane_stress(ply) @ expansion_of(scene, number)
        one, two, three = ((ply.high**n - ply.low**n) / n for n in (1, 2, 3))
        stretch += pull * (temperature.change * one + temperature.gradient * h * two)
        bend += pull * (temperature.change * two + temperature.gradient * h * three)
    a, b, d = resultants(found)
    forms = np.block([[a, -b], [b, -d]])
    xx, yy, xy, *bent = np.linalg.solve(forms, np.concatenate([stretch, bend]))
    return np.array([xx, yy, 0.5 * xy]), np.array([bent[0], bent[1], 0.5 * bent[2]]) / h
