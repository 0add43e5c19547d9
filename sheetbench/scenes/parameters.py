"""The parameters of a scene by name: where each sits, its unit and what it may be.

young, poisson, density, damping_time, damping_rate   of the material
young_1, young_2, poisson_12, shear_12, angle, …      of a material with fibres; young scales all its moduli
loss_factor                                           of the material, with its frequency or its band
share_N, time_N                                       of the material's branch N of [[material.relaxation]]
thickness                                             of the sheet; its tapers and layers go with it
patchN.young, poisson, density, thickness, angle      of the scene's Nth [[patch]], where that has its own
curvature_EDGE                                        of the curved support, or of the chains, on an edge
tilt_EDGE                                             of the clamp on an edge
drag                                                  of the air
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import inf, pi
from typing import Any

from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes.actuators import Chain
from sheetbench.scenes.material import Material
from sheetbench.scenes.scene import Scene
from sheetbench.scenes.supports import LARGEST_TILT, Clamped, Curved

MATERIAL = {"young": "Pa", "poisson": "", "density": "kg/m³", "damping_time": "s", "damping_rate": "1/s"}
MATERIAL |= {"loss_factor": ""}
FIBRES = {"young_1": "Pa", "young_2": "Pa", "poisson_12": "", "shear_12": "Pa", "shear_13": "Pa"}
FIBRES |= {"shear_23": "Pa", "angle": "rad"}
BRANCH = {"share": ("", 1.0), "time": ("s", inf)}  # unit and upper bound
TAPERS = ("taper_x", "taper_y")
PATCH = {"young": "Pa", "poisson": "", "density": "kg/m³", "thickness": "m", "angle": "rad"}
NAMES = (*MATERIAL, *FIBRES, "share_N", "time_N", "thickness", "patchN.KEY", "curvature_EDGE", "tilt_EDGE")
NAMES += ("drag",)
BOUNDS = {"poisson": (-0.99, 0.4999), "angle": (-0.999 * pi, 0.999 * pi)}  # others: above 0


@dataclass(frozen=True)
class Parameter:
    """A number of a scene: its name, unit and value (SI), and the bounds within which it makes sense."""

    name: str
    unit: str
    value: float
    low: float
    high: float


def parameter(scene: Scene, name: str) -> Parameter:
    """The parameter of this name. Raises BadInput where the scene has none."""
    if name in FIBRES or (name == "poisson" and scene.material.kind == "orthotropic"):
        return _of_fibres(scene.material, name)
    if name in MATERIAL:
        if getattr(scene.material, name) is None:
            raise BadInput(
                f"'{name}': the scene's material has none; give a first guess, with frequency or band"
            )
        return Parameter(name, MATERIAL[name], getattr(scene.material, name), *BOUNDS.get(name, (0.0, inf)))
    if name == "thickness":
        return Parameter(name, "m", scene.sheet.thickness, 0.0, min(scene.sheet.lengths))
    if name == "drag":
        if scene.air is None:
            raise BadInput("'drag': the scene has no [air]; give a first guess there")
        return Parameter(name, "", scene.air.drag, 0.0, inf)
    if (patch := _patch_of(name)) is not None:
        return _of_patch(scene, name, *patch)
    kind, _, edge = name.partition("_")
    if kind in BRANCH and edge.isdecimal():
        if not 1 <= int(edge) <= len(scene.material.relaxation):
            raise BadInput(f"'{name}': the material has {len(scene.material.relaxation)} branches")
        value = getattr(scene.material.relaxation[int(edge) - 1], kind)
        return Parameter(name, BRANCH[kind][0], value, 0.0, BRANCH[kind][1])
    if kind == "curvature":
        return Parameter(name, "1/m", _curvature(scene, edge), -inf, inf)
    if kind == "tilt":
        for clamp in scene.supports:
            if isinstance(clamp, Clamped) and clamp.edge == edge:
                return Parameter(name, "rad", clamp.tilt, -LARGEST_TILT, LARGEST_TILT)
        raise BadInput(f"'{name}': edge '{edge}' has no clamp")
    raise BadInput(f"'{name}': not a parameter of a scene; choose from {', '.join(NAMES)}")


def _of_fibres(material: Material, name: str) -> Parameter:
    value = getattr(material, name) if name in FIBRES else None
    if name == "angle" and material.kind == "orthotropic":
        value = value or 0.0
    if value is None:
        given = [key for key in FIBRES if getattr(material, key) is not None]
        raise BadInput(
            f"'{name}': the scene's material has none; of fibres it has {', '.join(given) or 'none'}"
        )
    bounds = BOUNDS.get(name, (0.0, inf))
    if name == "poisson_12":
        most = 0.999 * ((material.young_1 or 1.0) / (material.young_2 or 1.0)) ** 0.5
        bounds = -most, most
    return Parameter(name, FIBRES[name], value, *bounds)


def _patch_of(name: str) -> tuple[int, str] | None:
    """The number of the patch and the key that a name like patch1.young has, None of another name."""
    patch, _, key = name.partition(".")
    number = patch.removeprefix("patch")
    return (int(number), key) if patch != number and number.isdecimal() and key in PATCH else None


def _of_patch(scene: Scene, name: str, number: int, key: str) -> Parameter:
    if not 1 <= number <= len(scene.patches):
        raise BadInput(f"'{name}': the scene has {len(scene.patches)} patches")
    value = scene.patches[number - 1].own.get(key)
    if value is None:
        raise BadInput(f"'{name}': patch {number} has no {key} of its own; give a first guess there")
    most = min(scene.sheet.lengths) if key == "thickness" else inf
    return Parameter(name, PATCH[key], value, *BOUNDS.get(key, (0.0, most)))


def put(scene: Scene, name: str, value: float) -> Scene:
    """The scene with a parameter at another value. Raises BadInput where it has none of this name, and
    SceneError where the value cannot be."""
    parameter(scene, name)
    try:
        return _with(scene, name, value)
    except SceneError as error:
        raise SceneError(f"{name} = {value:g}: {error}") from None


def _with(scene: Scene, name: str, value: float) -> Scene:
    if name in MATERIAL or name in FIBRES:
        return scene.replace(material=scene.material.replace(**{name: value}))
    if name == "drag" and scene.air is not None:
        return scene.replace(air=scene.air.replace(drag=value))
    if name == "thickness":
        return _as_thick(scene, value / scene.sheet.thickness)
    if (patch := _patch_of(name)) is not None:
        patches = list(scene.patches)
        patches[patch[0] - 1] = patches[patch[0] - 1].replace(**{patch[1]: value})
        return scene.replace(patches=tuple(patches))
    kind, _, edge = name.partition("_")
    if kind in BRANCH:
        branches = list(scene.material.relaxation)
        branches[int(edge) - 1] = branches[int(edge) - 1].replace(**{kind: value})
        return scene.replace(relaxation=tuple(branches))
    if kind == "tilt":
        return scene.replace(supports=_changed(scene.supports, _is(Clamped, edge), tilt=value))
    bent = _is(Curved | Chain, edge)
    return scene.replace(
        supports=_changed(scene.supports, bent, curvature=value),
        actuators=_changed(scene.actuators, bent, curvature=value),
    )


def _as_thick(scene: Scene, factor: float) -> Scene:
    """The scene with its sheet so many times as thick, tapers and layers too."""
    sheet = scene.sheet
    tapers = {name: tuple(factor * h for h in ends) for name in TAPERS if (ends := getattr(sheet, name))}
    layers = tuple(layer.replace(thickness=factor * layer.thickness) for layer in scene.layers)
    return scene.replace(sheet=sheet.replace(thickness=factor * sheet.thickness, **tapers), layers=layers)


def _curvature(scene: Scene, edge: str) -> float:
    bent = [
        h for h in (*scene.supports, *scene.actuators) if isinstance(h, Curved | Chain) and h.edge == edge
    ]
    values = {holder.curvature for holder in bent}
    if len(values) == 1 and isinstance(value := values.pop(), int | float):
        return float(value)
    raise BadInput(f"'curvature_{edge}': edge '{edge}' has no support or actuator of one curvature")


def _is(kind: Any, edge: str) -> Callable[[Any], bool]:
    return lambda holder: isinstance(holder, kind) and holder.edge == edge


def _changed(holders: tuple[Any, ...], which: Callable[[Any], bool], **values: float) -> tuple[Any, ...]:
    return tuple(holder.replace(**values) if which(holder) else holder for holder in holders)
