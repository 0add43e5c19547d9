"""Where each solver holds, degrades, refuses or breaks: studies of cells, their maps, tables and texts."""

from comparisons.stability.rows import Row
from studies.stability.studies import STUDIES
from studies.stability.study import Study
from studies.stability.survey import survey

__all__ = ["STUDIES", "Row", "Study", "survey"]
