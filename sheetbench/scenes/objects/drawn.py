"""A sheet's mesh, or its outline and holes, from a file: projection to a plane, scaling to metres, and shift.

[sheet] mesh = "cloth.obj", mesh_scale = "1 mm", mesh_shift = "corner"
[sheet] outline = "fin.dxf"
[sheet] outline = "disc"

A disc is a polygon of CORNERS sides in the rectangle of length_x and length_y, an ellipse if the two differ.
A flat mesh lies in a plane x = c, y = c or z = c, which is turned to z = 0: (y, z), (x, −z) or (x, y) become
(x, y), so that a mesh whose upward axis is y, as in Blender and SOFA, is seen from above. `mesh_scale` is the
length of the file's unit, 1 m unless given, for a drawing the unit in the file. `mesh_shift` is added to
places [m]; "corner" moves the corner of the bounding rectangle to x = 0, y = 0, the default for drawings,
"centre" moves the file's origin to the middle of the rectangle.

Files keep some six digits: a bounding rectangle of nearly `length_x` by `length_y` is scaled to exactly that.
"""

from collections.abc import Mapping
from math import isfinite
from pathlib import Path
from typing import Any

import numpy as np

from sheetbench.scenes.language.units import converted, numbers
from sheetbench.scenes.objects.plan_mesh import FORMATS, mesh_of, read_file

DISC, CORNERS = "disc", 256
DRAWINGS = {".dxf": "dxf", ".svg": "svg"}
FLAT = 1e-6  # of the size: how thick a flat mesh may be
SIX_DIGITS = 1e-5  # of the size: largest error of the sides of the bounding rectangle
PLANES = {0: (1, 2, 1.0), 1: (0, 2, -1.0), 2: (0, 1, 1.0)}  # by the normal: axes that become x, y; sign of y


def from_file(data: Mapping[str, Any]) -> dict[str, Any]:
    """Return the keys of a sheet with its file's mesh or outline in place of the file's name. The corners of
    a drawing's holes are under "holes". Raises ValueError if the file cannot be used."""
    key = next(key for key in ("mesh", "outline") if isinstance(data.get(key), str))
    rest = {name: value for name, value in data.items() if name not in (key, "mesh_scale", "mesh_shift")}
    sides = numbers(data, {"length_x": "m", "length_y": "m"})
    scale, shift = (converted(data.get(name), "m") for name in ("mesh_scale", "mesh_shift"))
    if not sides or not _is_valid(scale, shift):
        return {**data, key: None}  # the keys' own checks report their faults
    if key == "outline" and Path(data[key]).name == DISC:  # relative to the scene's folder
        turn = 2.0 * np.pi * np.arange(CORNERS) / CORNERS
        corners = 0.5 * np.array([*sides.values()]) * (1.0 + np.column_stack([np.cos(turn), np.sin(turn)]))
        label = "a disc" if len(set(sides.values())) == 1 else "an ellipse"
        return {**data, key: [tuple(at) for at in corners.tolist()], "drawn_from": label, "holes": []}
    try:
        path = Path(data[key])
        points, parts = read_file(path, FORMATS if key == "mesh" else DRAWINGS)
        unit = float(parts.pop("unit", np.ones(1))[0]) if scale is None else float(str(scale))
        used = np.concatenate([np.ravel(part) for part in parts.values()])
        plan, turned = _project_to_plane(points, used, key)
        shift = ("corner" if key == "outline" else (0.0, 0.0)) if shift is None else shift
        places, moved = _shift(unit * plan, shift, np.array([*sides.values()]))
        changes = [turned, f"1 unit of it is {1e3 * unit:.5g} mm" * (unit != 1.0), moved]
        note = ", ".join(filter(None, [path.name, *changes]))
        if key == "mesh":
            return {**rest, "mesh": mesh_of(places, parts), "drawn_from": note}
        rings = np.split(places, np.cumsum(parts["rings"])[:-1])
        outline, *holes = ([tuple(at) for at in ring.tolist()] for ring in rings)
        return {**rest, "outline": outline, "drawn_from": note, "holes": holes}
    except ValueError as error:
        raise ValueError(f"{key}: {data[key]}: {error}") from None


def _is_valid(scale: Any, shift: Any) -> bool:
    def number(value: Any) -> bool:
        return isinstance(value, float | int) and isfinite(value)

    pair = isinstance(shift, list | tuple) and len(shift) == 2 and all(map(number, shift))
    placed = shift in (None, "corner", "centre") if not isinstance(shift, list | tuple) else pair
    return placed and (scale is None or (number(scale) and scale > 0.0))


def _project_to_plane(points: np.ndarray, used: np.ndarray, key: str) -> tuple[np.ndarray, str]:
    """Return plan points (n, 2) of points (n, 2 or 3), and a clause on their turning, "" without one."""
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise ValueError("a point has two or three coordinates")
    if key == "outline" or points.shape[1] == 2 or used.dtype.kind not in "iu" or not len(used):
        return points[:, :2], ""
    corners = points[used[(used >= 0) & (used < len(points))]]
    extent = np.ptp(corners, axis=0)
    if not np.isfinite(extent).all():
        return points[:, :2], ""
    normal = int(np.argmin(extent))
    if extent[normal] > FLAT * extent.max():
        listed = ", ".join(f"{size:.4g}" for size in extent)
        raise ValueError(f"it is no flat sheet: its points reach over {listed} along x, y and z")
    first, second, sign = PLANES[normal]
    plane = "xyz"[first] + "xyz"[second]
    return points[:, [first, second]] * [1.0, sign], f"turned from its {plane} plane" * (normal != 2)


def _shift(plan: np.ndarray, shift: Any, sides: np.ndarray) -> tuple[np.ndarray, str]:
    """Return plan points [m] shifted, and scaled onto the rectangle if nearly on it, and a clause on that."""
    low = plan.min(axis=0, initial=np.inf)
    by = -low if shift == "corner" else 0.5 * sides if shift == "centre" else np.array(shift)
    plan = plan + by
    size, near = np.ptp(plan, axis=0), SIX_DIGITS * sides.max()
    low = plan.min(axis=0)
    if (np.abs(size - sides) < near).all() and (np.abs(low) < near).all() and (size > 0.0).all():
        plan = np.clip((plan - low) * (sides / size), 0.0, sides)
    moved = np.abs(by).max() > near
    return plan, f"moved by {1e3 * by[0]:.4g}, {1e3 * by[1]:.4g} mm" * bool(moved)
