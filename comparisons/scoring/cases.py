"""The cases of the reference set: scenes, and why each is in it.

statics   displacement at the probes
settling  displacement at the probes over time, from rest, weight and loads on at t = 0
modes     the lowest natural frequencies about the flat, stress-free sheet
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from sheetbench.scenes import (
    Clamped,
    EdgeLoad,
    Gravity,
    Held,
    Hinged,
    Load,
    Material,
    PointLoad,
    Pressure,
    Scene,
    Sheet,
    load,
)
from sheetbench.scenes.supports import AnySupport

SUITES = ("statics", "settling", "modes")
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
    every = (*_statics(), *_settling(), *_modes())
    return tuple(case for case in every if suite in (None, case.suite))


def _scene(
    name: str,
    supports: tuple[AnySupport, ...],
    sheet: Sheet = SEED,
    material: Material = NITRILE,
    loads: tuple[Load, ...] = (),
    weight: bool = True,
) -> Scene:
    gravity = WEIGHT if weight else None
    return Scene(name=name, sheet=sheet, material=material, gravity=gravity, supports=supports, loads=loads)


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
        (load("curved-edge-down"), "the same the other way, which weight helps"),
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


def _settling() -> Iterator[Case]:
    settling = load("two-edges-settling")
    yield Case(settling.name, "settling", settling, "the published model's motion, with dampers", 0.3)
    damped = _with(NITRILE, damping_time=2e-3)
    falling = _scene("one-edge-falling", ONE, material=damped)
    yield Case(falling.name, "settling", falling, "a sheet let go: large rotations in time", 0.4)
    struck = _scene(
        "corner-struck", CORNER, _thick(0.006), damped, (PointLoad(at=(0.188, 0.188), force=(0.0, 0.0, 4.0)),)
    )
    yield Case(struck.name, "settling", struck, "a force put on a corner at once: many modes", 0.15)


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
