"""The studies by name."""

from __future__ import annotations

from studies.stability import (
    curved_edge,
    damping,
    grid,
    load,
    mass,
    slenderness,
    stiffness,
    time_step,
)
from studies.stability.study import Study

STUDIES: dict[str, Study] = {
    module.STUDY.name: module.STUDY
    for module in (time_step, stiffness, slenderness, grid, load, damping, mass, curved_edge)
}
