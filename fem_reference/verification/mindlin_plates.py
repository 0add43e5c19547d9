"""Square Mindlin plates under a uniform load, ν 0.3, shear correction 5/6: w D/(q L⁴) at the centre.

Hard simple support (deflection and the tilt along the edge held) and clamped, h/L 0.001 to 0.2. The shell
answers for the clamped ones under a load so small that it is linear.
Sources: Navier's series in Wang, Reddy & Lee, Shear Deformable Beams and Plates (2000); for the thin clamped
plate Taylor & Govindjee, Solution of clamped rectangular plate problems, Commun. Numer. Meth. Engng 20 (2004)
757–765, report UCB/SEMM-2002/09: 0.00126532. The thick clamped plates have no closed form: theirs is this
project's plate on 48 × 48 elements.

Locking: a model that locks answers with a fraction of the deflection. On fixed 8 × 8 meshes each answer
stands beside the same model's on a mesh that is two or three times finer, which is converged to 0.1 % and
better. The plate and the shell go from h/L = 1e-5 to 0.2; so does the solid for ν up to 0.4999, from 1e-3:
below that its stiffness through the thickness, (L/h)² of that in bending and more as ν → ½, leaves no digits.
Both meshes of the solid have one layer, whose shear is a little stiff in a thick sheet: that is no locking.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from fem_reference import solve
from fem_reference.surface.materials import bending_stiffness
from fem_reference.verification.rows import OURS, Row, absolutely, relatively
from sheetbench.answers.solution import Status
from sheetbench.scenes import EDGES, Clamped, Gravity, Hinged, Material, Scene, Sheet

TOLERANCE = 3e-3
ELEMENTS = 16
HARD_SIMPLE = {0.001: 0.00406, 0.1: 0.00427, 0.2: 0.00490}
CLAMPED = {0.001: 0.0012653, 0.1: 0.001505, 0.2: 0.002172}
NAVIER = "Wang, Reddy & Lee 2000"
SERIES = "Taylor & Govindjee 2004"
FINER = f"{OURS}, 48 × 48"
SOURCES = {"hinged": dict.fromkeys(HARD_SIMPLE, NAVIER), "clamped": {0.001: SERIES, 0.1: FINER, 0.2: FINER}}
SUPPORTS: dict[str, type[Clamped | Hinged]] = {"clamped": Clamped, "hinged": Hinged}
FIXED = 8  # elements of what may lock
THICK = (1e-3, 1e-2, 0.05, 0.1, 0.2)
SWEEPS = {  # elements of the finer mesh, tolerance, h/L and ν
    "plate": (24, 2e-2, (1e-5, 1e-4, *THICK), (0.3,)),
    "shell": (24, 2e-2, (1e-5, 1e-4, *THICK), (0.3,)),
    "solid": (16, 1e-2, THICK, (0.3, 0.48, 0.499, 0.4999)),
}
SMALL = 1e-4  # the shell's deflection at the centre over the thickness


def simply_supported() -> Iterator[Row]:
    """The plate with hard simple supports."""
    yield from _of("plate", HARD_SIMPLE)


def clamped() -> Iterator[Row]:
    """The plate and the shell with clamped edges."""
    yield from _of("plate", CLAMPED)
    yield from _of("shell", CLAMPED)


def _of(model: str, published: dict[float, float]) -> Iterator[Row]:
    kind = "hinged" if published is HARD_SIMPLE else "clamped"
    mesh = f"{model} {ELEMENTS} × {ELEMENTS}"
    found = {}
    for ratio, value in published.items():
        found[ratio] = deflection(model, kind, ratio, ELEMENTS)
        yield relatively(
            f"w D/qL⁴ at h/L = {ratio:g}", mesh, value, SOURCES[kind][ratio], found[ratio], TOLERANCE
        )
    ratio = max(published)
    change = abs(deflection(model, kind, ratio, ELEMENTS // 2) / found[ratio] - 1.0)
    yield absolutely(f"change from half the mesh, {ratio:g}", mesh, 0.0, OURS, change, TOLERANCE)


def locking(model: str) -> Iterator[Row]:
    """Rows of a model, thin to thick; what is expected is the finer mesh's answer."""
    finer, tolerance, ratios, poissons = SWEEPS[model]
    for poisson in poissons:
        for ratio in ratios:
            fixed, converged = (deflection(model, "clamped", ratio, n, poisson) for n in (FIXED, finer))
            quantity = f"w D/qL⁴ at h/a = {ratio:g}, ν = {poisson:g}"
            source, at = f"{OURS}, {finer} × {finer}", {"h/a": ratio, "ν": poisson}
            yield relatively(
                quantity, f"{model} {FIXED} × {FIXED}", converged, source, fixed, tolerance, at=at
            )


def deflection(model: str, kind: str, ratio: float, elements: int, poisson: float = 0.3) -> float:
    """w D/(q L⁴) at the centre, D the thin plate's; kind: "hinged" is hard (plate only), or "clamped"."""
    material = Material(young=1e7, poisson=poisson, density=1000.0)
    rigidity = bending_stiffness(material, ratio)[0, 0]
    load = SMALL * ratio * rigidity / CLAMPED[0.001]
    scene = Scene(
        name="square",
        sheet=Sheet(length_x=1.0, length_y=1.0, thickness=ratio),
        material=material,
        supports=tuple(SUPPORTS[kind].model_validate({"edge": edge}) for edge in EDGES),
        gravity=Gravity(acceleration=(0.0, 0.0, load / (material.density * ratio))),
    )
    hard: dict[str, Any] = {"hard_edges": tuple(EDGES)} if kind == "hinged" else {}
    solution = solve(scene, model, elements=elements, **hard)
    if solution.status is not Status.CONVERGED:
        return float("nan")
    return float(solution.displacement(np.array([[0.5, 0.5]]))[0, 2] * rigidity / load)
