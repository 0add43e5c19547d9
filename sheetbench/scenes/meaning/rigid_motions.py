"""The rigid motions that a scene's supports and actuators leave free; a static answer requires none."""

from functools import lru_cache

import numpy as np

from sheetbench.errors import SceneError
from sheetbench.scenes.meaning.distances import require_frictionless, require_no_obstacles
from sheetbench.scenes.meaning.kinematics import UP, cross_matrix
from sheetbench.scenes.objects.actuators import Chain
from sheetbench.scenes.objects.cutouts import Cutout, common, region
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.sheet import EDGES, Sheet
from sheetbench.scenes.objects.supports import Held, Point, Support, held_axes, place, tilt_axes

ROUND_OFF = 1e-9


def free_rigid_motions(scene: SceneFields) -> list[str]:
    """Return the names of the independent rigid motions that supports and actuators leave free.

    If there are none, a static answer can exist. An actuator whose base is held, or that prescribes the
    edge's motion, leaves none. A support fixes rows of the rigid velocity t + θ × X at both ends of its edge
    and, if it holds the tilt, rows of θ × e_z; the null space of the stacked rows is free. A translation is
    named if it is free without a rotation; a rotation, with its translation, by the edge that rests.
    """
    if any(not isinstance(actuator, Chain) or actuator.base != "free" for actuator in scene.actuators):
        return []
    return list(_free_motions(scene.sheet, scene.supports, scene.cutouts))


@lru_cache(maxsize=64)
def _free_motions(
    sheet: Sheet, supports: tuple[Support, ...], cutouts: tuple[Cutout, ...]
) -> tuple[str, ...]:
    """Return the names of the rigid motions that supports leave free; cached, for every solve needs them."""
    centre = np.array([sheet.length_x / 2, sheet.length_y / 2, 0.0])
    scale = max(sheet.lengths)
    rows = [np.zeros((6, 6))]
    plan = region(sheet, cutouts) if any(place(support) is not None for support in supports) else None
    for support in supports:
        shape, axes = place(support), list(held_axes(support))
        if isinstance(support, Point):
            ends = np.array([support.at])
        elif plan is None or shape is None:
            ends = np.array(sheet.edge_ends(support.edge))
        else:
            import shapely

            ends = shapely.get_coordinates(common(plan, shape.area).convex_hull)
        arms = (np.column_stack([ends, np.zeros(len(ends))]) - centre) / scale
        moves = np.broadcast_to(np.eye(3), (len(arms), 3, 3))
        velocities = np.concatenate([moves, -cross_matrix(arms)], axis=2)
        rows.append(velocities[:, axes].reshape(-1, 6))
        rows.append(np.hstack([np.zeros((3, 3)), -cross_matrix(UP)])[list(tilt_axes(support))])
    _, singular, motions = np.linalg.svd(np.concatenate(rows), full_matrices=False)
    rank = int(np.sum(singular > ROUND_OFF))
    free = motions[rank:]
    fixed = np.eye(6) - free.T @ free  # projector onto motions that are not free
    sliding = np.linalg.norm(fixed[:, :3], axis=0) < ROUND_OFF
    in_words = [f"translation along {name}" for name, slides in zip("xyz", sliding, strict=True) if slides]
    for axis, name in enumerate("xyz"):
        moved = np.linalg.lstsq(fixed[:, :3], -fixed[:, 3 + axis], rcond=ROUND_OFF)[0]
        if np.linalg.norm(fixed[:, :3] @ moved + fixed[:, 3 + axis]) < ROUND_OFF:
            in_words.append(f"rotation about {_resting_edge(sheet, axis, scale * moved) or name}")
    return (*in_words, *["a screw"] * (len(free) - len(in_words)))


def _resting_edge(sheet: Sheet, axis: int, moved: np.ndarray) -> str:
    """Return the edge that rests in a unit rotation about an axis that moves the centre by `moved` [m]. "" if
    no edge rests, for instance if the centre does."""
    for name, edge in EDGES.items():
        arm = np.zeros(3)
        arm[edge.normal_axis] = (0.5 if edge.far_end else -0.5) * sheet.lengths[edge.normal_axis]
        if edge.along_axis == axis and np.allclose(moved, np.cross(arm, np.eye(3)[axis]), atol=ROUND_OFF):
            return f"edge {name}"
    return ""


def unstopped_motions(scene: SceneFields) -> list[str]:
    """Return the names of rigid motions that neither supports nor obstacles stop. Obstacles stop motions out
    of the plane."""
    free = free_rigid_motions(scene)
    if not (free and scene.obstacles):
        return free
    resting = (Held(edge="x0", components=("z",)), Held(edge="x1", components=("z",)))
    return list(_free_motions(scene.sheet, scene.supports + resting, scene.cutouts))


def require_static(scene: SceneFields, linear: str = "") -> None:
    """Raise SceneError if a static answer is impossible: a rigid motion is free, or obstacles have
    friction. Obstacles stop motions out of the plane. linear: the name of a linear model, which cannot
    have obstacles."""
    if linear:
        require_no_obstacles(scene, linear)
    require_frictionless(scene)
    if free := unstopped_motions(scene):
        raise SceneError(
            f"scene '{scene.name}': support: nothing stops {', '.join(free)}; a static answer needs supports "
            'that stop every rigid motion (for instance kind = "clamped" on one edge)'
        )
