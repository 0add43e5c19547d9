"""Default models of a trade-off, for the command and the function; lists as text."""

from sheetbench.choices import CALIBRATION

GRIDS = "3,5,9,17,33"
MESHES = {"plate": "8", "shell": "2,4,8,12,16", "solid": "2,4,8"}
MOVING = {"shell": "2,4,8", "solid": "2,4"}  # in place of these, with a duration
SPRINGS = f"{CALIBRATION},uniform"
REPEATS = 5
