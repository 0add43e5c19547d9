"""The cases of the reference set: scenes, and why each is in it.

statics  displacement at the probes
motion   displacement at the probes over time, from rest, weight and loads on at t = 0
modes    the lowest natural frequencies about the flat, stress-free sheet
curves   as statics: strips whose answer depends on one number alone (`comparisons.scoring.curves`)
natural  as statics: sheets that are not flat at rest
contact  as statics: sheets that touch something (`comparisons.scoring.contact`)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from math import pi, sin
from typing import Any

from comparisons.scoring import contact, curves
from sheetbench.scenes import (
    Chain,
    Clamped,
    CurvatureTable,
    EdgeLoad,
    FactorTable,
    Gravity,
    Held,
    Hinged,
    Load,
    Material,
    Patch,
    PointLoad,
    Pressure,
    Scene,
    Sheet,
    load,
)
from sheetbench.scenes.objects.natural import Natural
from sheetbench.scenes.objects.shapes import Rectangle, Shape
from sheetbench.scenes.objects.supports import AnySupport, Motion

AT_REST = ("statics", "curves", "natural", "contact")  # displacements without time
FREQUENCIES = 6
SEED = Sheet(length_x=0.188, length_y=0.188, thickness=0.003)
NITRILE = Material(young=54.5e6, poisson=0.48, density=1678.0)
SILICONE = Material(young=1.2e6, poisson=0.49, density=1080.0)
WEIGHT = Gravity(acceleration=(0.0, 0.0, -9.81))
CORNER = (Clamped(edge="x0"), Clamped(edge="y0"))
ONE = (Clamped(edge="x0"),)
ROUND = tuple(Clamped(edge=edge) for edge in ("x0", "x1", "y0", "y1"))


@dataclass(frozen=True)
class Case:
    """A scene of a suite; why: it is in the set; duration: of a motion [s]."""

    name: str
    suite: str
    scene: Scene
    why: str
    duration: float | None = None


def cases(suite: str | None = None) -> tuple[Case, ...]:
    """All cases, or those of one suite."""
    every = (*_statics(), *_motion(), *_modes(), *_curves(), *_natural(), *_contact())
    return tuple(case for case in every if suite in (None, case.suite))


def _scene(
    name: str,
    supports: tuple[AnySupport, ...],
    sheet: Sheet = SEED,
    material: Material = NITRILE,
    loads: tuple[Load, ...] = (),
    weight: bool = True,
    actuators: tuple[Chain, ...] = (),
) -> Scene:
    gravity = WEIGHT if weight else None
    return Scene(
        name=name,
        sheet=sheet,
        material=material,
        gravity=gravity,
        supports=supports,
        loads=loads,
        actuators=actuators,
    )


def _with(material: Material, **changes: float) -> Material:
    return Material(**{**material.model_dump(), **changes})


def _thick(thickness: float) -> Sheet:
    return SEED.model_copy(update={"thickness": thickness})


def _statics() -> Iterator[Case]:
    strip, oblong = (
        Sheet(length_x=0.3, length_y=0.06, thickness=0.002),
        Sheet(length_x=0.3, length_y=0.15, thickness=0.004),
    )
    soft = _with(NITRILE, young=5.45e6)
    whys: list[tuple[Scene, str]] = [
        (load("two-edges-clamped"), "the published model's test 1; bending and some stretching"),
        (load("one-edge-clamped"), "bending alone, rotations of 20 degrees"),
        (
            load("curved-edge"),
            "the published model's test 2: a narrow layer at a bent edge stiffens the sheet",
        ),
        (load("curved-edge-down"), "the published model's test 2 bent downward, which weight helps"),
        (load("actuated-edge"), "an edge bound to an actuated chain"),
        (
            _scene("poisson-0", CORNER, material=_with(NITRILE, poisson=0.0)),
            "ν = 0: area springs are negative",
        ),
        (_scene("poisson-0.3", CORNER, material=_with(NITRILE, poisson=0.3)), "ν = 0.3, near Cauchy's 1/3"),
        (_scene("poisson-0.49", CORNER, material=_with(NITRILE, poisson=0.49)), "nearly incompressible"),
        (_scene("thin", CORNER, _thick(0.001)), "1 mm: stretching carries most of the weight"),
        (_scene("thick", CORNER, _thick(0.012)), "12 mm: shear through the thickness, hardly nonlinear"),
        (_scene("soft-one-edge", ONE, material=soft), "E/10: hangs nearly vertically, large rotations"),
        (_scene("soft-two-edges", CORNER, material=soft), "E/10: large rotations and stretching together"),
        (_scene("tilted-clamp", (Clamped(edge="x0", tilt=0.6),)), "a clamp turned by 0.6 rad"),
        (
            _scene("clamped-round", ROUND, loads=(Pressure(value=2000.0),), weight=False),
            "pressure on a sheet clamped all round: a membrane, with layers at its edges",
        ),
        (
            _scene("opposite-edges", (Clamped(edge="x0"), Clamped(edge="x1")), oblong),
            "held at both ends: stretching from the first millimetre on",
        ),
        (
            _scene("hinged-round", tuple(Hinged(edge=s.edge) for s in ROUND), oblong, SILICONE),
            "hinged all round, soft: free to turn at its edges",
        ),
        (
            _scene("on-a-rail", (Clamped(edge="x0"), Held(edge="x1", components=("z",))), oblong, SILICONE),
            "an edge that slides on a rail, silicone",
        ),
        (
            _scene(
                "strip-tip-force",
                ONE,
                strip,
                loads=(EdgeLoad(edge="x1", force_per_length=(0.0, 0.0, 3.0)),),
                weight=False,
            ),
            "a long strip's end lifted: a cantilever in large rotation, cells of any aspect",
        ),
        (
            _scene(
                "strip-roll-up",
                ONE,
                strip,
                loads=(EdgeLoad(edge="x1", moment_per_length=0.35),),
                weight=False,
            ),
            "a strip bent to a large part of a circle by a moment: rotations and nothing else",
        ),
        (
            _scene("corner-force", CORNER, loads=(PointLoad(at=(0.188, 0.188), force=(0.0, 0.0, 1.0)),)),
            "a point load at the free corner: twist",
        ),
    ]
    for scene, why in whys:
        yield Case(scene.name, "statics", scene, why)


def _motion() -> Iterator[Case]:
    damped = _with(NITRILE, damping_time=2e-3)
    struck = PointLoad(at=(0.188, 0.188), force=(0.0, 0.0, 4.0))
    times = tuple(n / 80 for n in range(41))  # s
    shaken = Motion(
        time=times, displacement=tuple((0.0, 0.0, round(0.005 * sin(2.0 * pi * 4.0 * t), 9)) for t in times)
    )
    bent = CurvatureTable(time=(0.0, 0.05, 0.15, 0.2), value=(0.0, 4.0, -4.0, 0.0))
    chain = Chain(
        edge="x1", segments=16, bending_stiffness=0.2, line_density=0.05, radius=1.5e-3, curvature=bent
    )
    pushed = Motion(time=(0.0, 0.1), displacement=((0.0, 0.0, 0.0), (-0.006, 0.0, 0.0)))
    lifted = PointLoad(
        at=(0.096, 0.03),
        force=(0.0, 0.0, 2.0),
        history=FactorTable(time=(0.0, 0.1, 0.2), factor=(0.0, 0.0, 1.0)),
    )
    whys: list[tuple[Scene, str, float]] = [
        (load("two-edges-settling"), "the published model's motion, with dampers", 0.3),
        (_scene("one-edge-falling", ONE, material=damped), "a sheet let go: large rotations in time", 0.42),
        (
            _scene("corner-struck", CORNER, _thick(0.006), damped, (struck,)),
            "a force put on a corner at once: many modes",
            0.15,
        ),
        (_scene("free-swing", ONE), "let go without dampers: period and amplitude", 0.6),
        (
            _scene("harmonic-base", (Clamped(edge="x0", motion=shaken),), material=damped, weight=False),
            "a clamp that moves up and down 4 times a second, above the lowest frequency",
            0.48,
        ),
        (
            _scene("driven-chain", ONE, material=damped, weight=False, actuators=(chain,)),
            "a chain that bends the free edge up, then down: what it moves is the sheet's inertia",
            0.42,
        ),
        (
            _scene(
                "snap-through",
                (Clamped(edge="x0"), Clamped(edge="x1", motion=pushed)),
                Sheet(length_x=0.24, length_y=0.06, thickness=0.002),
                _with(NITRILE, damping_time=1e-3),
                (lifted,),
            ),
            "a strip buckled by its clamps, then pushed through: a snap with inertia",
            0.36,
        ),
        (
            _scene("pressure-step", ROUND, loads=(Pressure(value=500.0),), material=damped, weight=False),
            "pressure put at once on a sheet clamped all round: it stiffens as it goes",
            0.03,
        ),
    ]
    for scene, why, duration in whys:
        yield Case(scene.name, "motion", scene, why, duration)


def _modes() -> Iterator[Case]:
    oblong = Sheet(length_x=0.3, length_y=0.15, thickness=0.004)
    whys: list[tuple[str, dict[str, Any], str]] = [
        ("modes-one-edge", {"supports": ONE}, "a cantilever plate"),
        ("modes-two-edges", {"supports": CORNER}, "two adjacent edges clamped"),
        ("modes-round", {"supports": ROUND}, "clamped all round: short waves"),
        ("modes-thick", {"supports": CORNER, "sheet": _thick(0.012)}, "shear and rotary inertia"),
        ("modes-oblong", {"supports": ONE, "sheet": oblong}, "aspect 2: bending beside twisting"),
        (
            "modes-poisson-0",
            {"supports": CORNER, "material": _with(NITRILE, poisson=0.0)},
            "ν = 0: area springs are negative",
        ),
        ("modes-free", {"supports": ()}, "nothing held: rigid motions left out, edges let twist go"),
    ]
    for name, parts, why in whys:
        yield Case(name, "modes", _scene(name, weight=False, **parts), why)


def _curves() -> Iterator[Case]:
    for number in (0.1, 1.0, 10.0, 100.0):
        yield _curve(curves.cantilever(number), f"the heavy elastica at Γ = {number:g}")
    for number in (1.0, 4.0, 16.0, 64.0):
        yield _curve(curves.bend_twist(number), f"a strip turned by 45° bends and twists, Γ = {number:g}")
    for number in (10.0, 13.0, 15.0, 20.0, 30.0):
        leans = curves.on_edge(number, off=curves.LEANS)
        yield _curve(leans, f"a strip on edge at Γ = {number:g}; an upright one buckles at Γ* = 14.9")


def _curve(scene: Scene, why: str) -> Case:
    return Case(scene.name, "curves", scene, why)


def _natural() -> Iterator[Case]:
    strip = (
        Sheet(length_x=0.18, length_y=0.06, thickness=0.003),
        Material(young=20e6, poisson=0.48, density=1100.0),
    )
    band = Shape(rectangle=Rectangle(x=(0.06, 0.12), y=(0.0, 0.06)))
    curls = Patch(shape=band, natural=Natural(curvature=(20.0, 0.0, 0.0)))
    turns = Natural(curvature=(0.5 * pi / strip[0].length_x, 0.0, 0.0))
    muscle, arc = _scene("muscle-band", ONE, *strip), _scene("quarter-turn", ONE, *strip, weight=False)
    whys: list[tuple[Scene, str]] = [
        (load("bimetal-strip"), "two layers, one of which expands: large rotations by temperature"),
        (
            muscle.replace(patches=(curls,)),
            "a band across a strip curls up and lifts its end against the weight",
        ),
        (load("heated-plate"), "heated to three times where it buckles; its weight says which way"),
        (
            arc.replace(natural=turns),
            "natural curvature alone turns a strip by a quarter: an arc, in closed form",
        ),
    ]
    for scene, why in whys:
        yield Case(scene.name, "natural", scene, why)


def _contact() -> Iterator[Case]:
    for scene, why in contact.scenes():
        yield Case(scene.name, "contact", scene, why)
