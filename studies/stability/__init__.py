"""Where each solver holds, degrades, refuses or breaks: studies of cells, their maps, tables and texts."""

from studies.stability import curved_edge, damping, grid, load, mass, slenderness, stiffness, time_step
from studies.stability.survey import Study

STUDIES: dict[str, Study] = {
    module.STUDY.name: module.STUDY
    for module in (time_step, stiffness, slenderness, grid, load, damping, mass, curved_edge)
}
