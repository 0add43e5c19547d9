"""Where each solver holds, degrades, refuses or breaks: studies of cells, their maps, tables and texts."""

from comparisons.stability.studies import STUDIES
from comparisons.stability.study import Row, Study
from comparisons.stability.survey import survey

__all__ = ["STUDIES", "Row", "Study", "survey"]
