"""Boundary layers of a bent sheet, their widths estimated before a solve.

bent edge   a sheet clamped to a rod (or a chain) of curvature κ stretches within
            δ = √(h/κ)/(12 (1 − ν²))^¼ of it (e.g. Calladine, Theory of Shell Structures, 1983)
load        q per area along the normal bends the sheet within δ = (D/q)^⅓ of a clamp,
            D = E h³/12(1 − ν²): the length in which a heavy elastica turns; loads in a flat sheet's plane
            make no layer
"""

from dataclasses import dataclass

import numpy as np

from comparisons.models.scales import scales
from sheetbench.scenes import Chain, Curved, Scene


@dataclass(frozen=True, order=True)
class Layer:
    """A boundary layer; width [m]; cause: in words; bent_edge: whether a bent edge, not the load, causes
    it."""

    width: float
    cause: str
    bent_edge: bool

    def __str__(self) -> str:
        return f"{self.cause} within {1e3 * self.width:.3g} mm of the edge"


def layers(scene: Scene) -> list[Layer]:
    """Return the boundary layers of a scene: one for every bent edge, one for its load."""
    sheet, material, numbers = scene.sheet, scene.material, scales(scene)
    out = []
    bends = [(s.edge, s.curvature) for s in scene.supports if isinstance(s, Curved)]
    bends += [(a.edge, _curvature(a)) for a in scene.actuators if isinstance(a, Chain)]
    for edge, curvature in bends:
        if curvature:
            width = np.sqrt(sheet.thickness / abs(curvature)) / (12.0 * (1.0 - material.poisson**2)) ** 0.25
            cause = f"edge {edge}, bent by {curvature:g} 1/m, stretches the sheet"
            out.append(Layer(float(width), cause, bent_edge=True))
    if numbers.bending_number > 0.0:  # a load of 1e-320 Pa underflows to 0
        width = min(sheet.lengths) * numbers.bending_number ** (-1.0 / 3.0)
        cause = f"the load of {numbers.normal_load:.3g} Pa bends the sheet"
        out.append(Layer(width, cause, bent_edge=False))
    return out


def _curvature(chain: Chain) -> float:
    """Return a chain's final commanded curvature of largest magnitude [1/m]."""
    command = chain.curvature
    values = np.atleast_1d(command if isinstance(command, float | tuple) else command.value[-1])
    return float(values[np.argmax(np.abs(values))])
