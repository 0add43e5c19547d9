"""The finite mesh of a scene's sheet that a code of triangles gets: squares cut by diagonals.

Clamps are a second fixed row beyond the edge: a hinge that lies on the edge then holds the slope there.
Masses are tributary, forces along edges too; point loads, payloads and probes are shared linearly by the
corners of a triangle.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import combinations
from typing import Any

import numpy as np

from comparisons.codes.cell import cut_squares
from comparisons.codes.coefficients import square_tetrahedra
from sheetbench.errors import BadInput
from sheetbench.scenes import EDGES, Clamped, EdgeLoad, Hinged, PointLoad, Scene, Sheet
from sheetbench.scenes.objects.fields import POINTS
from sheetbench.scenes.objects.grid import near_square
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.supports import Point, named, place

HELD = ("support.where", POINTS)  # what `refusal` looks at for itself
ON_A_LINE = 1e-6  # of a square
FINEST = 400  # squares along the shorter side of the meshes that a refusal looks for
ONE, ALTERNATE = "one-diagonal", "alternate-diagonals"


@dataclass(frozen=True)
class SheetMesh:
    """Triangle mesh of a sheet. vertices: (n, 3) [m]; triangles: (m, 3); held: mask of held vertices; masses:
    (n,) [kg]; forces: dead forces besides weight (n, 3) [N]; gravity: (3,) [m/s²]; probes: vertices around
    each probe and their weights; obstacles: plain data, at their last positions; offset: half the thickness
    [m], the sheet's distance from obstacles in contact."""

    vertices: np.ndarray
    triangles: np.ndarray
    held: np.ndarray
    masses: np.ndarray
    forces: np.ndarray
    gravity: np.ndarray
    probes: dict[str, tuple[list[int], list[float]]]
    obstacles: tuple[dict[str, Any], ...] = ()
    offset: float = 0.0

    @cached_property
    def hinges(self) -> np.ndarray:
        """Edges that two triangles share: both ends, then the corners opposite (k, 4)."""
        sides: dict[tuple[int, int], list[int]] = {}
        for corners in self.triangles.tolist():
            for a, b in combinations(sorted(corners), 2):
                sides.setdefault((a, b), []).append(sum(corners) - a - b)
        return np.array([(*edge, *across) for edge, across in sides.items() if len(across) == 2])

    @cached_property
    def edges(self) -> np.ndarray:
        """All sides of triangles (e, 2), each once."""
        pairs = [pair for t in self.triangles.tolist() for pair in combinations(sorted(t), 2)]
        return np.array(sorted(set(pairs)))

    def document(self) -> dict[str, Any]:
        """Return plain data for the scripts."""
        arrays = {name: value for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return {
            **{name: value.tolist() for name, value in arrays.items()},
            "hinges": self.hinges.tolist(),
            "edges": self.edges.tolist(),
            "probes": {n: {"vertices": v, "shares": s} for n, (v, s) in self.probes.items()},
            **{"obstacles": list(self.obstacles), "offset": self.offset},
        }


def sheet_mesh(scene: Scene, squares: int, pattern: str = ALTERNATE, beyond_share: float = 1.0) -> SheetMesh:
    """Return the mesh of a scene's sheet, `squares` along its shorter side.

    pattern: ONE or ALTERNATE; beyond_share: how far beyond an edge its second row is, over a square's side.
    Raises BadInput for features that codes of meshes lack: supports but points at vertices and clamped and
    hinged edges that stay, loads but weight and forces at points and along edges."""
    if reason := refusal(scene):
        raise BadInput(f"{scene.name}: {reason}")
    counts = near_square(scene.sheet, squares)
    spacing = np.array(scene.sheet.lengths) / counts
    clamped = {support.edge for support in scene.supports if isinstance(support, Clamped)}
    sides = zip("xy", counts, strict=True)
    lines = [np.arange(-(f"{axis}0" in clamped), n + 1 + (f"{axis}1" in clamped)) for axis, n in sides]
    i, j = np.meshgrid(*lines, indexing="ij")
    number = np.arange(i.size).reshape(i.shape)
    odd = ((i + j)[:-1, :-1] % 2 == 1) & (pattern == ALTERNATE)
    triangles = np.array(list(cut_squares(number, odd)))
    held, inside, share = np.zeros(i.shape, dtype=bool), np.ones(i.shape, dtype=bool), np.ones(i.shape)
    for edge, words in EDGES.items():
        position = (i, j)[words.normal_axis]
        distance = position - counts[words.normal_axis] if words.far_end else -position
        held |= (distance >= 0) & any(support.edge == edge for support in scene.supports)
        inside &= distance <= 0
        share[distance == 0] *= 0.5
    shapes = {name: shape for name, one in named(scene.supports).items() if (shape := place(one)) is not None}

    def fits(squares: int) -> bool:
        return all(_held_rows(shape, scene.sheet, squares) is not None for shape in shapes.values())

    for name, shape in shapes.items():
        if (rows := _held_rows(shape, scene.sheet, squares)) is None:
            finer = range(squares + 1, FINEST)
            other = next((f"--grid {n + 1}" for n in finer if fits(n)), "another --grid")
            of = f"{counts[0]} × {counts[1]} squares"
            raise BadInput(f"{name}: {shape.in_words()}: its sides are not on vertices of {of}; take {other}")
        (left, right), (lower, upper) = rows
        held |= (i >= left) & (i <= right) & (j >= lower) & (j <= upper)
    on_sheet = inside.ravel()[triangles].all(axis=1)
    plan = [
        (n.ravel() - (1.0 - beyond_share) * (n.ravel() - np.clip(n.ravel(), 0, count))) * side
        for n, count, side in zip((i, j), counts, spacing, strict=True)
    ]
    places = np.column_stack([*plan, np.zeros(i.size)])
    per_square = scene.material.density * scene.sheet.thickness * float(np.prod(spacing))
    forces = np.zeros_like(places)
    for load in scene.loads:
        if isinstance(load, PointLoad):
            corners, shares = _locate_point(places, triangles[on_sheet], np.array(load.at))
            forces[corners] += load.last_factor * np.outer(shares, load.force)
        elif isinstance(load, EdgeLoad):
            words = EDGES[load.edge]
            axis, end = words.normal_axis, counts[words.normal_axis] if words.far_end else 0
            lengths = spacing[1 - axis] * 2.0 * share * (inside & ((i, j)[axis] == end))
            forces += load.last_factor * np.outer(lengths.ravel(), load.force_per_length)
    payload_mass = np.zeros(len(places))
    for payload in scene.masses:
        assert payload.at is not None  # `refusal` has those of a part
        corners, shares = _locate_point(places, triangles[on_sheet], np.array(payload.at))
        payload_mass[corners] += payload.mass * np.array(shares)
    points = {
        name: _locate_point(places, triangles[on_sheet], np.array(at)) for name, at in scene.probes.items()
    }
    return SheetMesh(
        places,
        triangles,
        held.ravel(),
        np.where(inside, per_square * share, per_square).ravel() + payload_mass,
        forces,
        np.zeros(3) if scene.gravity is None else np.array(scene.gravity.last_acceleration),
        points,
        tuple(
            {
                **obstacle.model_dump(mode="json", include={"kind", "normal", "axis", "radius", "friction"}),
                "position": obstacle.place().tolist(),
            }
            for obstacle in scene.obstacles
        ),
        0.5 * scene.sheet.thickness,
    )


def _held_rows(shape: Shape, sheet: Sheet, squares: int) -> list[np.ndarray] | None:
    """Return the first and last rows of vertices, along x and along y, that a point or a rectangle holds, or
    None if its sides are not on rows of vertices."""
    assert shape.rectangle is not None  # `refusal` has other shapes
    sides, rows = (shape.rectangle.x, shape.rectangle.y), []
    for ends, length, count in zip(sides, sheet.lengths, near_square(sheet, squares), strict=True):
        at = np.clip(np.array(ends) * count / length, 0.0, count)
        if np.abs(at - np.rint(at)).max() > ON_A_LINE:
            return None
        rows.append(np.rint(at))
    return rows


def with_layers(scene: Scene, flat: SheetMesh, squares: int, height: float) -> tuple[SheetMesh, np.ndarray]:
    """Return two layers of a flat mesh's vertices at a distance of `height` [m], and the tetrahedra between
    (m, 4).

    Lower and upper vertices take turns; triangles are the layers' own, probes the mean of both."""
    counts = near_square(scene.sheet, squares)
    spacing = np.array(scene.sheet.lengths) / counts
    places = np.rint(flat.vertices[:, :2] / spacing).astype(int)
    number = {place: n for n, place in enumerate(map(tuple, places.tolist()))}
    cells = [
        [2 * number[i, j] + layer for i, j, layer in corners]
        for square in number
        if (square[0] + 1, square[1] + 1) in number
        for corners in square_tetrahedra(*square)
    ]
    lift = np.array([[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]]) * height
    probes = {
        name: ([2 * v + layer for v in corners for layer in (0, 1)], (0.5 * np.repeat(shares, 2)).tolist())
        for name, (corners, shares) in flat.probes.items()
    }
    return SheetMesh(
        (flat.vertices[:, None, :] + lift).reshape(-1, 3),
        np.concatenate([2 * flat.triangles, 2 * flat.triangles + 1]),
        np.repeat(flat.held, 2),
        np.repeat(flat.masses, 2) / 2.0,
        np.repeat(flat.forces, 2, axis=0) / 2.0,
        flat.gravity,
        probes,
    ), np.array(cells)


def refusal(scene: Scene) -> str:
    """Return the reason why codes of triangles do not support a scene, "" if they do."""
    if scene.actuators or any(not isinstance(s, Clamped | Hinged | Point) for s in scene.supports):
        return "these codes hold sheets by vertices, clamps and hinged edges only"
    if any(isinstance(s, Point) and len(s.components) < 3 for s in scene.supports):
        return "these codes hold a vertex along x, y and z, not along some of them"
    places = [place(s) for s in scene.supports if not isinstance(s, Clamped | Point)]
    rectangles = all(shape.rectangle for s in scene.supports if (shape := place(s)))
    if any(places) or not rectangles:
        return "support.where: these codes hold points and clamped rectangles on lines of their meshes"
    if any(isinstance(support, Hinged) and support.twist == "held" for support in scene.supports):
        return 'twist = "held": these codes have no such hinges'
    if any(s.motion is not None or (isinstance(s, Clamped) and s.tilt) for s in scene.supports):
        return "these codes have no tilted clamps and no moving supports"
    if shapes := ", ".join(word for word in scene.shaped_by.split(", ") if word not in HELD):
        return f"{shapes}: these codes have meshes of whole rectangles"
    if any(not isinstance(load, PointLoad | EdgeLoad) or load.follows for load in scene.loads):
        return "weight and forces at points and along edges only"
    return ""


def _locate_point(places: np.ndarray, triangles: np.ndarray, at: np.ndarray) -> tuple[list[int], list[float]]:
    """Return the triangle that contains a point, and the weights of its corners."""
    plan = places[triangles][:, :, :2]
    edges = (plan[:, 1:] - plan[:, :1]).transpose(0, 2, 1)
    coordinates = np.linalg.solve(edges, (at - plan[:, 0])[:, :, None])[:, :, 0]
    shares = np.column_stack([1.0 - coordinates.sum(axis=1), coordinates])
    nearest = int(np.argmax(shares.min(axis=1)))
    return triangles[nearest].tolist(), shares[nearest].tolist()
