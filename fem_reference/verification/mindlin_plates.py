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

from fem_reference.surface.materials import bending_stiffness
from fem_reference.verification.rows import OURS, Row, curve, relatively
from fem_reference.verification.specimens import around, moved, specimen
from sheetbench.scenes import EDGES, Clamped, Hinged, Material, Sheet

TOLERANCE = 3e-3
ELEMENTS = 16
HARD_SIMPLE = {0.001: 0.00406, 0.1: 0.00427, 0.2: 0.00490}
CLAMPED = {0.001: 0.0012653, 0.1: 0.001505, 0.2: 0.002172}
FINER = f"{OURS}, 48 × 48"
SOURCES = {
    "hinged": dict.fromkeys(HARD_SIMPLE, "Wang, Reddy & Lee 2000"),
    "clamped": {0.001: "Taylor & Govindjee 2004", 0.1: FINER, 0.2: FINER},
}
FIXED = 8  # elements of what may lock
THICK = (1e-3, 1e-2, 0.05, 0.1, 0.2)
SWEEPS = {  # elements of the finer mesh, tolerance, h/L and ν
    "plate": (24, 2e-2, (1e-5, 1e-4, *THICK), (0.3,)),
    "shell": (24, 2e-2, (1e-5, 1e-4, *THICK), (0.3,)),
    "solid": (16, 1e-2, THICK, (0.3, 0.48, 0.499, 0.4999)),
}
SMALL = 1e-4  # the shell's deflection at the centre over the thickness


def rows(kind: str, *models: str) -> Iterator[Row]:
    """The models with edges of a kind, "hinged" or "clamped"."""
    published = HARD_SIMPLE if kind == "hinged" else CLAMPED
    values = {ratio: (value,) for ratio, value in published.items()}
    for model in models:
        mesh = f"{model} {ELEMENTS} × {ELEMENTS}"

        def answer(ratio: float, elements: int, model: str = model) -> np.ndarray:
            return np.array([deflection(model, kind, ratio, elements)])

        names = ("w D/qL⁴ at h/L = {:g}",)
        yield from curve(names, mesh, values, SOURCES[kind], TOLERANCE, answer, ELEMENTS)


def locking(model: str) -> Iterator[Row]:
    """Rows of a model, thin to thick; what is expected is the finer mesh's answer."""
    finer, tolerance, ratios, poissons = SWEEPS[model]
    source, mesh = f"{OURS}, {finer} × {finer}", f"{model} {FIXED} × {FIXED}"
    for poisson in poissons:
        for ratio in ratios:
            fixed, converged = (deflection(model, "clamped", ratio, n, poisson) for n in (FIXED, finer))
            quantity = f"w D/qL⁴ at h/a = {ratio:g}, ν = {poisson:g}"
            yield relatively(quantity, mesh, converged, source, fixed, tolerance)


def deflection(model: str, kind: str, ratio: float, elements: int, poisson: float = 0.3) -> float:
    """w D/(q L⁴) at the centre, D the thin plate's; kind: "hinged" is hard (plate only), or "clamped"."""
    material = Material(young=1e7, poisson=poisson, density=1000.0)
    rigidity = bending_stiffness(material, ratio)[0, 0]
    load = SMALL * ratio * rigidity / CLAMPED[0.001]
    scene = specimen(Sheet(1.0, 1.0, ratio), material, around(Hinged if kind == "hinged" else Clamped), load)
    hard: dict[str, Any] = {"hard_edges": tuple(EDGES)} if kind == "hinged" else {}
    return float(moved(scene, (0.5, 0.5), model, elements, **hard)[2] * rigidity / load)
