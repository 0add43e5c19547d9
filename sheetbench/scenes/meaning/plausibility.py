"""Implausible values in scenes: valid numbers that are probably in the wrong unit.

A sentence for each names the key, the value, the unit and the spelling of the likely quantity. Implausible
are E below 1 kPa or above 10 GPa, a density outside 100 to 20 000 kg/m³, sides above 10 m, a thickness over a
quarter of the shorter side, a gravity other than the Earth's, and a distance of the springs' layers far from
the thickness; then a weight or loads that would tear the sheet, and a sheet that nothing moves.
"""

from collections.abc import Iterable, Iterator
from math import hypot
from warnings import warn

from sheetbench.errors import Implausible
from sheetbench.scenes.language.summary import few
from sheetbench.scenes.meaning.composition import mass_of, weights
from sheetbench.scenes.meaning.region import resultant
from sheetbench.scenes.meaning.strains import STRETCH_LIMIT, WEIGHT_LIMIT, weight_strain
from sheetbench.scenes.objects.fields import SceneFields
from sheetbench.scenes.objects.material import Material
from sheetbench.scenes.objects.sheet import Gravity, Sheet

SOFTEST, STIFFEST = 1e3, 1e10  # Pa: agar, and the stiffest polymers
STIFFEST_FIBRE = 1e12  # Pa: of a ply of carbon fibres 3e11
LIGHTEST, HEAVIEST = 100.0, 20_000.0  # kg/m³: foam, gold
LARGEST = 10.0  # m, of a side
THICKEST = 0.25  # of the shorter side
EARTH = (9.3, 10.3)  # m/s²; anything else is another planet or another unit
RUBBER = 10.0  # stress over E of small strains: Treloar's rubber at seven times its length has 5
LAYERS = 5.0  # times thicker or thinner than the sheet
HEAVY = 100.0  # a payload's mass over the sheet's


def slips(scene: SceneFields) -> tuple[str, ...]:
    """Return sentences about a scene's implausible values, none for most scenes."""
    sheet, springs = scene.sheet, scene.springs
    warnings = [*sheet_slips(sheet), *material_slips(scene.material), *_gravity_slips(scene.gravity)]
    warnings += _payload_slips(scene)
    if springs is not None:
        warnings += layer_slips(sheet, springs.layer_distance, "springs.layer_distance")
    if not warnings:  # else they may be the reason
        warnings = [*_strain_slips(scene)]
    still = "no gravity, load, actuator or bent support: nothing moves the sheet, all stays at zero"
    warnings += [still] * _nothing_moves(scene)
    return tuple(warnings)


def warn_of_slips(scenes: Iterable[tuple[str, SceneFields]], stacklevel: int) -> None:
    """Warn (Implausible) of the slips of scenes, with the scenes' names, once for each scene."""
    for name, scene in scenes:
        for slip in () if "_warned" in vars(scene) else slips(scene):
            warn(Implausible(f"{name}: {slip}"), stacklevel=stacklevel + 1)
        vars(scene)["_warned"] = True  # no key of the scene: equal scenes stay equal


def sheet_slips(sheet: Sheet) -> Iterator[str]:
    """Yield sentences on lengths that are probably not in metres."""
    side, shorter, keys = max(sheet.lengths), min(sheet.lengths), ("length_x", "length_y", "thickness")
    if side > LARGEST:
        written = ", ".join(f"{key} = {getattr(sheet, key):g} m" for key in keys)
        yield f'{written}: lengths are in metres; {side:g} mm is written {side / 1e3:g} or "{side:g} mm"'
    elif sheet.thickness > THICKEST * shorter:
        yield (
            f"thickness = {sheet.thickness:g} m is {few(sheet.thickness / shorter)} of the shorter side, "
            f"{shorter:g} m, which is no thin sheet; lengths are in metres"
        )


def material_slips(material: Material) -> Iterator[str]:
    """Yield sentences on moduli and densities that are probably not in Pa and kg/m³."""
    for key in ("young",) if material.kind == "isotropic" else ("young_1", "young_2"):
        young = getattr(material, key)
        if young < SOFTEST:
            yield (
                f"{key} = {young:g} Pa is softer than any solid sheet; "
                f'it is in pascals: {young:g} MPa is written {young:g}e6 or "{young:g} MPa"'
            )
        elif young > (STIFFEST if key == "young" else STIFFEST_FIBRE):
            stiff = f"is {young / 1e9:g} GPa, stiffer than any soft sheet; it is in pascals"
            yield f"{key} = {young:g} Pa {stiff}"
    density = material.density
    if density < LIGHTEST:
        yield (
            f"density = {density:g} kg/m³ is lighter than foam; "
            f'it is in kg/m³: {density:g} g/cm³ is written {1e3 * density:g} or "{density:g} g/cm³"'
        )
    elif density > HEAVIEST:
        yield f"density = {density:g} kg/m³ is heavier than any metal; water's is 1000 kg/m³"


def _payload_slips(scene: SceneFields) -> list[str]:
    """Return sentences on payloads that are probably not in kilograms."""
    heaviest = HEAVY * mass_of(scene) if scene.masses else 0.0
    return [
        f"mass {n}.mass = {payload.mass:g} kg is {few(payload.mass * HEAVY / heaviest)} of the sheet's; "
        f'masses are in kg: {payload.mass:g} g is written "{payload.mass:g} g"'
        for n, payload in enumerate(scene.masses, start=1)
        if payload.mass > heaviest
    ]


def layer_slips(sheet: Sheet, distance: float, key: str = "layer_distance") -> Iterator[str]:
    """Yield a sentence on a distance of layers [m] far from the thickness; key: the name of the distance."""
    ratio = distance / sheet.thickness
    if not 1.0 / LAYERS <= ratio <= LAYERS:
        times = f"{few(ratio, 3)} times the thickness, {sheet.thickness:g} m"
        yield f"{key} = {distance:g} m is {times}; lengths are in metres"


def _strain_slips(scene: SceneFields) -> Iterator[str]:
    """Yield sentences on a weight or loads that would tear the sheet."""
    sheet, young, law = scene.sheet, scene.material.young, scene.material.law
    heaviest, strongest = (WEIGHT_LIMIT, STRETCH_LIMIT) if law is None else (RUBBER, RUBBER)
    if (weight := weight_strain(scene)) > heaviest:
        yield (
            f"the weight alone stretches the sheet: ρ g a/E = {few(weight, 3)}, and above "
            f"{heaviest:g} {'no linear model means anything' if law is None else 'rubber tears'}"
        )
    acting = (*scene.loads, *weights(scene))
    whole = sum(abs(load.last_factor) * hypot(*resultant(scene, load)) for load in acting)
    pull = whole / (young * sheet.thickness * min(sheet.lengths))
    if pull > strongest:
        yield (
            f"the loads are {few(pull, 3)} times E · thickness · shorter side and would tear the "
            "sheet; forces are in N, forces per length in N/m, pressures in Pa"
        )


def _gravity_slips(gravity: Gravity | None) -> Iterator[str]:
    size = hypot(*gravity.acceleration) if gravity else 0.0
    if gravity and size and not EARTH[0] <= size <= EARTH[1]:
        likely = f": {size:g} mm/s² is written {size / 1e3:g}" if EARTH[0] <= size / 1e3 <= EARTH[1] else ""
        yield (
            f"gravity.acceleration = {list(gravity.acceleration)} is {size:g} m/s² strong, not the Earth's "
            f"9.81; it is in m/s²{likely}"
        )


def _nothing_moves(scene: SceneFields) -> bool:
    """Return whether nothing moves the sheet, so that only its modes are of interest."""
    weight = scene.gravity is not None and any(scene.gravity.acceleration)
    held = (*scene.supports, *scene.obstacles)
    bent = any(getattr(one, key, None) for one in held for key in ("tilt", "curvature", "motion"))
    return not (weight or bent or scene.loads or scene.actuators or scene.natural_by)
