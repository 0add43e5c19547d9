"""Locking: a clamped square under a uniform load, on fixed 8 × 8 meshes as it gets thin or incompressible.

A model that locks answers with a fraction of the deflection. Each answer stands beside the same model's on a
mesh that is two or three times finer, which is converged to 0.1 % and better.

The plate and the shell go from h/a = 1e-5 to 0.2; so does the solid for ν up to 0.4999, from 1e-3: below that
its stiffness through the thickness, (a/h)² of that in bending and more as ν → ½, leaves no digits. Both
meshes of the solid have one layer, whose shear is a little stiff in a thick sheet: that is no locking.
"""

from __future__ import annotations

from collections.abc import Iterator

from fem_reference.verification.mindlin_plates import deflection
from fem_reference.verification.rows import OURS, Row, relatively

ELEMENTS = 8
FINER = {"plate": 24, "shell": 24, "solid": 16}
TOLERANCE = {"plate": 2e-2, "shell": 2e-2, "solid": 1e-2}
RATIOS = {
    "plate": (1e-5, 1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.2),
    "shell": (1e-5, 1e-4, 1e-3, 1e-2, 0.05, 0.1, 0.2),
    "solid": (1e-3, 1e-2, 0.05, 0.1, 0.2),
}
POISSON = {"plate": (0.3,), "shell": (0.3,), "solid": (0.3, 0.48, 0.499, 0.4999)}


def rows(model: str) -> Iterator[Row]:
    """Rows of a model, thin to thick; what is expected is the finer mesh's answer."""
    mesh = f"{model} {ELEMENTS} × {ELEMENTS}"
    for poisson in POISSON[model]:
        for ratio in RATIOS[model]:
            fixed, finer = (deflection(model, "clamped", ratio, n, poisson) for n in (ELEMENTS, FINER[model]))
            quantity = f"w D/qL⁴ at h/a = {ratio:g}, ν = {poisson:g}"
            source, at = f"{OURS}, {FINER[model]} × {FINER[model]}", {"h/a": ratio, "ν": poisson}
            yield relatively(quantity, mesh, finer, source, fixed, TOLERANCE[model], at=at)
