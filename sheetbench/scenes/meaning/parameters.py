"""The parameters of a scene by name: the place of each in the scene, its unit and its bounds.

young, poisson, density, damping_time, damping_rate   of the material
young_1, young_2, poisson_12, shear_12, angle, …      of a material with fibres; young scales all its moduli
loss_factor                                           of the material, with its frequency or its band
share_N, time_N                                       of the material's branch N of [[material.relaxation]]
thickness                                             of the sheet; its tapers and layers go with it
patchN.young, poisson, density, thickness, angle      of the scene's Nth [[patch]], where that has its own
curvature_EDGE                                        of the curved support, or of the chains, on an edge
tilt_EDGE                                             of the clamp on an edge
drag                                                  of the air
massN                                                 of the scene's Nth [[mass]]
obstacleN.x, y, z, radius, friction                   of the scene's Nth [[obstacle]]
natural.exx, …, natural.kxy                           of [natural]: strain (e), curvature (k)
patchN.natural.exx, …                                 of the scene's Nth [[patch]], where that has its own
gravity.x, y, z                                       acceleration
loadN.force.x, …, at.x, y, value, …                   of the scene's Nth [[load]], by its keys
supportN.x, y, z                                      of the last place of the scene's Nth [[support]]
actuatorN.x, y, z, curvatureJ, bending_stiffness      of the scene's Nth [[actuator]]; J: of its joints
"""

import re
from contextlib import suppress
from functools import cache
from itertools import product
from math import inf, isfinite, pi
from typing import Any, NamedTuple

from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes.language.refusals import in_keys
from sheetbench.scenes.objects.actuators import Chain
from sheetbench.scenes.objects.fields import LISTS, AScene, SceneFields
from sheetbench.scenes.objects.material import CONSTANTS as OF_LAWS
from sheetbench.scenes.objects.natural import LARGEST_STRAIN
from sheetbench.scenes.objects.patches import CONSTANTS
from sheetbench.scenes.objects.supports import EDGES, LARGEST_TILT, Clamped, Curved

MATERIAL = ("young", "poisson", "density", "damping_time", "damping_rate", "loss_factor")
FIBRES = ("young_1", "young_2", "poisson_12", "shear_12", "shear_13", "shear_23", "angle")
NAMES = [*MATERIAL, *FIBRES, "share_N", "time_N", "thickness", "patchN.KEY", "curvature_EDGE", "tilt_EDGE"]
NAMES += ["drag", "massN", "obstacleN.KEY", "natural.KEY", "patchN.natural.KEY", "gravity.z", "loadN.KEY"]
NAMES += ["supportN.z", "actuatorN.KEY"]
FORCES, SYMMETRIC = ("force", "force_per_length", "force_per_area"), ("xx", "yy", "xy")
# the place of a parameter in a scene by its name, without edges' parameters; N: a number, from 1
PLACES = {key: f"material.{key}" for key in (*MATERIAL, *FIBRES, *OF_LAWS)}
PLACES |= {"thickness": "sheet.thickness", "drag": "air.drag", "massN": "masses.N.mass"}
PLACES |= {f"{key}_N": f"material.relaxation.N.{key}" for key in ("share", "time")}
PLACES |= {"actuatorN.curvatureN": "actuators.N.curvature.N"}
for keys, places in (
    (CONSTANTS, {"patchN.": "patches.N."}),
    ((*MATERIAL[:3], *FIBRES), {"layerN.": "layers.N."}),
    (("radius", "friction"), {"obstacleN.": "obstacles.N."}),
    (SYMMETRIC, {"natural.e": "natural.strain.", "natural.k": "natural.curvature."}),
    (SYMMETRIC, {"patchN.natural.e": "patches.N.natural.strain."}),
    (SYMMETRIC, {"patchN.natural.k": "patches.N.natural.curvature."}),
    (("change", "gradient"), {"temperature.": "temperature."}),
    ("xyz", {"obstacleN.": "obstacles.N.position.", "gravity.": "gravity.acceleration."}),
    ("xyz", {f"loadN.{key}.": f"loads.N.{key}." for key in FORCES}),
    ("xy", {"natural.pretension.": "natural.pretension.", "loadN.at.": "loads.N.at."}),
    (("value", "moment_per_length"), {"loadN.": "loads.N."}),
    ("xyz", {"supportN.": "supports.N.motion.displacement.last."}),
    ("xyz", {"actuatorN.": "actuators.N.displacement.last."}),
    (("bending_stiffness",), {"actuatorN.": "actuators.N."}),
):
    PLACES |= {name + key: place + key for name, place in places.items() for key in keys}
COMPONENTS = {"x": 0, "y": 1, "z": 2, "xx": 0, "yy": 1, "xy": 2, "last": -1}
UNITS = {  # other keys have none
    **dict.fromkeys(("young", "young_1", "young_2", "shear_12", "shear_13", "shear_23"), "Pa"),
    **{"density": "kg/m³", "thickness": "m", "curvature": "1/m", "angle": "rad", "tilt": "rad"},
    **{"damping_time": "s", "damping_rate": "1/s", "time": "s", "mass": "kg"},
    **{"position": "m", "radius": "m"},
}
BOUNDS = {  # others are above 0
    "poisson": (-0.99, 0.4999),
    "angle": (-0.999 * pi, 0.999 * pi),
    "tilt": (-LARGEST_TILT, LARGEST_TILT),
    "curvature": (-inf, inf),
    "share": (0.0, 1.0),
    "position": (-inf, inf),
    **dict.fromkeys(("c2", "c3", "change", "gradient"), (-inf, inf)),
    "strain": (-LARGEST_STRAIN, LARGEST_STRAIN),
    **dict.fromkeys(("acceleration", "at", *FORCES), (-inf, inf)),
    **dict.fromkeys(("value", "pretension", "moment_per_length", "displacement"), (-inf, inf)),
}
NUMBER = re.compile(r"\d+")
OVER_TIME = re.compile(r"damping_|loss_factor|drag|share_|time_|obstacle\d+\.friction")
Path = tuple[str | int, ...]  # keys, and numbers in lists


class Parameter(NamedTuple):
    """A number of a scene: its name, unit and value (SI), and the bounds of possible values."""

    name: str
    unit: str
    value: float
    low: float
    high: float


def short_name(name: str) -> str:
    """Return a parameter's name without its table: "material.young" is young."""
    return name.removeprefix("material.").removeprefix("sheet.")


def parameter(scene: SceneFields, name: str) -> Parameter:
    """Return the parameter of this name. Raises BadInput if the scene has none."""
    path = _paths(scene, name)[0]
    key = [part for part in path if isinstance(part, str)][-1]
    low, high = BOUNDS.get(key, (0.0, inf))
    if key == "thickness":
        high = min(scene.sheet.lengths)
    if key == "poisson_12":
        high = 0.999 * ((scene.material.young_1 or 1.0) / (scene.material.young_2 or 1.0)) ** 0.5
        low = -high
    return Parameter(name, UNITS.get(key, ""), float(_value(scene, path) or 0.0), low, high)


def names_of(scene: SceneFields) -> list[str]:
    """Return the names of all parameters that the scene has and an answer at rest depends on."""
    lists = [scene.material.relaxation, *(getattr(scene, key) for key in LISTS)]
    joints = [getattr(one, "segments", 0) for one in scene.actuators]
    names, numbers = list[str](), range(1, 1 + max(*map(len, lists), *joints))
    there = (
        key.replace("N", "{}").format(*each)
        for key, place in PLACES.items()
        if getattr(scene, place.split(".")[0])
        for each in product(numbers, repeat=key.count("N"))
    )
    for name in (*there, *(f"{key}_{edge}" for key in ("curvature", "tilt") for edge in EDGES)):
        with suppress(BadInput, TypeError):
            finite = isfinite(parameter(scene, name).value)  # a plane's radius is not
            if finite and not OVER_TIME.match(name):
                names.append(name)
    return names


def put(scene: AScene, name: str, value: float, checked: bool = True) -> AScene:
    """Return the scene with a parameter at another value. checked: whether the objects of the scene are
    checked together, which a small change does not need. Raises BadInput if the scene has no parameter of
    this name, and SceneError if the value is impossible."""
    paths = _paths(scene, name)
    try:
        if name == "thickness":
            return _with(scene, _thickness(scene, value / scene.sheet.thickness), checked)
        for path in paths:
            part = str(path[0])
            scene = _with(scene, {part: _replaced(getattr(scene, part), path[1:], value)}, checked)
        return scene
    except SceneError as error:
        raise SceneError(f"{name} = {value:g}: {error}") from None


def _paths(scene: SceneFields, name: str) -> list[Path]:
    """Return the paths in a scene to a parameter's value. Raises BadInput if there are none."""
    paths = _places(scene, name)
    for path in paths:
        of: Any = scene
        for n, part in enumerate(path):
            if isinstance(part, int) and not -len(of) <= part < len(of):
                raise BadInput(f"'{name}': the scene has {len(of)} {path[n - 1]}")
            pulled = part == "strain" and of.pretension is not None
            of = of[part] if isinstance(part, int) else getattr(of, part, None)
            fibres = scene.material.kind == "orthotropic"  # its angle is 0 unless given
            derived = pulled or (name == "poisson" and fibres)
            if derived or (of is None and not (part == "angle" and fibres)):
                where = in_keys(path[: n + 1])
                raise BadInput(f"'{name}': the scene has no {where}; give a first guess there")
    return paths


@cache
def _place(name: str) -> Path | None:
    """Return the path of PLACES to a parameter of any scene, None if there is none."""
    names, numbers = (name, *(NUMBER.sub("N", name, most) for most in (1, 2))), iter(NUMBER.findall(name))
    if (place := next((PLACES[key] for key in names if key in PLACES), None)) is None:
        return None
    return tuple(int(next(numbers)) - 1 if p == "N" else COMPONENTS.get(p, p) for p in place.split("."))


def _places(scene: SceneFields, name: str) -> list[Path]:
    """Return the paths that a name may stand for. Raises BadInput if it stands for none."""
    if path := _place(name):
        return [path]
    key, _, edge = name.partition("_")
    holders = {"tilt": Clamped, "curvature": Curved | Chain}
    if key not in holders:
        raise BadInput(f"'{name}': not a parameter of a scene; choose from {', '.join(NAMES)}")
    paths: list[Path] = [
        (of, i, key)
        for of in ("supports", "actuators")
        for i, one in enumerate(getattr(scene, of))
        if isinstance(one, holders[key]) and one.edge == edge
    ]
    values = [_value(scene, path) for path in paths]
    if key == "tilt" and not paths:
        raise BadInput(f"'{name}': edge '{edge}' has no clamp")
    if key == "curvature" and not (
        paths and isinstance(values[0], int | float) and all(value == values[0] for value in values)
    ):
        raise BadInput(f"'{name}': edge '{edge}' has no support or actuator of one curvature")
    return paths


def _value(scene: SceneFields, path: Path) -> Any:
    of: Any = scene
    for part in path:
        of = of[part] if isinstance(part, int) else getattr(of, part)
    return of


def _replaced(of: Any, path: Path, value: Any) -> Any:
    """Return a scene object, or a list of some, with another value at a place within."""
    if not path:
        return value
    part, inner = path[0], path[1:]
    if isinstance(part, int):
        part %= len(of)  # -1 is the last
        return (*of[:part], _replaced(of[part], inner, value), *of[part + 1 :])
    return of.replace(**{part: _replaced(getattr(of, part), inner, value)})


def _with(scene: AScene, parts: dict[str, Any], checked: bool) -> AScene:
    return scene.replace(**parts) if checked else scene.model_copy(update=parts)


def _thickness(scene: SceneFields, factor: float) -> dict[str, Any]:
    """Return the scene's sheet and layers with thicknesses times a factor, tapers included."""
    sheet = scene.sheet
    given = sheet.given(("taper_x", "taper_y"))
    tapers = {key: tuple(factor * h for h in ends) for key, ends in given.items()}
    layers = tuple(layer.replace(thickness=factor * layer.thickness) for layer in scene.layers)
    return {"sheet": sheet.replace(thickness=factor * sheet.thickness, **tapers), "layers": layers}
