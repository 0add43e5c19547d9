"""Composition of a sheet at a point: tapers of its thickness, and patches, of which the last one wins.

    h(x, y) = thickness · (taper_x(x)/thickness) · (taper_y(y)/thickness)

outside patches with a thickness of their own. A plain sheet is homogeneous.
"""

from collections.abc import Iterator
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from sheetbench.errors import Impossible
from sheetbench.scenes.meaning.region import area_in
from sheetbench.scenes.objects.cells import NUMBERS, Constants
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.layers import plies
from sheetbench.scenes.objects.loads import AreaLoad, PointLoad
from sheetbench.scenes.objects.orthotropy import in_own_axes
from sheetbench.scenes.objects.patches import Patch
from sheetbench.scenes.objects.shapes import COINCIDENT, straight_sides

TAPER_LINES = 33  # lines a side; between them a taper has its mean thickness
LEAST_SHARE = 1e-12  # of a cell's area, below which a part is rounding


class Part(NamedTuple):
    """A part of the sheet on a grid: its share of each cell's area, and its constants, (rows, columns)."""

    share: np.ndarray
    constants: Constants


def of_sheet(scene: SceneFields) -> Constants:
    """Return the constants of a scene's sheet and its layers, without tapers and patches."""
    constants = Constants.of(scene.sheet, scene.material)
    return constants.replace(plies=plies(scene.layers, scene.material)) if scene.layers else constants


def constants_at(scene: SceneFields, points: np.ndarray) -> Constants:
    """Return the constants at plan points (…, 2) [m], arrays (…); numbers if the sheet is homogeneous."""
    sheet = of_sheet(scene)
    if scene.homogeneous:
        return sheet
    constants = sheet.arrays(points.shape[:-1])
    constants.thickness[...] = scene.sheet.thickness_at(points[..., 0], points[..., 1])
    for patch in scene.patches:
        _write_constants(constants, patch.own, patch.shape.contains(points))
    return constants


def composition_at(scene: SceneFields, points: np.ndarray) -> dict[str, np.ndarray]:
    """Return constants and, if there are patches, their numbers at plan points (…, 2) [m], by name. Each is
    an array (…); points outside patches have the number 0."""
    patch = np.zeros(points.shape[:-1])
    for number, each in enumerate(scene.patches, start=1):
        patch[each.shape.contains(points)] = number
    constants = constants_at(scene, points).arrays(points.shape[:-1]).by_name()
    return {"patch": patch, **constants} if scene.patches else constants


def _write_constants(constants: Constants, given: dict[str, float], where: Any = ...) -> None:
    """Write a patch's own constants into arrays."""
    for name, value in given.items():
        if name in NUMBERS:
            getattr(constants, name)[where] = value
    for ply in constants.plies:
        for name, value in in_own_axes(given).items():
            getattr(ply, name)[where] = value


def parts_between(scene: SceneFields, x: np.ndarray, y: np.ndarray) -> Iterator[Part]:
    """Yield the parts of the sheet with their shares of the cells between lines at x and at y [m]. An outline
    is ignored: the shares of every cell add up to 1. A taper has its thickness of a cell's middle."""
    middle = 0.5 * (x[1:] + x[:-1]), 0.5 * (y[1:] + y[:-1])
    plain = of_sheet(scene).replace(thickness=scene.sheet.thickness_at(*np.meshgrid(*middle)))
    left_over = np.ones((len(y) - 1, len(x) - 1))
    for area, own in _disjoint_areas(own_patches(scene)):
        share = shares_of(area, x, y)
        left_over -= share
        constants = plain.arrays(left_over.shape)
        _write_constants(constants, own)
        yield Part(share, constants)
    yield Part(_without_rounding(left_over), plain.arrays(left_over.shape))


def shares_of(area: Any, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return an area's share (rows, columns) of every cell between lines at x and at y [m]."""
    import shapely

    shapely.prepare(area)
    boxes = boxes_of(x, y)
    touched = shapely.intersects(area, boxes)
    share = np.zeros(boxes.shape)
    share[touched] = shapely.area(shapely.intersection(area, boxes[touched])) / shapely.area(boxes[touched])
    return _without_rounding(share)


def boxes_of(x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Return the cells between lines at x and at y [m] as boxes of shapely, (rows, columns)."""
    import shapely

    low, left = np.meshgrid(y[:-1], x[:-1], indexing="ij")
    high, right = np.meshgrid(y[1:], x[1:], indexing="ij")
    return np.asarray(shapely.box(left, low, right, high))


def own_patches(scene: SceneFields) -> tuple[Patch, ...]:
    """Return the patches that change the composition. A patch with the sheet's own constants changes it only
    where it covers another patch."""
    even = not (scene.sheet.taper_x or scene.sheet.taper_y)
    usual = {**vars(scene.material), "thickness": scene.sheet.thickness if even else None}
    patches: list[Patch] = []
    for patch in scene.patches:
        differs = any(value != usual.get(name) for name, value in patch.own.items())
        covers = any(patch.shape.area.intersects(each.shape.area) for each in patches)
        if differs or (patch.own and covers):
            patches.append(patch)
    return tuple(patches)


def _disjoint_areas(patches: tuple[Patch, ...]) -> Iterator[tuple[Any, dict[str, float]]]:
    """Yield the areas that one set of patches covers, with the constants that differ from the sheet's."""
    import shapely

    pieces: list[tuple[Any, dict[str, float]]] = []
    for patch in patches:
        new = patch.shape.area
        touched = shapely.intersects(new, np.array([area for area, _ in pieces], dtype=object))
        cut = [piece for piece, touches in zip(pieces, touched, strict=True) if touches]
        pieces = [piece for piece, touches in zip(pieces, touched, strict=True) if not touches]
        parts = [(area.intersection(new), {**own, **patch.own}) for area, own in cut]
        parts += [(area.difference(new), own) for area, own in cut]
        parts.append((new.difference(shapely.union_all([area for area, _ in cut])), patch.own))
        pieces += [(area, own) for area, own in parts if area.area > 0.0]
    yield from pieces


def _without_rounding(share: np.ndarray) -> np.ndarray:
    share = np.where(share < LEAST_SHARE, 0.0, share)
    return np.where(share > 1.0 - LEAST_SHARE, 1.0, share)


def mass_of(scene: SceneFields) -> float:
    """Return the mass [kg] of the sheet."""
    sheet = scene.sheet
    if scene.homogeneous:
        return float(of_sheet(scene).per_area * area_in(scene, None))
    x, y = (np.linspace(0.0, length, TAPER_LINES) for length in sheet.lengths)
    per_area = sum(part.share * part.constants.per_area for part in parts_between(scene, x, y))
    if scene.pierced:
        per_area *= shares_of(scene.region, x, y)
    return float(np.diff(y) @ per_area @ np.diff(x))


def payload_mass(scene: SceneFields) -> float:
    """Return the mass [kg] of all payloads."""
    return sum(payload.mass for payload in scene.masses)


def weights(scene: SceneFields) -> tuple[PointLoad | AreaLoad, ...]:
    """Return the payloads' weight as loads, with gravity's history; none without gravity."""
    if scene.gravity is None:
        return ()
    loads: list[PointLoad | AreaLoad] = []
    for payload in scene.masses:
        x, y, z = (payload.mass * np.array(scene.gravity.acceleration)).tolist()
        if payload.at is not None:
            loads.append(PointLoad(at=payload.at, force=(x, y, z), history=scene.gravity.history))
            continue
        area = area_in(scene, payload.where)
        per_area, history = (x / area, y / area, z / area), scene.gravity.history
        loads.append(AreaLoad(force_per_area=per_area, where=payload.where, history=history))
    return tuple(loads)


def mass_over_stiffness(scene: SceneFields) -> float:
    """Return ρ/E [s²/m²] of the sheet: its mass over the integral of its membrane stiffness E h. A taper is
    ignored: the thickness is the sheet's."""
    sheet = of_sheet(scene)
    if scene.homogeneous:
        return float(sheet.per_area / sheet.stretching)
    rest, mass, stiffness = area_in(scene, None), 0.0, 0.0
    for area, own in _disjoint_areas(own_patches(scene)):
        constants, size = sheet.arrays(()), scene.region.intersection(area).area
        _write_constants(constants, own)
        rest -= size
        mass, stiffness = mass + size * constants.per_area, stiffness + size * constants.stretching
    return float((mass + rest * sheet.per_area) / (stiffness + rest * sheet.stretching))


def sides_of(scene: SceneFields) -> tuple[np.ndarray, np.ndarray]:
    """Return x and y [m], rising, of the patches' axis-parallel sides within the sheet's edges."""
    places, areas = [], [patch.shape.area for patch in own_patches(scene)]
    for axis, length in enumerate(scene.sheet.lengths):
        sides = np.unique([*straight_sides(*areas)[axis]])
        inside = sides[(sides > COINCIDENT * length) & (sides < (1.0 - COINCIDENT) * length)]
        places.append(inside[np.diff(inside, prepend=-length) > COINCIDENT * length])
    return places[0], places[1]


def _require(by: str, known: str, scene: SceneFields, who: str, instead: str = "") -> None:
    if words := getattr(scene, by):
        more = f"; {instead}" if instead else ""
        raise Impossible(f"scene '{scene.name}': {words}: {who} is for {known}{more}")


# each raises Impossible for a scene with a sheet that `who`, a verb, a model or a file, does not support;
# instead: a clause on an alternative that does
require_uniform = partial(_require, "varied_by", "isotropic sheets that are the same all over")
require_rectangle = partial(_require, "shaped_by", "whole rectangles held at their edges")
require_flat_at_rest = partial(_require, "natural_by", "sheets that are flat at rest")


def require_plain(scene: SceneFields, who: str) -> None:
    """Raise Impossible for a sheet that is not plain (`Scene.drawn_by`), in the name of `who`."""
    for require in (require_uniform, require_rectangle, require_flat_at_rest):
        require(scene, who)
