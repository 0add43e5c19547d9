"""Half and quarter sheets: where sheet, supports and loads mirror themselves, one part answers for the whole.

The part is cut at x = length_x/2 or y = length_y/2 (the lower half is kept) and its cut edge is `symmetric`.
A lattice whose plane of symmetry holds a line of masses loses nothing by it: links and masses of a boundary
line have half their weight. Nor does a mesh with an even number of elements across.

The answer is the symmetric one. Of a sheet that buckles away from its symmetry it is an unstable equilibrium,
and the part cannot tell.
"""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import replace
from math import isclose
from typing import Any

import numpy as np

from sheetbench.answers.solution import FieldMesh, Solution
from sheetbench.scenes import EDGES, EdgeLoad, Load, PointLoad, Scene, Symmetric
from sheetbench.scenes.objects.sheet import EdgeName
from sheetbench.scenes.objects.supports import AnySupport

OTHER_END: dict[str, EdgeName] = {"x0": "x1", "x1": "x0", "y0": "y1", "y1": "y0"}
CUT: tuple[EdgeName, EdgeName] = ("x1", "y1")
VECTORS = ("displacement", "director", "reaction")  # fields whose component across the plane changes sign


def planes(scene: Scene) -> tuple[int, ...]:
    """Axes (0 = x, 1 = y) across which the scene is its own mirror image.

    A moment on an edge that crosses the plane counts as unsymmetric: a lattice measures such an edge's
    direction between neighbouring masses, of which the part has one only. A sheet that is no plain
    one, or carries a payload or touches an obstacle, is solved whole.
    """
    if scene.drawn_by or scene.actuators or scene.masses or scene.obstacles:
        return ()
    if any(isinstance(s, Symmetric) or s.motion for s in scene.supports):
        return ()
    return tuple(axis for axis in (0, 1) if _mirrors(scene, axis))


def cut_axes(scene: Scene, counts: Sequence[int], masses: bool) -> list[int]:
    """Axes across which a grid of (nx, ny) masses, or else elements, can be cut too: where a line of masses,
    or of nodes between elements, lies on the plane of symmetry."""
    if masses:
        return [axis for axis in planes(scene) if counts[axis] % 2 and counts[axis] > 3]
    return [axis for axis in planes(scene) if counts[axis] % 2 == 0]


def half(scene: Scene, axis: int) -> Scene:
    """Return the lower half of a scene across an axis, its cut edge on the plane of symmetry."""
    cut = CUT[axis]
    lengths = {f"length_{'xy'[axis]}": scene.sheet.lengths[axis] / 2.0}
    loads = [part for load in scene.loads if (part := _half_load(load, scene, axis)) is not None]
    supports = [support for support in scene.supports if support.edge != cut]
    sheet = scene.sheet.model_copy(update=lengths)  # not validated: half a sheet may be thicker than wide
    held = (*supports, Symmetric(edge=cut))
    return scene.replace(sheet=sheet, supports=held, loads=tuple(loads), probes={})


def whole(part: Solution, scene: Scene, axis: int) -> Solution:
    """Return the answer to a scene from that to its lower half across an axis."""
    middle = scene.sheet.lengths[axis] / 2.0
    flip = np.ones(3)
    flip[axis] = -1.0

    def sample(points: np.ndarray) -> np.ndarray:
        beyond = points[:, axis] > middle
        folded = points.copy()
        folded[beyond, axis] = 2.0 * middle - points[beyond, axis]
        displacement = part.sample(folded)
        return np.where(beyond[:, None], displacement * flip, displacement)

    reactions: dict[str, np.ndarray] = {}
    for support in scene.supports:
        if EDGES[support.edge].normal_axis != axis:
            reactions[support.edge] = part.reactions[support.edge] * (1.0 + flip)
        elif support.edge == CUT[axis]:
            reactions[support.edge] = part.reactions[OTHER_END[support.edge]] * flip
        else:
            reactions[support.edge] = part.reactions[support.edge]
    return replace(
        part,
        sample=sample,
        reactions=reactions,
        energies={name: 2.0 * energy for name, energy in part.energies.items()},
        mesh=_mirrored(part.mesh, axis, middle),
        balance=part.balance.mirrored(axis, middle) if part.balance is not None else None,
    )


def by_parts(scene: Scene, axes: Sequence[int], answer: Callable[[Scene], Solution]) -> Solution:
    """Return the answer for the whole scene from that for the part left after halving across `axes`."""
    if not axes:
        return answer(scene)
    scenes = [scene]
    for axis in axes:
        scenes.append(half(scenes[-1], axis))
    solution = answer(scenes[-1])
    for axis, of in zip(reversed(axes), reversed(scenes[:-1]), strict=True):
        solution = whole(solution, of, axis)
    cut = "half" if len(axes) == 1 else "quarter"
    settings: dict[str, Any] = {**solution.settings, "symmetry": ["xy"[axis] for axis in axes]}
    for name in {"grid", "elements"} & set(settings):
        size = list(settings[name])
        for axis in axes:
            size[axis] = 2 * size[axis] - (name == "grid")
        settings[name] = size
    return replace(solution, label=f"{solution.label}, a {cut} of the sheet", settings=settings)


def _mirrors(scene: Scene, axis: int) -> bool:
    """Return whether every support and load has its mirror image among them, itself perhaps."""
    across = scene.gravity.acceleration[axis] if scene.gravity is not None else 0.0
    edge_loads = [load for load in scene.loads if isinstance(load, EdgeLoad) and load.moment_per_length]
    turned = any(EDGES[load.edge].normal_axis != axis for load in edge_loads)
    parts = (*scene.supports, *scene.loads)
    images = (_image_of(part, scene, axis) for part in parts)
    return across == 0.0 and not turned and Counter(map(_key, parts)) == Counter(map(_key, images))


def _key(part: AnySupport | Load) -> str:
    """Return a support or a load as text, its numbers to twelve digits."""
    rounded = json.loads(part.model_dump_json(), parse_float=lambda text: f"{float(text) + 0.0:.11e}")
    return json.dumps(rounded, sort_keys=True)


def _image_of(part: Any, scene: Scene, axis: int) -> Any:
    """Return the mirror image of a support or a load."""
    flip = [-1.0 if i == axis else 1.0 for i in range(3)]
    if isinstance(part, PointLoad):
        at = list(part.at)
        at[axis] = scene.sheet.lengths[axis] - at[axis]
        return part.replace(at=(at[0], at[1]), force=_times(part.force, flip))
    if isinstance(part, EdgeLoad):
        part = part.replace(force_per_length=_times(part.force_per_length, flip))
    edge: Any = getattr(part, "edge", None)
    crosses = edge is None or EDGES[edge].normal_axis != axis
    return part if crosses else part.replace(edge=OTHER_END[edge])


def _half_load(load: Load, scene: Scene, axis: int) -> Load | None:
    """Return what of a load acts on the lower half: half of a point load on the plane, nothing beyond it."""
    if isinstance(load, EdgeLoad):
        return None if load.edge == CUT[axis] else load
    if not isinstance(load, PointLoad):
        return load
    middle = scene.sheet.lengths[axis] / 2.0
    if isclose(load.at[axis], middle, rel_tol=1e-12):
        on_plane = list(load.at)
        on_plane[axis] = middle
        force = _times(load.force, [0.5, 0.5, 0.5])
        return load.replace(at=(on_plane[0], on_plane[1]), force=force)
    return load if load.at[axis] < middle else None


def _times(vector: tuple[float, float, float], factors: list[float]) -> tuple[float, float, float]:
    x, y, z = (a * b for a, b in zip(vector, factors, strict=True))
    return x, y, z


def _mirrored(mesh: FieldMesh, axis: int, middle: float) -> FieldMesh:
    """Return the mesh and its mirror image beside it."""
    image = mesh.points.copy()
    image[:, axis] = 2.0 * middle - image[:, axis]
    flip = np.ones(3)
    flip[axis] = -1.0
    fields = {
        name: np.concatenate([values, values * flip if name in VECTORS else values])
        for name, values in mesh.point_data.items()
    }
    cells = [(kind, np.concatenate([nodes, nodes + len(image)])) for kind, nodes in mesh.cells]
    cell_data = {
        name: [np.concatenate([block, block]) for block in blocks] for name, blocks in mesh.cell_data.items()
    }
    return FieldMesh(np.concatenate([mesh.points, image]), cells, fields, cell_data)
