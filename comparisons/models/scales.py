"""Dimensionless numbers of a scene: slenderness, load and strain.

    slenderness   h/a, a the shorter side
    load number   q a³/D, q the load per area (weight; other loads averaged over the whole sheet) and
                  D = E h³/12(1 − ν²); the slope of a strip clamped at one end is about a sixth of it [rad]
    strain        q a/(E h), stretch of a strip under the load along it
    normal load   part of q that bends a flat sheet: its normal component, pressure and moments
    span          L, length of the sheet across the edges that hold it along its normal; the shorter side if
                  edges in both directions hold it, or none

The moduli report of a calibration compares the lattice's stiffness with the sheet's.
"""

from dataclasses import dataclass

import numpy as np

from sheetbench.scenes import EDGES, EdgeLoad, Scene
from sheetbench.scenes.meaning.composition import weights
from sheetbench.scenes.meaning.region import area_in, edge_length, resultant
from sheetbench.scenes.objects.supports import held_axes, place


@dataclass(frozen=True)
class Scales:
    """Dimensionless numbers of a scene; load, normal_load [Pa]; span [m]; span_load_number: q L³/D."""

    slenderness: float
    load: float
    load_number: float
    strain: float
    normal_load: float
    span: float
    span_load_number: float

    @property
    def bending_number(self) -> float:
        """Load number of the normal load."""
        return self.load_number * self.normal_load / self.load if self.load > 0.0 else 0.0

    def as_dict(self) -> dict[str, float]:
        """Return the fields as JSON data."""
        return dict(vars(self))


def scales(scene: Scene) -> Scales:
    """Return the scales of a scene."""
    sheet, material = scene.sheet, scene.material
    reach = span(scene)
    side, area = min(sheet.lengths), area_in(scene, None)
    rigidity = material.young * sheet.thickness**3 / (12.0 * (1.0 - material.poisson**2))
    load = normal = 0.0
    if scene.gravity is not None:
        per_area = material.density * sheet.thickness * np.asarray(scene.gravity.last_acceleration)
        load, normal = float(np.linalg.norm(per_area)), abs(float(per_area[2]))
    for acting in (*scene.loads, *weights(scene)):
        factor = abs(acting.last_factor)
        force = factor * resultant(scene, acting) / area
        if isinstance(acting, EdgeLoad):
            length = edge_length(scene, acting.edge, acting.where)
            turning = factor * abs(acting.moment_per_length) * length / area / side
            load, normal = load + turning, normal + turning
        load, normal = load + float(np.linalg.norm(force)), normal + abs(float(force[2]))
    return Scales(
        slenderness=sheet.thickness / side,
        load=load,
        load_number=load * side**3 / rigidity,
        strain=load * side / (material.young * sheet.thickness),
        normal_load=normal,
        span=reach,
        span_load_number=load * reach**3 / rigidity,
    )


def span(scene: Scene) -> float:
    """Return the sheet's length across the edges that hold it along its normal [m]."""
    sheet, across = scene.sheet, 2
    on_edges = [support for support in scene.supports if place(support) is None]
    held = [support.edge for support in on_edges if across in held_axes(support)]
    held += [actuator.edge for actuator in scene.actuators]
    return min((sheet.lengths[EDGES[edge].normal_axis] for edge in held), default=min(sheet.lengths))
