"""Three problems whose answer depends on one number alone, by lattices and shells.

**Cantilever** under its own weight: drop over reach H/W against Γ = ρ_A g L³/B (ρ_A mass per area, B bending
stiffness per width; ν = 0 here, B = E h³/12). Exact: the heavy elastica θ'' = −Γ (1 − s) cos θ,
θ(0) = θ'(1) = 0, solved by collocation.

**Lateral buckling** of a strip on edge, clamped at one end, under its own weight: the number
Γ* = 12 (1 − ν²) ρ g L³/(E h²) at which it leaves its plane. A narrow strip has 18.17 (1 − ν²)/√(1 + ν), of
(q L³) = 12.85 √(EI·GJ) (Timoshenko and Gere); wider ones are found here, by bisection for the largest stable
load.

**Bending and twisting** of a strip that is clamped with its plane turned by 45° about its length, under its
own weight: how far the tip drops and goes aside, over the length, against Γ (ν = 0). Exact, of a narrow
strip: Kirchhoff's rod (`studies.master_curves.twist`).

Romero et al. 2021 (ACM Trans. Graph. 40(4)) use the first two to judge simulators.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import numpy as np
from scipy.integrate import solve_bvp

from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import spec_of
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture
from sheetbench.answers.table import Column, Table
from sheetbench.errors import Implausible
from sheetbench.scenes import Clamped, Gravity, Material, Scene, Sheet, Solution
from studies.master_curves.twist import tip, weight_direction

YOUNG, DENSITY, WIDTH = 1e7, 1000.0, 0.25
LOADS = (0.1, 0.316, 1.0, 3.16, 10.0, 31.6, 100.0)
CANTILEVERS: dict[str, dict[str, Any]] = {
    "lattice 9": {"grid": (9, 3)},
    "lattice 17": {"grid": (17, 3)},
    "lattice 33": {"grid": (33, 3)},
    "lattice 33, graded": {"grid": (33, 3), "grading": "0.9:x0"},
    "shell 4": {"model": "shell", "elements": (4, 1)},
    "shell 16": {"model": "shell", "elements": (16, 1)},
}
POISSON, SLENDER = 0.35, 0.002  # of the strips on edge; thickness over length
WIDTHS = (0.05, 0.1, 0.2, 0.4)  # over length
BISECTIONS = 13
TURNED, TURNED_WIDTH = np.pi / 4, 0.05
TWISTING = (1.0, 2.0, 4.0, 8.0, 16.0, 32.0)
TWISTED: dict[str, dict[str, Any]] = {
    "lattice 33": {"grid": (33, 3)},
    "shell 16": {"model": "shell", "elements": (16, 1)},
    "shell 32": {"model": "shell", "elements": (32, 2)},
}
NARROW = 18.17 * (1.0 - POISSON**2) / (1.0 + POISSON) ** 0.5


@dataclass(frozen=True)
class Drop:
    """Drop over reach of a cantilever."""

    load: Annotated[float, Column("Γ", form="g")]
    model: str
    exact: Annotated[float, Column("H/W exact", form=".5g")]
    found: Annotated[float, Column("H/W", form=".5g")]

    @property
    def error(self) -> Annotated[float, Column("off by", "", "%", 100.0, "z.2f")]:
        """Relative difference."""
        return self.found / self.exact - 1.0


@dataclass(frozen=True)
class Buckled:
    """Critical load of a strip on edge."""

    width: Annotated[float, Column("width/length", form="g")]
    shell: Annotated[float, Column("Γ* shell 16", form=".2f")]
    lattice: Annotated[float, Column("Γ* lattice 33", form=".2f")]


@dataclass(frozen=True)
class Twisted:
    """How far the tip of a turned strip goes, over its length."""

    load: Annotated[float, Column("Γ", form="g")]
    model: str
    narrow_drop: Annotated[float, Column("drop, narrow strip", form=".4f")]
    drop: Annotated[float, Column("drop", form=".4f")]
    narrow_aside: Annotated[float, Column("aside, narrow strip", form=".4f")]
    aside: Annotated[float, Column("aside", form=".4f")]

    @property
    def error(self) -> Annotated[float, Column("off by", "", "%", 100.0, ".2f")]:
        """The distance of both tips over the narrow strip's displacement."""
        miss = np.hypot(self.drop - self.narrow_drop, self.aside - self.narrow_aside)
        return float(miss / np.hypot(self.narrow_drop, self.narrow_aside))


@dataclass(frozen=True, repr=False)
class MasterCurves(Answer):
    """The three curves."""

    drops: tuple[Drop, ...]
    buckled: tuple[Buckled, ...]
    twisted: tuple[Twisted, ...]

    file_name = "master-curves"
    narrow = NARROW

    def heading(self) -> tuple[str, str, str]:
        return "Master curves", "sheets without units", ""

    def tables(self) -> tuple[Table, ...]:
        fields = ("load", "model", "exact", "found", "error")
        narrow = f"A narrow strip has Γ* = {NARROW:.2f} (ν = {POISSON:g}, h/L = {SLENDER:g})."
        return (
            Table.of(
                Drop, self.drops, "Cantilever under its weight", "cantilever", fields=fields, grouped=True
            ),
            Table.of(Buckled, self.buckled, "Lateral buckling of a strip on edge", "buckling", text=narrow),
            Table.of(
                Twisted,
                self.twisted,
                "Bending and twisting of a strip that is turned by 45°",
                "bend-twist",
                fields=("load", "model", "narrow_drop", "drop", "narrow_aside", "aside", "error"),
                grouped=True,
                text=f"Sheets are {TURNED_WIDTH:g} of their length wide, {SLENDER:g} thick, ν = 0. Shells "
                "differ by what their mesh leaves open; what both are off is the width.",
            ),
        )

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("master-curves", "studies.master_curves.figure:compose", (self,)),)

    def document(self) -> dict[str, Any]:
        return {
            "cantilever": [{**asdict(drop), "error": drop.error} for drop in self.drops],
            "buckling": [asdict(one) for one in self.buckled],
            "narrow": self.narrow,
            "bend_twist": [{**asdict(one), "error": one.error} for one in self.twisted],
        }


def elastica(load: float) -> float:
    """H/W of the heavy elastica."""
    s, y = np.linspace(0.0, 1.0, 201), np.zeros((2, 201))
    for weight in np.geomspace(min(load, 0.1), load, 12):

        def slopes(at: np.ndarray, state: np.ndarray, weight: float = weight) -> np.ndarray:
            return np.vstack([state[1], weight * (1.0 - at) * np.cos(state[0])])

        found = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1]]), s, y, tol=1e-9, max_nodes=20000)
        s, y = found.x, found.y
    return float(np.trapezoid(np.sin(y[0]), s) / np.trapezoid(np.cos(y[0]), s))


def cantilever(load: float) -> Scene:
    """A strip of 1 m with ν = 0, at Γ = load."""
    thickness = 0.005
    weight = load * YOUNG * thickness**2 / 12.0 / DENSITY
    return _strip((1.0, WIDTH, thickness), 0.0, (0.0, 0.0, -weight))


def on_edge(load: float, width: float) -> Scene:
    """A strip of 1 m on edge, at Γ* = load."""
    weight = load * YOUNG * SLENDER**2 / (12.0 * (1.0 - POISSON**2) * DENSITY)
    return _strip((1.0, width, SLENDER), POISSON, (0.0, -weight, 0.0))


def turned(load: float, width: float = TURNED_WIDTH) -> Scene:
    """A strip of 1 m with ν = 0 whose plane is turned about its length, at Γ = load."""
    weight = load * YOUNG * SLENDER**2 / 12.0 / DENSITY
    x, y, z = (weight * weight_direction(TURNED)).tolist()
    return _strip((1.0, width, SLENDER), 0.0, (x, y, z))


def _strip(size: tuple[float, float, float], poisson: float, weight: tuple[float, float, float]) -> Scene:
    length, width, thickness = size
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", Implausible)  # no weight of this planet
        return Scene(
            name="strip",
            sheet=Sheet(length_x=length, length_y=width, thickness=thickness),
            material=Material(young=YOUNG, poisson=poisson, density=DENSITY),
            supports=(Clamped(edge="x0"),),
            gravity=Gravity(acceleration=weight),
            probes={"tip": (length, width / 2.0)},
        )


def _solve(scene: Scene, model: str = "lumped", **settings: Any) -> Solution:
    return solve(resolve(scene, spec_of(model, settings)))


def measure(progress: Callable[[str], None]) -> MasterCurves:
    """Solve both problems."""
    return MasterCurves(tuple(_drops(progress)), tuple(_buckled(progress)), tuple(_twisted(progress)))


def _drops(progress: Callable[[str], None]) -> Iterator[Drop]:
    for load in LOADS:
        exact, scene = elastica(load), cantilever(load)
        for name, settings in CANTILEVERS.items():
            progress(f"cantilever, Γ = {load:g}: {name}")
            moved = _solve(scene, **settings).displacement(np.array([[1.0, WIDTH / 2.0]]))[0]
            yield Drop(load, name, -exact, -moved[2] / (1.0 + moved[0]))


def _buckled(progress: Callable[[str], None]) -> Iterator[Buckled]:
    for width in WIDTHS:
        across = max(2, round(16 * width))
        models: tuple[dict[str, Any], ...] = (
            {"model": "shell", "elements": (16, across)},
            {"grid": (33, 2 * across + 1)},
        )
        found = []
        for settings in models:
            progress(f"strip on edge, width {width:g}: {settings.get('model', 'lattice')}")
            stable, unstable = 5.0, 40.0
            for _ in range(BISECTIONS):
                middle = (stable + unstable) / 2.0
                holds = _solve(on_edge(middle, width), **settings).status == "converged"
                stable, unstable = (middle, unstable) if holds else (stable, middle)
            found.append((stable + unstable) / 2.0)
        yield Buckled(width, *found)


def _twisted(progress: Callable[[str], None]) -> Iterator[Twisted]:
    down = weight_direction(TURNED)
    across = np.array([0.0, -down[2], down[1]])
    for load in TWISTING:
        progress(f"turned strip, Γ = {load:g}")
        exact, scene = tip(load, 0.0, TURNED), turned(load)
        for name, settings in TWISTED.items():
            moved = _solve(scene, **settings).displacement(scene.probe_points())[0]
            yield Twisted(load, name, *(float(u @ way) for way in (down, across) for u in (exact, moved)))
