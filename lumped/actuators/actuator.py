"""What drives actuators, and what acts between them and the sheet.

A prescribed motion puts masses where they have to be, and what holds them there is found from the sheet. A
chain has a state of its own. It brings rows of displacement, (rows, 3) [m], which only it understands, and
binds masses of the edge to them: the displacement of bound mass i is binding[i] @ rows. The sheet's equations
never see more; equal and opposite forces follow, because one transpose of `binding` carries the masses'
forces to the chain. Its forces derive from a Lagrangian: multiplier rows enter like any other row, with the
constraint's residual as their force.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Drive:
    """How far commands are: a share of their last value (statics), or, with a time [s], their value then."""

    load_factor: float = 1.0
    time: float | None = None


@dataclass(frozen=True)
class Acting:
    """What acts between an actuator and the sheet: where its masses are (m, 3) [m], what holds them (m, 3)
    and its rows (rows, 3) [N], and its rows' displacement y (rows, 3) [m]."""

    positions: np.ndarray
    on_masses: np.ndarray
    on_rows: np.ndarray
    y: np.ndarray
