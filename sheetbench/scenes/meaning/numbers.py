"""The numbers of a scene that its answers at rest depend on smoothly, by keys as in its file:
"material.young", "patch2.thickness", "load1.force"; the first of a list has the number 1. Not among them are
places in the plan, which the models' meshes go with, what acts over time only, and what follows from others.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.scenes.meaning.parameters import FIBRES, Path, put, replaced, value_at
from sheetbench.scenes.objects.fields import LISTS, AScene, SceneFields
from sheetbench.scenes.objects.material import CONSTANTS as OF_LAWS
from sheetbench.scenes.objects.patches import CONSTANTS as OF_PATCHES
from sheetbench.scenes.objects.quantities import Frozen

MATERIAL = ("young", "poisson", "density", *FIBRES, *OF_LAWS)
NATURAL = ("strain", "curvature", "pretension")
KEYS = {  # of every table; layers' thicknesses are shares of the sheet's
    "material": MATERIAL, "sheet": ("thickness",), "layers": MATERIAL, "patches": OF_PATCHES,
    "natural": NATURAL, "temperature": ("change", "gradient"), "gravity": ("acceleration",),
    "masses": ("mass",), "supports": ("tilt", "curvature"), "obstacles": ("position", "radius"),
    "loads": ("force", "force_per_length", "moment_per_length", "force_per_area", "value"),
    "actuators": ("curvature", "bending_stiffness", "line_density", "radius", "displacement", "rotation"),
    "motion": ("displacement",),
}  # fmt: skip
SAMPLES = ("displacement", "rotation")  # over time, of which statics take the last


def numbers(scene: SceneFields) -> dict[str, np.ndarray]:
    """Return the numbers by their keys: () of one, (k,) of a list."""
    return {key: np.array(value_at(scene, path), dtype=float) for key, path in paths(scene).items()}


def with_number(scene: AScene, key: str, value: np.ndarray) -> AScene:
    """Return the scene with another number near the one that it has. Raises BadInput where it has none of
    this key."""
    if (path := paths(scene).get(key)) is None:
        raise BadInput(f"'{key}': not a number of this scene; it has {', '.join(paths(scene))}")
    if key == "sheet.thickness":
        return put(scene, "thickness", float(value))
    new = replaced(getattr(scene, str(path[0])), path[1:], np.asarray(value).tolist())
    return scene.model_copy(update={str(path[0]): new})  # a small change needs no new look at the whole


def paths(scene: SceneFields) -> dict[str, Path]:
    """Return where the numbers are, by their keys."""
    found: dict[str, Path] = {}
    for name in KEYS:
        table = getattr(scene, name, None)
        if isinstance(table, tuple):
            for number, one in enumerate(table):
                found |= dict(_within(f"{LISTS[name]}{number + 1}", (name, number), one, KEYS[name]))
        elif table is not None:
            found |= dict(_within(name, (name,), table, KEYS[name]))
    return found


def _within(label: str, path: Path, one: Frozen, keys: tuple[str, ...]) -> Iterator[tuple[str, Path]]:
    """Yield keys and places of the numbers of a table, and of the tables in it."""
    derived = {"young"} if getattr(one, "law", None) and one.given(OF_LAWS) else set[str]()
    if getattr(one, "kind", "") == "orthotropic":
        derived = {"young", "poisson"}
    if getattr(one, "pretension", None):
        derived = {"strain"}
    for key in (key for key in keys if key in type(one).model_fields and key not in derived):
        value = getattr(one, key)
        if isinstance(value, float | tuple) and value != ():
            yield f"{label}.{key}", (*path, key, len(value) - 1) if key in SAMPLES else (*path, key)
    for key, inner in (("natural", NATURAL), ("motion", KEYS["motion"])):
        if isinstance(table := getattr(one, key, None), Frozen):
            yield from _within(f"{label}.{key}", (*path, key), table, inner)
