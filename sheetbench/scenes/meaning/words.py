"""A scene in words, for its author to check: the place, size and direction of every part."""

from collections.abc import Iterator, Mapping, Sequence
from math import degrees, hypot
from typing import Any

import numpy as np

from sheetbench.scenes.meaning.composition import mass_of, payload_mass
from sheetbench.scenes.meaning.distances import nearest
from sheetbench.scenes.meaning.natural_state import TENSOR, Source, expansion_of, plies_of, sources_of
from sheetbench.scenes.meaning.region import area_in, resultant
from sheetbench.scenes.meaning.rigid_motions import free_rigid_motions, unstopped_motions
from sheetbench.scenes.objects.actuators import Actuator, Chain, CurvatureTable
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.layers import plane_stress
from sheetbench.scenes.objects.loads import AnyLoad, AreaLoad, PointLoad, Pressure
from sheetbench.scenes.objects.masses import Mass
from sheetbench.scenes.objects.material import CONSTANTS, STRESSES, Material
from sheetbench.scenes.objects.natural import Temperature
from sheetbench.scenes.objects.obstacles import AnyObstacle, Plane
from sheetbench.scenes.objects.orthotropy import MODULI
from sheetbench.scenes.objects.quantities import PlanPoint
from sheetbench.scenes.objects.shapes import Shape
from sheetbench.scenes.objects.sheet import EDGES, Sheet
from sheetbench.scenes.objects.supports import AnySupport, Clamped, Curved, Held, Hinged, Point, named, place
from sheetbench.scenes.objects.tables import FactorTable


def in_words(scene: SceneFields) -> Iterator[tuple[str, str]]:
    """Yield the name of each part of a scene and a sentence on it."""
    sheet, material, mass = scene.sheet, scene.material, mass_of(scene)
    sides = f"{_mm(sheet.length_x)} × {_mm(sheet.length_y)} mm{_outline(scene)}"
    thick = (
        f"{_mm(sheet.thickness)} mm thick (1/{min(sheet.lengths) / sheet.thickness:.3g} of the shorter side)"
    )
    tapered = sheet.given(("taper_x", "taper_y")).items()
    tapers = "".join(f", from {_mm(low)} to {_mm(high)} mm along {key[-1]}" for key, (low, high) in tapered)
    yield "sheet", f"{sides}, {thick}{tapers}, {1e3 * mass:.3g} g"
    rubber = f" at small strains, rubber by the law {material.law}" if material.law else ""
    rubber += f" ({constants})" if (constants := _constants(material.given(CONSTANTS))) else ""
    dampers = f", dampers of {1e3 * time:.4g} ms · k" if (time := material.dashpot_time) else ""
    drag = f", drag of {material.damping_rate:g} 1/s · mass" if material.damping_rate else ""
    elasticity = f"{_elasticity(material)}, {_constants({'density': material.density})}"
    yield "material", f"{elasticity}{rubber}{_relaxation(material)}{dampers}{drag}"
    for n, layer in enumerate(scene.layers, start=1):
        yield f"layer {n}", _constants({"thickness": layer.thickness, **layer.own})
    for n, patch in enumerate(scene.patches, start=1):
        yield f"patch {n}", f"{patch.shape.in_words()}: {_constants(patch.own) or 'not flat at rest'}"
    for n, cutout in enumerate(scene.cutouts, start=1):
        yield f"cutout {n}", cutout.shape.in_words()
    for n, payload in enumerate(scene.masses, start=1):
        yield f"mass {n}", _payload(payload, sheet)
    for name, natural in natural_in_words(scene):
        yield f"{name}, natural" if name.startswith("patch") else name, natural
    yield "weight", _weight(scene, mass + payload_mass(scene))
    if scene.air is not None:
        share = 100.0 * scene.air.carried_along(sheet) * sheet.length_x * sheet.length_y / mass
        drag = f"drag of {scene.air.coefficient:.3g} kg/m³ · v² per area, v along the normal; none at rest"
        carried_along = f"mass of air that moves along, up to {share:.2g} % of the sheet's, is left out"
        yield "air", f"{drag}. The {carried_along}"
    for name, support in named(scene.supports).items():
        yield f"edge {name}" if place(support) is None else name, _support(support, sheet)
    for n, load in enumerate(scene.loads, start=1):
        yield f"load {n}", f"{_load(load, scene)}{_over_time(load.history)}"
    for name, one in scene.named_obstacles().items():
        yield name, _obstacle(one, nearest(scene, one)[0])
    for n, actuator in enumerate(scene.actuators, start=1):
        yield f"actuator {n}", _actuator(actuator, sheet)
    if scene.initial is not None:
        released = ", ".join(str(n) for n, load in enumerate(scene.loads, start=1) if load.hold)
        then = f"; load {released} is let go then" if released else ""
        yield "start", f"motion starts from the equilibrium under all loads at t = 0{then}"
    if scene.springs is not None:
        yield "springs", "the lattice takes the scene's own constants instead of calibrated ones"
    yield "probes", f"{', '.join(f'{name} {_point(point)}' for name, point in scene.probes.items())} mm"
    yield "at rest", _at_rest(scene)


def _at_rest(scene: SceneFields) -> str:
    """Return a clause on how the sheet is held, or on the reason why it has no answer at rest."""
    if free := ", ".join(unstopped_motions(scene)):
        return f"not solved: nothing stops {free}"
    if any(obstacle.friction for obstacle in scene.obstacles):
        return "not solved: friction is in motion only"
    if free := ", ".join(free_rigid_motions(scene)):
        return f"held in its plane; obstacles alone can stop {free}"
    return "held: no rigid-body motion is free"


def _obstacle(obstacle: AnyObstacle, gap: float) -> str:
    """Return an obstacle's kind, place and distance from the flat sheet, in words."""
    plane, along = isinstance(obstacle, Plane), getattr(obstacle, "normal", getattr(obstacle, "axis", ()))
    wide = f" of {' × '.join(map(_mm, sides))} mm" if (sides := getattr(obstacle, "size", ())) else ""
    round_ = wide + ("" if plane else f"{', edges' if sides else ''} of radius {_mm(obstacle.radius)} mm")
    turned = f" {'facing' if plane else 'along'} ({', '.join(f'{part:.3g}' for part in along)})" * bool(along)
    more = ", moving" if obstacle.motion is not None else ""
    more += f", friction {obstacle.friction:g} in motion" if obstacle.friction else ""
    at = ", ".join(map(_mm, obstacle.position)).replace("-", "−")
    near = 1e3 * gap if abs(gap) > ROUNDING else 0.0
    return f"{obstacle.kind}{round_} at ({at}) mm{turned}{more}; {near:.4g} mm from the flat sheet"


def _outline(scene: SceneFields) -> str:
    """Return a clause on outline and area, "" if the sheet is a whole rectangle."""
    if not scene.pierced:
        return ""
    outline = scene.sheet.outline
    corners = "" if outline is None else f", a polygon of {len(outline)} corners in it"
    if scene.sheet.mesh is not None:
        corners = f", a mesh of {len(scene.sheet.mesh.quads)} quadrilaterals in it"
    corners += f" ({scene.sheet.drawn_from})" if scene.sheet.drawn_from else ""
    return f"{corners}, {1e4 * area_in(scene, None):.4g} cm² in all"


ROUNDING = 1e-12  # of the largest natural strain, and of a gap [m]
IN_PASCALS = {"young", *MODULI, *STRESSES}
SYMBOLS = {
    "young": "E", "young_1": "E₁", "young_2": "E₂", "shear_12": "G₁₂", "poisson": "ν", "poisson_12": "ν₁₂",
    "density": "ρ",
}  # fmt: skip


def _constants(constants: Mapping[str, Any]) -> str:
    """Return constants, by their keys, in words with commas between."""
    return ", ".join(_constant(key, value) for key, value in constants.items())


def _constant(key: str, value: Any) -> str:
    if key == "thickness":
        return f"{_mm(value)} mm thick"
    if key == "angle":
        return f"fibres at {degrees(value):.4g}°"
    shown = str([*value]) if isinstance(value, tuple) else f"{value:g}{' kg/m³' * (key == 'density')}"
    return f"{SYMBOLS.get(key, key)} = {_pascals(value) if key in IN_PASCALS else shown}"


def _elasticity(material: Material) -> str:
    """Return E and ν, or the constants of fibres."""
    if material.kind == "isotropic":
        return _constants(material.given(("young", "poisson")))
    constants = _constants(material.given(("young_1", "young_2", "shear_12", "poisson_12")))
    return f"fibres at {degrees(material.ply.angle):.4g}° from x, {constants}"


def _relaxation(material: Material) -> str:
    if not (branches := material.branches).times:
        return ""
    parts = zip(branches.shares, branches.times, strict=True)
    listed = ", ".join(f"{share:.3g} in {1e3 * time:.3g} ms" for share, time in parts)
    at_once = material.young * (1.0 + sum(branches.stiffness))
    return f" at rest, {_pascals(float(f'{at_once:.4g}'))} at once, of which relax {listed}"


def sheet_in_words(sheet: Sheet, material: Material) -> str:
    """Return the sheet and its material in a line."""
    sides = " × ".join(f"{1e3 * length:g}" for length in (*sheet.lengths, sheet.thickness))
    at_rest = " at rest" if material.branches.times else ""
    return f"{sides} mm, {_elasticity(material)}{at_rest}, {_constants({'density': material.density})}"


def natural_in_words(scene: SceneFields) -> Iterator[tuple[str, str]]:
    """Yield the name of each natural state or temperature and a sentence on it."""
    for source in sources_of(scene):
        both = source.strain, source.curvature
        strain, curvature = (np.where(np.abs(p) > ROUNDING * np.abs(p).max(), p, 0.0) for p in both)
        parts, pretension = list[str](), getattr(source.of, "pretension", None)
        if pretension:  # its strain depends on the model
            x, y = (source.of.last_factor * pull for pull in pretension)
            parts, strain = [f"a tension of {x:.4g} N/m along x and {y:.4g} N/m along y"], np.zeros(3)
        for e, k, axis in zip(strain, curvature, "xy", strict=False):
            way, towards = "longer" if e > 0.0 else "shorter", "+z" if k > 0.0 else "−z"
            parts += [f"{100.0 * abs(e):.3g} % {way} along {axis}"] if e else []
            parts += [f"an arc of radius {1e3 / abs(k):.4g} mm along {axis}, towards {towards}"] if k else []
        parts += [f"sheared by {strain[2]:.3g}"] if strain[2] else []
        parts += [f"twisted by {curvature[2]:.3g} 1/m"] if curvature[2] else []
        low, high = (_pascals(float(f"{stress:.3g}")) for stress in _stresses(scene, source))
        parts += [f"held flat, stresses from {low} to {high}"]
        whole = ", ".join(parts) if len(parts) > 1 else "flat and free of stress"
        yield source.name, whole + _over_time(source.of.history)


def _stresses(scene: SceneFields, source: Source) -> tuple[float, float]:
    """Return the least and the largest normal stress [Pa] along x and y in the faces of the layers of the
    flat sheet, at the largest factor of a history."""
    history, sums = source.of.history, []
    factor = max(history.factor, key=abs) if history else 1.0
    for number, ply in enumerate(plies_of(scene)):
        for z in scene.sheet.thickness * np.array([ply.low, ply.high]):
            own = (source.strain - z * source.curvature) / TENSOR
            if isinstance(source.of, Temperature):
                own = expansion_of(scene, number) * (source.of.change + z * source.of.gradient)
            sums.append(-factor * (plane_stress(ply) @ own)[:2])
    return float(np.min(sums)) + 0.0, float(np.max(sums)) + 0.0


def _payload(payload: Mass, sheet: Sheet) -> str:
    if payload.at is not None:
        return f"{1e3 * payload.mass:.3g} g at {_point(payload.at)} mm{_on_edges(payload.at, sheet)}"
    x, y, z = (1e7 * moment for moment in payload.inertia or (0.0, 0.0, 0.0))
    turning = f", moments of inertia {x:.3g} and {y:.3g} g·cm² about x and y" if x or y else ""
    turning += "; the one about z, the sheet's normal, is ignored" if z else ""
    return f"{1e3 * payload.mass:.3g} g, spread evenly{_in(payload.where)}{turning}"


def _weight(scene: SceneFields, mass: float) -> str:
    whole = f", of {1e3 * mass:.3g} g in all" if scene.masses else ""
    if (gravity := scene.gravity) is None:
        return f"none: weightless{whole}"
    force = _vector([mass * part for part in gravity.acceleration], "N")
    return f"{force}{whole}{_over_time(gravity.history)}"


def _support(support: AnySupport, sheet: Sheet) -> str:
    """Return a support's kind, motion and place, in words."""
    moved, inside = "", ""
    if support.motion is not None:
        far = max(support.motion.displacement, key=lambda moved: sum(part * part for part in moved))
        course = {"smooth": "smoothly", "linear": "linearly between samples"}[support.motion.interpolation]
        by = _vector([1e3 * part for part in far], "mm")
        moved = f", moved {course} over {support.motion.time[-1]:g} s, farthest by {by}"
    if isinstance(support, Point):
        inside = f" at {_point(support.at)} mm"
    elif (shape := place(support)) is not None:
        inside = f", everywhere in the {shape.in_words()}"
    match support:
        case Clamped(tilt=0.0):
            held = "clamped: the mid-surface and its normal held"
        case Clamped(tilt=tilt):
            turned, way = f"{abs(tilt):g} rad ({degrees(abs(tilt)):.3g}°)", "down" if tilt > 0.0 else "up"
            held = f"clamped, turned by {turned}: the sheet starts off {way}wards"
        case Hinged(twist="held"):
            held = "hinged: the mid-surface held, free to turn about the edge alone (hard simple support)"
        case Hinged():
            held = "hinged: the mid-surface held, free to turn (soft simple support)"
        case Held() | Point():
            free = [axis for axis in "xyz" if axis not in support.components]
            slides = f", free to move along {' and '.join(free)}" if free else ""
            held = f"held along {' and '.join(support.components)}{slides}, free to turn"
        case Curved():
            held = f"clamped to a rigid rod, {_bent(support.curvature, sheet, support.edge)}"
        case _:
            held = "a plane of symmetry: the sheet goes on beyond it as its mirror image"
    return f"{held}{moved}{inside}"


def _bent(curvature: float, sheet: Sheet, edge: str) -> str:
    if curvature == 0.0:
        return "straight"
    turned = degrees(abs(curvature) * sheet.lengths[EDGES[edge].along_axis])
    way = "up" if curvature > 0.0 else "down"
    return f"bent to a radius of {_mm(1.0 / abs(curvature))} mm, {turned:.3g}° in all, its ends {way}"


def _load(load: AnyLoad, scene: SceneFields) -> str:
    """Return a load without its history, in words."""
    where, whole = _in(load.where) if not isinstance(load, PointLoad) else "", hypot(*resultant(scene, load))
    match load:
        case PointLoad(at=at):
            return f"{_vector(load.force, 'N')} at {_point(at)} mm{_on_edges(at, scene.sheet)}"
        case Pressure(value=value):
            way = "along the normal, at first +z" if value > 0.0 else "against the normal, at first −z"
            return f"pressure of {abs(value):g} Pa {way}{where}; {whole:.3g} N on the flat sheet"
        case AreaLoad():
            return f"{_vector(load.force_per_area, 'N/m²')}, {whole:.3g} N in all{where}"
    parts = []
    if any(load.force_per_length):
        parts.append(f"{_vector(load.force_per_length, 'N/m')} ({whole:.3g} N in all)")
    if load.moment_per_length:
        way = "up" if load.moment_per_length > 0.0 else "down"
        parts.append(f"a moment of {abs(load.moment_per_length):g} N·m/m that turns what is outside it {way}")
    return f"on edge {load.edge}{where}: {' and '.join(parts) or 'nothing'}"


def _in(where: Shape | None) -> str:
    return "" if where is None else f", in the {where.in_words()}"


def _actuator(actuator: Actuator, sheet: Sheet) -> str:
    if not isinstance(actuator, Chain):
        return f"edge {actuator.edge} moved rigidly as prescribed, over {actuator.time[-1]:g} s"
    length = sheet.lengths[EDGES[actuator.edge].along_axis]
    curvature = actuator.curvature
    if isinstance(curvature, CurvatureTable):
        bent = f"its curvature from {_course(curvature.value)} 1/m in {curvature.time[-1]:g} s"
    elif isinstance(curvature, tuple):
        bent = f"its joints' curvatures from {min(curvature):g} to {max(curvature):g} 1/m"
    else:
        bent = _bent(curvature, sheet, actuator.edge)
    where = "in the mid-surface" if actuator.face == "mid" else f"on the {actuator.face} face"
    held = "" if actuator.base == "free" else f", held at its {actuator.base}"
    return (
        f"on edge {actuator.edge} a chain of {actuator.segments} segments of "
        f"{_mm(length / actuator.segments)} mm {where}, {1e3 * actuator.line_density * length:.3g} g, "
        f"EI = {actuator.bending_stiffness:g} N·m², {bent}{held}"
    )


def _vector(vector: Sequence[float], unit: str) -> str:
    """Return a vector in words, by its axis if it lies along one."""
    along = [(axis, value) for axis, value in zip("xyz", vector, strict=True) if value != 0.0]
    if not along:
        return f"0 {unit}"
    if len(along) == 1:
        axis, value = along[0]
        return f"{abs(value):.3g} {unit} along {'+' if value > 0.0 else '−'}{axis}"
    return f"({', '.join(f'{value:.3g}' for value in vector)}) {unit}".replace("-", "−")


def _on_edges(point: PlanPoint, sheet: Sheet) -> str:
    at = [name for name, edge in EDGES.items() if point[edge.normal_axis] == sheet.edge_at(name)]
    return f", the corner of {' and '.join(at)}" if len(at) == 2 else f", on edge {at[0]}" if at else ""


def _over_time(history: FactorTable | None) -> str:
    if history is None:
        return ""
    return f", times {_course(history.factor)} over {history.time[-1]:g} s"


def _course(values: Sequence[float]) -> str:
    """Return the first and the last value in words, and between them extremes that exceed both."""
    beyond = {min(values), max(values)} - {values[0], values[-1]}
    turns = sorted(beyond, key=[*values].index)
    return " to ".join(f"{value:g}" for value in (values[0], *turns, values[-1])).replace("-", "−")


def _point(point: PlanPoint) -> str:
    return f"({_mm(point[0])}, {_mm(point[1])})"


def _pascals(value: float) -> str:
    sizes = ((1e6, "MPa"), (1e3, "kPa"), (0.0, "Pa"))
    size, unit = next((size or 1.0, unit) for size, unit in sizes if abs(value) >= size)
    return f"{value / size:g} {unit}".replace("-", "−")


def _mm(length: float) -> str:
    return f"{1e3 * length:.4g}"
