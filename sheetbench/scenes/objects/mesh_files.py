"""Points and cells of a mesh file, which may be another person's: read within limits, its numbers checked.

Readers of some formats do not end on damaged files, or open other files: formats are those of a list, and
reading is a program of its own (`mesh_reader`) with limits of time and memory.
"""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path

import numpy as np

from sheetbench.process import ONE_THREAD, run
from sheetbench.scenes.language.reading import LARGEST
from sheetbench.scenes.objects import mesh_reader

FORMATS = {  # meshio's names by the endings of files: those that hold meshes of surfaces
    **dict.fromkeys((".bdf", ".fem", ".nas"), "nastran"),
    ".inp": "abaqus",
    **dict.fromkeys((".mesh", ".meshb"), "medit"),
    ".msh": "gmsh",
    ".obj": "obj",
    ".off": "off",
    ".ply": "ply",
    ".stl": "stl",
    ".su2": "su2",
    ".vtk": "vtk",
    ".vtu": "vtu",
}
SECONDS, PER_MB = 20.0, 2.0  # s that reading may take, and more a megabyte of the file
MEMORY_MB = 2048


def read_cells(path: Path) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return points (n, 2 or 3) [m], and corners of triangles (k, 3) and quadrilaterals (m, 4) by kind.

    The points that cells name are there and finite. Raises ValueError with a clause that says what is wrong.
    """
    kind = FORMATS.get(path.suffix.lower())
    if kind is None:
        known = ", ".join(FORMATS)
        raise ValueError(f"a mesh file's name ends in one of {known}: convert it, as with meshio convert")
    if not path.is_file():
        raise ValueError("no such file")
    size = path.stat().st_size
    if size > LARGEST:
        raise ValueError(f"larger than {LARGEST // 2**20} MB, which no such file is")
    # -P: the modules beside the program are not its own
    command = [sys.executable, "-P", mesh_reader.__file__, str(path), kind]
    seconds = SECONDS + PER_MB * size // 2**20
    ended = run(command, b"", seconds, MEMORY_MB, most=LARGEST, variables=ONE_THREAD)
    if ended.code == mesh_reader.REFUSED and not ended.stopped:
        raise ValueError(ended.complaint)
    if ended.fault:
        raise ValueError(f"it cannot be read: {ended.fault}")
    with np.load(BytesIO(ended.answer)) as archive:
        arrays = dict(archive)
    points = arrays.pop("points")
    _check(points, arrays)
    return points, arrays


def _check(points: np.ndarray, cells: dict[str, np.ndarray]) -> None:
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError("a point has two or three coordinates")
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
