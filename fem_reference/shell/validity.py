"""Validity of a shell's answer: elements turned inside out or stretched, strains too large.

inverted   (φ,r × φ,s) · d, positive in the flat sheet, has reached zero at a Gauss point.
strained   the mid-surface stretched, or the sheet too heavy, for a linear law (`scenes.outside_model`).
stretched  In an element of sides b ≥ l the membrane shear's assumed strains do not see a motion v along b
           that goes like P₂(2y/b) across it. It changes along l at the cost of the stretch along b alone, so
           that the bending moment M = D κ along l, doing work 2 M v,x ψ,x with the director's turn ψ, may
           outweigh what resists both, the more the larger

               (h κ/2) (b/l)²:

           elements may lose stability, not the sheet. One-edge-clamped sheets of h/a from 0.01 to 0.1 on
           graded meshes with b/l from 10 to 20 lose it from 19 on, none below; with the twist projected like
           the membrane shear, which leaves ψ as free as v, from 9 on. Above 5 the stability of the tangent is
           checked. Only where it is lost is the sheet divided evenly, b/l = 1, which is stable at any strain
           of the model.
"""

import numpy as np

from fem_reference.discrete.answer import last_fault, shape_of
from fem_reference.discrete.static import Forces, StaticState
from fem_reference.shell.element import BENDING, MEMBRANE, Element
from fem_reference.surface.biquadratic import AT_GAUSS
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault, Path
from sheetbench.numerics.continuation.stability import stability

STRETCH_LIMIT = 5.0
STRETCHED = Fault(Status.UNSTABLE, "elements are too long for the bending: use elements of one size")
FLAT = 1e-6  # share of the element's area in the flat sheet below which it counts as turned inside out


def stretched(path: Path[StaticState, Forces]) -> Fault | None:
    """Return the fault that rejects a step of a path; stretched elements count only if unstable."""
    shape = shape_of(path)
    element, thickness = shape.sheet.element, shape.sheet.scene.sheet.thickness
    fault = last_fault(path)
    if fault is not None or stretch(element, shape.strain, thickness) <= STRETCH_LIMIT:
        return fault
    return STRETCHED if stability(path)[0] is not Status.CONVERGED else None


def inverted(element: Element, change: np.ndarray) -> str:
    """Return a sentence on the element that is turned inside out most, by a change (m, 18, 3), or ""."""
    value, slope = AT_GAUSS
    current = element.reference + change
    along, across, director = slope[0] @ current[:, :9], slope[1] @ current[:, :9], value @ current[:, 9:]
    area = (np.cross(along, across) * director).sum(axis=2)
    share = (area / element.flat_jacobian).min(axis=1)
    worst = int(np.argmin(share))
    if share[worst] > FLAT:
        return ""
    x, y = element.reference[worst, 8, :2]
    return f"the element at x = {x:.4g} m, y = {y:.4g} m has turned inside out: use more elements"


def stretch(element: Element, strain: np.ndarray, thickness: float) -> float:
    """Return the largest (h κ/2) (b/l)² of strains (m, 54), κ along an element's shorter side."""
    sides, bent = element.sides, np.abs(_along(strain[:, BENDING])).max(axis=2)
    surface = 0.5 * thickness * bent / (0.5 * sides) ** 2
    return float(np.max(surface * (sides[:, ::-1] / sides) ** 2))


def membrane_strain(element: Element, strain: np.ndarray) -> float:
    """Return the mid-surface's largest stretching √(1 + 2 E) − 1 along elements' sides, of strains (m,
    54)."""
    green = _along(strain[:, MEMBRANE]).mean(axis=2) / (0.5 * element.sides) ** 2
    return float(np.max(np.abs(np.sqrt(np.maximum(1.0 + 2.0 * green, 0.0)) - 1.0)))


def _along(samples: np.ndarray) -> np.ndarray:
    """Return the samples along r and along s, (m, 2, 6), of samples (m, 21)."""
    return samples[:, :12].reshape(-1, 2, 6)
