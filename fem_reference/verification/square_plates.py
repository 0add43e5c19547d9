"""Square plates: uniform load, locking, natural frequencies, fibres, plates that are not flat at rest.

Mindlin plates, ν 0.3, shear correction 5/6: w D/(q L⁴) at the centre, with hard simple support (deflection
and the tilt along the edge held) and clamped, h/L 0.001 to 0.2. The shell is tested clamped, under
a load so small that it is linear. The thick clamped plates have no closed form: their value is this project's
plate on 48 × 48 elements.

Locking: a model that locks answers with a fraction of the deflection. Each answer on a fixed 8 × 8 mesh is
compared with its model's answer on a mesh that is two or three times finer, which is converged to 0.1 % and
better. The plate and the shell go from h/L = 1e-5 to 0.2; so does the solid for ν up to 0.4999, from 1e-3: in
thinner sheets its stiffness through the thickness, (L/h)² times the bending stiffness and more as ν → ½,
leaves no digits. Both meshes of the solid have one layer, whose shear is a little stiff in a thick sheet:
that is no locking.

Frequencies: NAFEMS FV16 and FV12, and Leissa's thin plates. NAFEMS' targets and Leissa's coefficients are
upper bounds, up to 1.3 % above converged plates, and held to 1.5 %. The converged values are this
project's own, of the plate on 36 × 36 elements and more, the thin plates' at h/a = 1e-4; where there are any,
models are held to 0.3 % of them.

Thin plates with fibres along their sides, simply supported, deflect by

    w = 16 q/π⁶ Σ sin(mπ/2) sin(nπ/2)/(m n Δ),   Δ = (D₁₁ m⁴ + 2 (D₁₂ + 2 D₆₆) m² n² + D₂₂ n⁴)/a⁴,  m, n odd

in the middle under a uniform load q, and have the frequencies ω = π² √(Δ/ρh), m, n any. The laminate
[0/90]s has D₁₁ and D₂₂ of its layers: the outer ones, along x, have 7/8 of the second moment.

Not flat at rest:

    arc         a cantilever of natural curvature k0, ¼ turn: tip at (sin kL/k, (1 − cos kL)/k), no energy
    buckling    a square hinged all round, heated: e0 = π² h²/6 (1 + ν) a² (Kirchhoff)
    frequency   this square stretched by N: ω² = (D q² + N q)/ρh, q = 2π²/a²

Sources: Navier's series in Wang, Reddy & Lee, Shear Deformable Beams and Plates (2000), and in Timoshenko &
Woinowsky-Krieger, Theory of Plates and Shells (1959), 85; Taylor & Govindjee, Solution of clamped rectangular
plate problems, Commun. Numer. Meth. Engng 20 (2004) 757–765, report UCB/SEMM-2002/09: 0.00126532; NAFEMS,
Selected Benchmarks for Natural Frequency Analysis (1987); Leissa, J. Sound Vib. 31 (1973) 257–293, and of
fibres Vibration of Plates, NASA SP-160 (1969), 9.1; Reddy, Mechanics of Laminated Composite Plates and Shells
(2004), 5.2.
"""

from collections.abc import Iterator, Sequence
from itertools import product
from math import pi, sin, sqrt
from typing import NamedTuple

import numpy as np

from fem_reference.linear_buckling import buckling
from fem_reference.surface.materials import section_of
from fem_reference.verification.rows import EXACT, OURS, Row, curve, lowest, mesh_change, relative_row
from fem_reference.verification.specimens import E1, E2, FIBRES, NU, G, specimen, supports, u_at
from fem_reference.vibration import modes
from sheetbench.scenes import Clamped, Hinged, Layer, Material, Sheet
from sheetbench.scenes.objects.natural import Natural

ELEMENTS = 16
MESH = f"{{}} {ELEMENTS} × {ELEMENTS}"
THIN = Sheet(length_x=1.0, length_y=1.0, thickness=1e-3)
SMALL = 1e-4  # deflection at the centre over the thickness

HARD_SIMPLE = {0.001: 0.00406, 0.1: 0.00427, 0.2: 0.00490}
CLAMPED = {0.001: 0.0012653, 0.1: 0.001505, 0.2: 0.002172}
FINER = f"{OURS}, 48 × 48"
LOADED = {
    "hinged": (HARD_SIMPLE, dict.fromkeys(HARD_SIMPLE, "Wang, Reddy & Lee 2000")),
    "clamped": (CLAMPED, {0.001: "Taylor & Govindjee 2004", 0.1: FINER, 0.2: FINER}),
}
FIXED = 8  # elements of the mesh that may lock
THICK = (1e-3, 1e-2, 0.05, 0.1, 0.2)


class Sweep(NamedTuple):
    """A model's test of locking: elements of the finer mesh, tolerance, h/L and ν."""

    finer: int
    tolerance: float
    ratios: tuple[float, ...]
    poissons: tuple[float, ...] = (0.3,)


SWEEPS = {
    "plate": Sweep(24, 2e-2, (1e-5, 1e-4, *THICK)),
    "shell": Sweep(24, 2e-2, (1e-5, 1e-4, *THICK)),
    "solid": Sweep(16, 1e-2, THICK, (0.3, 0.48, 0.499, 0.4999)),
}

CONVERGED, BOUND = 3e-3, 1.5e-2  # tolerances
STEEL = Material(young=200e9, poisson=0.3, density=8000.0)
NAFEMS = Sheet(length_x=10.0, length_y=10.0, thickness=0.05)
COEFFICIENT = "ω a² √(ρh/D)"
LAYERS = tuple(Layer(2.5e-4, angle=angle) for angle in (0.0, pi / 2, pi / 2, 0.0))
# Arguments of `fibres`: layers, the outer layers' share of the second moment along x, and the source.
PLY = (), 1.0, "Navier's series, Timoshenko & Woinowsky-Krieger 1959"
LAMINATE = LAYERS, 0.875, "Navier's series of the laminate, Reddy 2004"


class Benchmark(NamedTuple):
    """Sheet clamped along edges and its first six frequencies; unit: "Hz" or COEFFICIENT."""

    title: str
    sheet: Sheet
    edges: tuple[str, ...]
    source: str
    unit: str
    converged: Sequence[float | None]
    bounds: Sequence[float | None]
    models: tuple[str, ...] = ("plate", "shell")


BENCHMARKS = {
    "nafems-fv16": Benchmark(
        "cantilevered square plate", NAFEMS, ("x0",), "NAFEMS 1987, FV16", "Hz",
        (0.4179, 1.0227, 2.5618, 3.272, 3.7214, 6.5105), (0.421, 1.029, 2.582, 3.306, 3.753, 6.555),
        ("plate", "shell", "solid"),
    ),
    "nafems-fv12": Benchmark(
        "free square plate", NAFEMS, (), "NAFEMS 1987, FV12", "Hz",
        (None, None, None, 4.182, 4.182, None), (1.622, 2.360, 2.922, 4.233, 4.233, 7.416),
    ),
    "leissa-one-edge": Benchmark(
        "thin square plate, one edge clamped", THIN, ("x0",), "Leissa 1973", COEFFICIENT,
        (3.471, 8.506, 21.28, 27.20, 30.95, 54.18), (3.492, 8.525, 21.43, 27.33, 31.11, 54.44),
    ),
    "leissa-two-edges": Benchmark(
        "thin square plate, two edges clamped", THIN, ("x0", "y0"), "Leissa 1973", COEFFICIENT,
        (6.919, 23.90, 26.58, 47.65, 62.71, 65.53), (6.942, 24.03, 26.68, 47.79, 63.04, 65.83),
    ),
}  # fmt: skip


def loaded(kind: str, *models: str) -> Iterator[Row]:
    """Yield deflections of models with edges of a kind, "hinged" or "clamped"."""
    published, sources = LOADED[kind]
    values = {ratio: (value,) for ratio, value in published.items()}
    meshes = {model: MESH.format(model) for model in models}

    def answer(model: str, ratio: float, elements: int) -> np.ndarray:
        return np.array([deflection(model, kind, ratio, elements)])

    yield from curve(("w D/qL⁴ at h/L = {:g}",), meshes, values, sources, 3e-3, answer, ELEMENTS)


def locking(model: str) -> Iterator[Row]:
    """Yield rows of a model, thin to thick; the expected value is the finer mesh's answer."""
    sweep = SWEEPS[model]
    source, mesh = f"{OURS}, {sweep.finer} × {sweep.finer}", f"{model} {FIXED} × {FIXED}"
    for poisson, ratio in product(sweep.poissons, sweep.ratios):
        fixed, converged = (deflection(model, "clamped", ratio, n, poisson) for n in (FIXED, sweep.finer))
        quantity = f"w D/qL⁴ at h/a = {ratio:g}, ν = {poisson:g}"
        yield relative_row(quantity, mesh, converged, source, fixed, sweep.tolerance)


def deflection(model: str, kind: str, ratio: float, elements: int, poisson: float = 0.3) -> float:
    """Return w D/(q L⁴) at the centre, D the thin plate's; kind: "hinged" (twist held) or "clamped"."""
    material = Material(young=1e7, poisson=poisson, density=1000.0)
    rigidity = section_of(material, ratio).bending[0, 0]
    load = SMALL * ratio * rigidity / CLAMPED[0.001]
    edges = supports(Hinged, twist="held") if kind == "hinged" else supports(Clamped)
    scene = specimen(Sheet(1.0, 1.0, ratio), material, edges, load)
    return float(u_at(scene, (0.5, 0.5), model, elements)[2]) * rigidity / load


def frequencies(benchmark: Benchmark) -> Iterator[Row]:
    """Yield six modes of every model of one of `BENCHMARKS`."""
    _, sheet, edges, source, unit, converged, bounds, models = benchmark
    scene, scale = specimen(sheet, STEEL, supports(Clamped, edges)), 1.0
    if unit == COEFFICIENT:
        rigidity = section_of(STEEL, sheet.thickness).bending[0, 0]
        scale = 2.0 * np.pi * sheet.length_x**2 * np.sqrt(STEEL.density * sheet.thickness / rigidity)
    for model in models:
        coarse, fine = (scale * modes(scene, model, n, 6).frequencies for n in (ELEMENTS // 2, ELEMENTS))
        mesh, own_source = MESH.format(model), f"{OURS}, finer mesh"
        yield from lowest(f"mode {{}} [{unit}], converged", mesh, converged, own_source, fine, CONVERGED)
        yield from lowest(f"mode {{}} [{unit}], bound", mesh, bounds, source, fine, BOUND)
        yield mesh_change(mesh, coarse, fine, CONVERGED)


def fibres(layers: tuple[Layer, ...], outer: float, source: str) -> Iterator[Row]:
    """Yield w D22/(q a⁴) in the middle of plate and shell, and their first six frequencies [Hz]. The shell's
    load is so small that it is linear."""
    moment, determinant = THIN.thickness**3 / 12.0, 1.0 - NU**2 * E2 / E1
    mixed = moment * (NU * E2 / determinant + 2.0 * G)
    along, across = (moment * (a * E1 + (1.0 - a) * E2) / determinant for a in (outer, 1.0 - outer))

    def delta(m: int, n: int) -> float:
        return along * m**4 + 2.0 * mixed * m**2 * n**2 + across * n**4

    odd = product(range(1, 80, 2), repeat=2)
    unit = 16.0 / pi**6 * sum(sin(m * pi / 2) * sin(n * pi / 2) / (m * n * delta(m, n)) for m, n in odd)
    load, inertia = SMALL * THIN.thickness / unit, FIBRES.density * THIN.thickness
    exact = sorted(0.5 * pi * sqrt(delta(*mn) / inertia) for mn in product(range(1, 12), repeat=2))[:6]
    scene = specimen(THIN, FIBRES, supports(Hinged, twist="held"), load, layers=layers)
    for model in ("plate", "shell"):
        mesh, middle = MESH.format(model), float(u_at(scene, (0.5, 0.5), model, ELEMENTS)[2])
        yield relative_row("w D22/qa⁴", mesh, unit * across, source, middle / load * across, 5e-3)
        computed = modes(scene, model, ELEMENTS, count=6).frequencies
        yield from lowest("mode {} [Hz]", mesh, exact, "Leissa 1969", computed, 1e-2)


def self_bending() -> Iterator[Row]:
    """Yield a cantilever's quarter turn, a heated plate's buckling, a stretched plate's frequency."""
    length, h, poisson, kirchhoff = 0.2, 0.002, 0.3, "Kirchhoff's plate"
    material, hinges = Material(young=1e6, poisson=poisson, density=1e3), supports(Hinged)
    k, mesh, half = 0.5 * np.pi / length, "16 × 8", 0.5 * length
    curled = Natural(curvature=(k, 0.0, 0.0))
    scene = specimen(Sheet(length, half, h), material, (Clamped(edge="x0"),), natural=curled)
    tip = u_at(scene, (length, 0.5 * half), "shell", (16, 8))
    for name, exact, computed in (("ux", 1.0 / k - length, tip[0]), ("uz", 1.0 / k, tip[2])):
        yield relative_row(f"{name} of the tip of a quarter turn [m]", mesh, exact, EXACT, computed, 1e-6)
    strain = np.pi**2 * h**2 / (6.0 * (1.0 + poisson) * length**2)
    hot = Natural(strain=(strain, strain, 0.0))
    heated = specimen(Sheet(length, length, h), material, hinges, natural=hot)
    computed = buckling(heated, "shell", 12).load_factors[0] * strain
    yield relative_row("strain that buckles a heated plate", "12 × 12", strain, kirchhoff, computed, 0.012)
    h, tension, q = h / 8.0, 0.05, 2.0 * np.pi**2 / length**2
    pulled = Natural(pretension=(tension, tension))
    stretched = specimen(Sheet(length, length, h), material, hinges, natural=pulled)
    rigidity = section_of(material, h).bending[0, 0]
    exact = np.sqrt((rigidity * q**2 + tension * q) / (material.density * h)) / (2.0 * np.pi)
    computed = modes(stretched, "shell", 8, 1, about="deformed").frequencies[0]
    yield relative_row("frequency of a stretched plate [Hz]", "8 × 8", exact, kirchhoff, computed, 1e-3)
