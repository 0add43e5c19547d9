"""Meshes with fields in the viewer's format: plain data, ready for JSON.

Numbers go as little-endian bytes in base64, four a number: float32 keeps seven digits, a tenth of a
micrometre on a metre, and takes half the room of decimals. Lengths are in metres, also of displacements.
"""

from base64 import b64encode
from collections.abc import Iterable, Mapping, Sequence
from functools import cache, partial
from importlib import resources
from typing import Any

import numpy as np

from comparisons.pictures.plan import PLAN_CELLS, eye_heading, load_arrows, rims
from sheetbench.answers.solution import FieldMesh
from sheetbench.scenes import EDGES, Scene, holds_director
from sheetbench.scenes.objects.supports import place

# corners of a brick's faces, outwards, as VTK numbers its nodes; those of quadratic ones come after them
FACES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))
QUADS, TRIANGLES = ("quad", "quad8", "quad9"), ("triangle", "triangle6")
PLANE_POINTS = 18  # points through which a plane is laid: 3 × 3 masses of two layers
LINES = 8  # cells a side that lines on a finer surface mark


@cache
def own_text(name: str) -> str:
    """Return the text of a file of the page. `viewer.js` is `source/` bundled with three.js by `make viewer`;
    it defines `Sheets.createViewer(element, options)`, with the options that this module makes and
    `source/index.js` describes, makes no request and evaluates no text."""
    return resources.files("comparisons.pages").joinpath(name).read_text(encoding="utf-8")


def packed(values: Any) -> dict[str, str]:
    """Return numbers of any shape for the viewer: integers as uint32, others as float32."""
    array = np.asarray(values)
    kind = "uint32" if array.dtype.kind in "iu" else "float32"
    return {kind: b64encode(np.ascontiguousarray(array, dtype=f"<{kind[0]}4").tobytes()).decode("ascii")}


def displaced(component: str | None = None) -> dict[str, Any]:
    """Return a field that the viewer computes from the displacement: its magnitude, or a component x, y or
    z."""
    if component is None:
        return {"name": "displacement", "label": "Displacement", "unit": "mm", "scale": 1e3}
    named = {"name": f"u{component}", "label": f"Displacement u{component}"}
    return {**named, "unit": "mm", "scale": 1e3, "component": component}


def field(name: str, label: str, values: np.ndarray, unit: str = "", scale: float = 1.0) -> dict[str, Any]:
    """Return a field of values (n,), shown times `scale` in `unit`; coloured about zero if one is below."""
    kind = "signed" if np.nanmin(values, initial=0.0) < 0.0 else "magnitude"
    shown = {"name": name, "label": label, "unit": unit, "scale": scale, "kind": kind}
    return {**shown, "values": packed(values)}


def viewer_sheet(
    name: str,
    mesh: FieldMesh,
    label: str = "",
    fields: Iterable[Mapping[str, Any]] = (),
    scene: Scene | None = None,
    frames: Sequence[tuple[float, np.ndarray]] = (),
) -> dict[str, Any]:
    """Return a sheet for the viewer: a lattice where the mesh has links, else a surface.

    fields: beside the displacement and its components; scene: for its supports; frames: time [s] and
    displacement (n, 3) [m]. A mesh of bricks shows its outer faces.
    """
    lattice = any(kind == "line" for kind, _ in mesh.cells)
    u = mesh.point_data["displacement"]
    aligned, faint, strong = _find_links(mesh) if lattice else (_find_sides(mesh), _NONE, _NONE)
    sheet: dict[str, Any] = {
        "name": name,
        "label": label or name,
        "style": "lattice" if lattice else "surface",
        "points": packed(np.asarray(mesh.points, dtype=float)),
        "displacement": packed(np.nan_to_num(u)),
        "lines": packed(aligned),
        "faint": packed(faint),
        "strong": packed(strong),
        "fields": [displaced(), *(displaced(axis) for axis in "xyz"), *fields],
    }
    if not lattice:
        sheet |= {"quads": packed(_find_quads(mesh)), "triangles": packed(_find_cells(mesh, TRIANGLES, 3))}
    if scene is not None:
        sheet["held"] = _find_held(mesh.points, scene)
        sheet["forces"] = forces(mesh.points, u, scene)
    if frames:
        sheet["frames"] = [{"time": time, "displacement": packed(np.nan_to_num(u))} for time, u in frames]
    return sheet


def forces(points: np.ndarray, displacement: np.ndarray, scene: Scene) -> list[dict[str, Any]]:
    """Return arrows of the scene's loads, as in the pictures; points (n, 3) [m]: of the mesh at rest;
    displacement (n, 3) [m]: at the points."""
    plan, arrows = load_arrows(scene, partial(_fit_normals, points, np.nan_to_num(displacement)))
    result = []
    for at, arrow in zip(plan, max(scene.sheet.lengths) * arrows, strict=True):
        if arrow.any():
            nearest = int(np.argmin(np.linalg.norm(points[:, :2] - at, axis=1)))
            result.append({"point": nearest, "at": [*at.tolist(), 0.0], "along": arrow.tolist()})
    return result


def _fit_normals(points: np.ndarray, displacement: np.ndarray, plan: np.ndarray) -> np.ndarray:
    """Return unit normals (n, 3) of the deformed mesh at plan points (n, 2): of planes through nearby
    points."""
    normals = np.zeros((len(plan), 3))
    for i, point in enumerate(plan):
        nearest = np.argsort(np.linalg.norm(points[:, :2] - point, axis=1))[:PLANE_POINTS]
        flat = np.column_stack([points[nearest, :2] - point, np.ones(len(nearest))])
        tangents = np.linalg.lstsq(flat, (points + displacement)[nearest], rcond=None)[0]
        normal = np.cross(tangents[0], tangents[1])
        normals[i] = normal / (np.linalg.norm(normal) or 1.0)
    return normals


def outline(scene: Scene) -> dict[str, str]:
    """Return the corners of the undeformed sheet in turn."""
    corners = rims(scene)[0][:-1]
    return packed(np.column_stack([corners, np.zeros(len(corners))]))


def eye(scene: Scene) -> list[float]:
    """Return the direction to an eye on the sheet's free side, above and a little aside."""
    heading = eye_heading(scene)
    return [float(np.cos(heading)), float(np.sin(heading)), 0.55]


_NONE = np.zeros((0, 2), dtype=int)


def _find_cells(mesh: FieldMesh, kinds: Sequence[str], corners: int) -> np.ndarray:
    parts = [np.asarray(cells)[:, :corners] for kind, cells in mesh.cells if kind in kinds]
    return np.concatenate(parts) if parts else np.zeros((0, corners), dtype=int)


def _find_quads(mesh: FieldMesh) -> np.ndarray:
    """Return the quadrilaterals of the mesh and the outer faces of its bricks, (m, 4)."""
    parts = [_find_cells(mesh, QUADS, 4)]
    bricks = [np.asarray(cells)[:, :8] for kind, cells in mesh.cells if kind.startswith("hexahedron")]
    if bricks:
        faces = np.concatenate([cells[:, face] for cells in bricks for face in FACES])
        _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        parts.append(faces[first[count == 1]])
    return np.concatenate(parts)


def _find_links(mesh: FieldMesh) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return links along an axis, the other links, and the axes of chains, (m, 2) each."""
    pairs = _find_cells(mesh, ("line",), 2)
    chain = np.asarray(mesh.point_data.get("actuator", np.zeros(len(mesh.points))))[pairs].min(axis=1) > 0
    lengths = np.abs(np.diff(mesh.points[pairs], axis=1)[:, 0])
    aligned = (lengths > 1e-9 * np.ptp(mesh.points, axis=0).max()).sum(axis=1) == 1
    return pairs[aligned & ~chain], pairs[~aligned & ~chain], pairs[chain]


def _find_sides(mesh: FieldMesh) -> np.ndarray:
    """Return the sides of quadrilaterals to draw, (m, 2): all of a coarse mesh; of a finer regular mesh, the
    lines that divide it into LINES cells along each side."""
    quads = _find_cells(mesh, QUADS, 4)
    sides = np.unique(np.sort(np.concatenate([quads[:, [i, (i + 1) % 4]] for i in range(4)]), axis=1), axis=0)
    mask = np.zeros(len(sides), dtype=bool)
    for axis in (0, 1):
        lines = np.unique(np.round(mesh.points[quads][:, :, axis], 9))
        step = max(1, round((len(lines) - 1) / LINES)) if 1 < len(lines) <= 4 * PLAN_CELLS + 1 else 1
        ends = np.round(mesh.points[sides][:, :, axis], 9)
        mask |= (ends[:, 0] == ends[:, 1]) & np.isin(ends[:, 0], lines[::step])
    return sides[mask]


def _find_held(points: np.ndarray, scene: Scene) -> list[dict[str, Any]]:
    """Return points along every support, in order, on each layer of a lattice, else on the middle of the
    sheet."""
    size = max(scene.sheet.lengths)
    rows = []
    for support in scene.supports:
        if place(support) is not None:  # no line of points
            continue
        edge = EDGES[support.edge]
        across = np.abs(points[:, edge.normal_axis] - scene.sheet.edge_at(support.edge))
        indices = np.flatnonzero(across < 1e-6 * size)
        if not len(indices):
            continue
        levels = np.unique(np.round(points[indices, 2], 12))
        for level in levels if len(levels) == 2 else [levels[np.argmin(np.abs(levels))]]:
            row = indices[np.abs(points[indices, 2] - level) < 1e-9 * size]
            ordered = row[np.argsort(points[row, edge.along_axis])]
            if len(ordered) > 1:
                rows.append({"points": packed(ordered), "firm": holds_director(support)})
    return rows
