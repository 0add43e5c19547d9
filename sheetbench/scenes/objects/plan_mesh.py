"""A user's mesh of a sheet's plan: quadrilaterals, from a file or as numbers.

[sheet] mesh = "fin.msh"     its path relative to the scene's file

The file's triangles and quadrilaterals are used, by their corners alone: sides are straight. If there are
triangles, each is cut into three quadrilaterals and each quadrilateral into four. The outline and the holes
of the sheet are the mesh's boundary. A scene keeps the numbers, and no longer needs the file.

The file is not trusted: it is read within limits and its numbers are checked. Readers of some formats do not
end on damaged files, or open other files: only listed formats are allowed, and reading is a program of its
own (`mesh_reader`) with limits of time and memory.
"""

import sys
from collections.abc import Iterator, Mapping
from functools import cached_property
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import numpy as np
from pydantic import Field

from sheetbench.process import ONE_THREAD, run
from sheetbench.scenes.language.reading import LARGEST
from sheetbench.scenes.objects import mesh_reader
from sheetbench.scenes.objects.quantities import Frozen, PlanPoint, Unit

if TYPE_CHECKING:
    from shapely import Polygon

ROUNDING = 1e-9  # of the mesh's size: places closer than that are one
TRIANGLE, QUADRILATERAL = "triangle", "quad"
FORMATS = {  # meshio's names by the endings of files: those that hold meshes of surfaces
    **dict.fromkeys((".bdf", ".fem", ".nas"), "nastran"),
    ".inp": "abaqus",
    **dict.fromkeys((".mesh", ".meshb"), "medit"),
    ".msh": "gmsh",
    **{f".{name}": name for name in ("obj", "off", "ply", "stl", "su2", "vtk", "vtu")},
}
SECONDS, PER_MB = 20.0, 2.0  # s that reading may take, and more a megabyte of the file
MEMORY_MB = 2048
Corner = Annotated[int, Field(ge=0)]


class PlanMesh(Frozen):
    """Quadrilaterals that cover a sheet's plan; in a scene's file the name of a mesh file stands for them."""

    points: Annotated[tuple[PlanPoint, ...], Unit("m"), Field(min_length=4)]
    """Corners of the elements [x, y]."""
    quads: Annotated[tuple[tuple[Corner, Corner, Corner, Corner], ...], Field(min_length=1)]
    """Numbers of each element's corners in turn, from 0 on; neighbours share corners."""

    def _faults(self) -> Iterator[object]:
        import shapely

        points, quads = self.arrays
        beyond = f"quads: corner {quads.max()} is beyond the last of {len(points)} points"
        yield quads.max() >= len(points) and beyond
        corners = points[quads]
        onwards, back = np.roll(corners, -1, axis=1) - corners, np.roll(corners, 1, axis=1) - corners
        turn = onwards[..., 0] * back[..., 1] - onwards[..., 1] * back[..., 0]
        size = np.ptp(points, axis=0).max()
        folded = np.any(turn * np.sign(turn.sum(axis=1, keepdims=True)) <= (ROUNDING * size) ** 2, axis=1)
        at = ", ".join(f"({x:g}, {y:g})" for x, y in corners[np.argmax(folded)])
        yield folded.any() and f"the element with corners {at} m crosses itself, or is not convex"
        sides = np.sort(np.stack([quads, np.roll(quads, -1, axis=1)], axis=-1).reshape(-1, 2), axis=1)
        rim, count = np.unique(sides, axis=0, return_counts=True)
        length = np.linalg.norm(np.diff(points[rim[count == 1]], axis=1)[:, 0], axis=1).sum()
        area = shapely.area(shapely.polygons(corners)).sum()
        over = abs(self.area.area - area) > ROUNDING * area or count.max() > 2
        yield over and "elements lie over each other"
        unshared = abs(self.area.length - length) > ROUNDING * length
        yield unshared and "elements touch without sharing corners: merge what lies at one place"

    @property
    def arrays(self) -> tuple[np.ndarray, np.ndarray]:
        """Return points (n, 2) [m] and quadrilaterals (m, 4)."""
        return np.array(self.points), np.array(self.quads)

    @property
    def across(self) -> int:
        """Return the number of elements of the mean size along the shorter side."""
        size = np.sqrt(self.area.area / len(self.quads))
        return max(1, round(np.ptp(self.arrays[0], axis=0).min() / size))

    @cached_property
    def area(self) -> "Polygon":
        """Return the covered area as a polygon of shapely, several polygons if the mesh is in pieces."""
        import shapely

        points, quads = self.arrays
        covered = shapely.union_all(shapely.polygons(points[quads]))
        return covered.simplify(ROUNDING * np.ptp(points, axis=0).max())


def read_file(path: Path, formats: Mapping[str, str] = FORMATS) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return points (n, 2 or 3), and the other arrays of `mesh_reader` by their names.

    They are corners of triangles (k, 3) and quadrilaterals (m, 4), or a drawing's rings and unit. formats:
    the reader's names of formats by the endings of files. Raises ValueError with a clause on the reason.
    """
    kind = formats.get(path.suffix.lower())
    if kind is None:
        endings, subject = ", ".join(formats), "mesh" if formats is FORMATS else "drawing"
        more = ": convert it, as with meshio convert" * (formats is FORMATS)
        raise ValueError(f"a {subject} file's name ends in one of {endings}{more}")
    if not path.is_file():
        raise ValueError("no such file")
    size = path.stat().st_size
    if size > LARGEST:
        raise ValueError(f"larger than {LARGEST // 2**20} MB, which no such file is")
    # -P: the program does not import modules of its folder
    command = [sys.executable, "-P", mesh_reader.__file__, str(path), kind]
    seconds = SECONDS + PER_MB * size // 2**20
    process = run(command, b"", seconds, MEMORY_MB, most=LARGEST, variables=ONE_THREAD)
    if process.code == mesh_reader.REFUSED and not process.stopped:
        raise ValueError(process.complaint)
    if process.fault:
        raise ValueError(f"it cannot be read: {process.fault}")
    with np.load(BytesIO(process.answer)) as archive:
        arrays = dict(archive)
    return arrays.pop("points"), arrays


def mesh_of(points: np.ndarray, cells: dict[str, np.ndarray]) -> PlanMesh:
    """Return the mesh of plan points (n, 2) [m] and of polygons of 3 and of 4 corners. Raises ValueError if a
    corner names a point that is missing or not finite."""
    for kind, corners in cells.items():
        if corners.dtype.kind not in "iu":
            raise ValueError(f"a {kind}'s corners are no whole numbers")
        strange = corners[(corners < 0) | (corners >= len(points))]
        if len(strange):
            raise ValueError(
                f"a {kind} has point {strange[0]}, counted from 0; the file has {len(points)} points"
            )
        if not np.isfinite(points[corners]).all():
            raise ValueError(f"a corner of a {kind} is no finite number")
    used = np.unique(np.concatenate([one.ravel() for one in cells.values()]))
    points, every = points[used], {kind: np.searchsorted(used, one) for kind, one in cells.items()}
    corners = every.get(QUADRILATERAL, np.empty((0, 4), int))
    if TRIANGLE in every:
        points, corners = divided(points, [corners, every[TRIANGLE]])
    return PlanMesh(points=tuple(map(tuple, points.tolist())), quads=tuple(map(tuple, corners.tolist())))


def divided(points: np.ndarray, polygons: list[np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Cut polygons (k, c) about their middles into quadrilaterals (m, 4) of points (n, 2) [m]."""
    sides = [np.stack([one, np.roll(one, -1, axis=1)], axis=-1) for one in polygons]
    pairs = np.sort(np.concatenate([side.reshape(-1, 2) for side in sides]), axis=1)
    ends, which = np.unique(pairs, axis=0, return_inverse=True)
    centres = [points[one].mean(axis=1) for one in polygons]
    every = np.concatenate([points, points[ends].mean(axis=1), *centres])
    quads, first, centre = [], 0, len(points) + len(ends)
    for one in polygons:
        on = len(points) + which.ravel()[first : first + one.size].reshape(one.shape)
        middle = np.broadcast_to(centre + np.arange(len(one))[:, None], one.shape)
        quads.append(np.stack([one, on, middle, np.roll(on, 1, axis=1)], axis=-1).reshape(-1, 4))
        first, centre = first + one.size, centre + len(one)
    return every, np.concatenate(quads)
