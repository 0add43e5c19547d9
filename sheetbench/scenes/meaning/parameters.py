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
from itertools import chain, product
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
PLACES = {  # by patterns of names, without edges' parameters; numbers count from 1
    "|".join((*MATERIAL, *FIBRES, *OF_LAWS)): r"material.\g<0>",
    "thickness": "sheet.thickness",
    "drag": "air.drag",
    r"(share|time)_(\d+)": r"material.relaxation.\2.\1",
    r"mass(\d+)": r"masses.\1.mass",
    rf"patch(\d+)\.({'|'.join(CONSTANTS)})": r"patches.\1.\2",
    rf"layer(\d+)\.({'|'.join((*MATERIAL[:3], *FIBRES))})": r"layers.\1.\2",
    r"obstacle(\d+)\.([xyz])": r"obstacles.\1.position.\2",
    r"obstacle(\d+)\.(radius|friction)": r"obstacles.\1.\2",
    r"natural\.e(xx|yy|xy)": r"natural.strain.\1",
    r"natural\.k(xx|yy|xy)": r"natural.curvature.\1",
    r"natural\.pretension\.([xy])": r"natural.pretension.\1",
    r"patch(\d+)\.natural\.e(xx|yy|xy)": r"patches.\1.natural.strain.\2",
    r"patch(\d+)\.natural\.k(xx|yy|xy)": r"patches.\1.natural.curvature.\2",
    r"temperature\.(change|gradient)": r"temperature.\1",
    r"gravity\.([xyz])": r"gravity.acceleration.\1",
    r"load(\d+)\.(force|force_per_length|force_per_area)\.([xyz])": r"loads.\1.\2.\3",
    r"load(\d+)\.at\.([xy])": r"loads.\1.at.\2",
    r"load(\d+)\.(value|moment_per_length)": r"loads.\1.\2",
    r"support(\d+)\.([xyz])": r"supports.\1.motion.displacement.last.\2",
    r"actuator(\d+)\.([xyz])": r"actuators.\1.displacement.last.\2",
    r"actuator(\d+)\.curvature(\d+)": r"actuators.\1.curvature.\2",
    r"actuator(\d+)\.bending_stiffness": r"actuators.\1.bending_stiffness",
}
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
    **dict.fromkeys(("acceleration", "force", "force_per_length", "force_per_area", "at"), (-inf, inf)),
    **dict.fromkeys(("value", "pretension", "moment_per_length", "displacement"), (-inf, inf)),
}
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
    lists = [getattr(scene, key) for key in LISTS]
    joints = [getattr(one, "segments", 0) for one in scene.actuators]
    most = max(*map(len, lists), len(scene.material.relaxation), *joints, 1)
    ends = [f"{key}_{edge}" for key in ("curvature", "tilt") for edge in EDGES]
    there = (_numbered(key, most) for key, place in PLACES.items() if getattr(scene, place.split(".")[0]))
    names = []
    for name in (*chain.from_iterable(there), *ends):
        with suppress(BadInput, TypeError):
            finite = isfinite(parameter(scene, name).value)  # a plane's radius is not
            if finite and not OVER_TIME.match(name):
                names.append(name)
    return names


@cache
def _numbered(pattern: str, most: int) -> tuple[str, ...]:
    """Return the names that a pattern of PLACES stands for, with numbers up to `most`."""
    numbers = [str(n + 1) for n in range(most)]
    parts = re.findall(r"\(\\d\+\)|\(.*?\)|\[.*?\]|[^(\[]+", pattern.replace(r"\.", "."))
    words = [part.removeprefix("(").removesuffix(")") for part in parts]
    choices = [numbers if w == r"\d+" else [*w[1:-1]] if w[0] == "[" else w.split("|") for w in words]
    return tuple(map("".join, product(*choices)))


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
    for pattern, place in PLACES.items():
        if at := re.fullmatch(pattern, name):
            parts = at.expand(place).split(".")
            return tuple(int(p) - 1 if p.isdecimal() else COMPONENTS.get(p, p) for p in parts)
    return None


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
