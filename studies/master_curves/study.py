"""Three problems with one parameter (`curves`), solved by lattices, shells and other codes.

**Cantilever**: drop over reach H/W against Γ. Exact: the heavy elastica θ'' = −Γ (1 − s) cos θ,
θ(0) = θ'(1) = 0, solved by collocation.

**Strip on edge**: the Γ* at which it leaves its plane. A narrow strip has 18.17 (1 − ν²)/√(1 + ν), from
(q L³) = 12.85 √(EI·GJ) (Timoshenko and Gere); wider strips are computed by bisection for the largest stable
load. A leaning strip leaves its plane earlier, and its tip's way aside is a curve for any code.

**Bending and twisting**: the tip's drop and way aside, over the length, against Γ. Exact for a narrow
strip: Kirchhoff's rod (`studies.master_curves.twist`).
"""

from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass
from typing import Annotated, Any

import numpy as np
from scipy.integrate import solve_bvp

from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import spec_of
from comparisons.scoring.reference import references
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import Picture, drawn_from
from sheetbench.answers.solution import Solution
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import Scene
from studies.codes.results import OURS, every_result
from studies.master_curves.curves import (
    LENGTH,
    POISSON,
    SLENDER,
    TURNED,
    WIDTH,
    bend_twist,
    cantilever,
    on_edge,
    way,
)
from studies.master_curves.curves import NARROW as NARROW_WIDTH
from studies.master_curves.twist import tip

LOADS = (0.1, 0.316, 1.0, 3.16, 10.0, 31.6, 100.0)
CANTILEVERS: dict[str, dict[str, Any]] = {
    "lattice 9": {"grid": (9, 3)},
    "lattice 17": {"grid": (17, 3)},
    "lattice 33": {"grid": (33, 3)},
    "lattice 33, graded": {"grid": (33, 3), "grading": "0.9:x0"},
    "shell 4": {"model": "shell", "elements": (4, 1)},
    "shell 16": {"model": "shell", "elements": (16, 1)},
}
WIDTHS = (0.05, 0.1, 0.2, 0.4)  # over length
BISECTIONS = 13
TURNED_WIDTH = 0.05  # over length
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
    def error(self) -> Annotated[float, Column("difference", "", "%", 100.0, "z.2f")]:
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
    """Displacement of the tip of a turned strip, over its length."""

    load: Annotated[float, Column("Γ", form="g")]
    model: str
    narrow_drop: Annotated[float, Column("drop, narrow strip", form=".4f")]
    drop: Annotated[float, Column("drop", form=".4f")]
    narrow_aside: Annotated[float, Column("aside, narrow strip", form=".4f")]
    aside: Annotated[float, Column("aside", form="z.4f")]

    @property
    def error(self) -> Annotated[float, Column("difference", "", "%", 100.0, ".2f")]:
        """Distance of both tips over the narrow strip's displacement."""
        miss = np.hypot(self.drop - self.narrow_drop, self.aside - self.narrow_aside)
        return float(miss / np.hypot(self.narrow_drop, self.narrow_aside))


@dataclass(frozen=True)
class Tip:
    """Tip's displacement over the length, by a code with our numbers, on a curve of the reference set."""

    case: str
    code: str
    along: Annotated[float, Column("along", form="z.4f")]
    down: Annotated[float, Column("down", form="z.4f")]
    aside: Annotated[float, Column("aside", form="z.4f")]
    error: Annotated[float, Column("difference", "", "%", 100.0, ".2f")]


@dataclass(frozen=True, repr=False)
class MasterCurves(Answer):
    """Rows of the three curves."""

    drops: tuple[Drop, ...]
    buckled: tuple[Buckled, ...]
    twisted: tuple[Twisted, ...]
    tips: tuple[Tip, ...]

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
            Table.of(
                Tip,
                self.tips,
                "Codes on the curves of the reference set",
                "codes",
                grouped=True,
                text="With our numbers, 4 squares along the shorter side, beside the converged shell; strips "
                f"are {WIDTH:g} (cantilever) and {NARROW_WIDTH:g} of their length wide.",
            ),
        )

    def figures(self) -> tuple[Picture, ...]:
        return (
            Picture(
                "master-curves", "studies.master_curves.figure:compose", (self,), drawn_from(self.tables())
            ),
        )

    def document(self) -> dict[str, Any]:
        return {
            "cantilever": [{**asdict(drop), "error": drop.error} for drop in self.drops],
            "buckling": [asdict(row) for row in self.buckled],
            "narrow": self.narrow,
            "bend_twist": [{**asdict(row), "error": row.error} for row in self.twisted],
            "codes": [asdict(row) for row in self.tips],
        }


def elastica(load: float) -> float:
    """Return H/W of the heavy elastica."""
    s, y = np.linspace(0.0, 1.0, 201), np.zeros((2, 201))
    for weight in np.geomspace(min(load, 0.1), load, 12):

        def slopes(at: np.ndarray, state: np.ndarray, weight: float = weight) -> np.ndarray:
            return np.vstack([state[1], weight * (1.0 - at) * np.cos(state[0])])

        solution = solve_bvp(slopes, lambda a, b: np.array([a[0], b[1]]), s, y, tol=1e-9, max_nodes=20000)
        s, y = solution.x, solution.y
    return float(np.trapezoid(np.sin(y[0]), s) / np.trapezoid(np.cos(y[0]), s))


def _solve(scene: Scene, model: str = "lumped", **settings: Any) -> Solution:
    return solve(resolve(scene, spec_of(model, settings)))


def _tips() -> Iterator[Tip]:
    for code in every_result():
        for row in code.rows:
            if row.recipe == OURS and row.moved and (case := references("curves").get(row.scene)):
                u = np.array(row.moved[0])
                yield Tip(case.name, code.title, *way(case.scene, u), row.error or 0.0)


def _tip(scene: Scene, **settings: Any) -> tuple[float, float, float]:
    """Return the tip's displacement along the strip, down and aside; nan without a stable equilibrium."""
    solution = _solve(scene, **settings)
    u = solution.displacement(scene.probe_points())[0]
    return way(scene, u if solution.status == "converged" else np.full(3, np.nan))


def measure(progress: Callable[[str], None]) -> MasterCurves:
    """Solve the three problems, and read the answers of codes."""
    solved = tuple(_drops(progress)), tuple(_buckled(progress)), tuple(_twisted(progress))
    return MasterCurves(*solved, tuple(_tips()))


def _drops(progress: Callable[[str], None]) -> Iterator[Drop]:
    for load in LOADS:
        exact, scene = elastica(load), cantilever(load)
        for name, settings in CANTILEVERS.items():
            progress(f"cantilever, Γ = {load:g}: {name}")
            along, down, _ = _tip(scene, **settings)
            yield Drop(load, name, -exact, down / (1.0 + along))


def _buckled(progress: Callable[[str], None]) -> Iterator[Buckled]:
    for width in WIDTHS:
        across = max(2, round(16 * width))
        models: tuple[dict[str, Any], ...] = (
            {"model": "shell", "elements": (16, across)},
            {"grid": (33, 2 * across + 1)},
        )
        critical = []
        for settings in models:
            progress(f"strip on edge, width {width:g}: {settings.get('model', 'lattice')}")
            stable, unstable = 5.0, 40.0
            for _ in range(BISECTIONS):
                middle = (stable + unstable) / 2.0
                is_stable = _solve(on_edge(middle, width), **settings).status == "converged"
                stable, unstable = (middle, unstable) if is_stable else (stable, middle)
            critical.append((stable + unstable) / 2.0)
        yield Buckled(width, *critical)


def _twisted(progress: Callable[[str], None]) -> Iterator[Twisted]:
    for load in TWISTING:
        progress(f"turned strip, Γ = {load:g}")
        scene = bend_twist(load, TURNED_WIDTH)
        _, drop, aside = way(scene, LENGTH * tip(load, 0.0, TURNED))
        for name, settings in TWISTED.items():
            _, model_drop, model_aside = _tip(scene, **settings)
            yield Twisted(load, name, drop, model_drop, aside, model_aside)
