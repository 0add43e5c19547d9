"""Order of the shell under large rotations: a strip rolled into half a circle by an end moment.

Exactly known, and nothing is singular: the tip is as good as the energy, order 4, twice that of the strains.
The strip is so thin that its stretch, (h/R)²/12, is below 1e-9.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from fem_reference.verification import roll_up
from fem_reference.verification.rows import EXACT, THEORY, Row, absolutely

ORDER, SLACK = 4.0, 0.15
THICKNESS = 1e-3
LARGEST = 5e-5  # error on the finest mesh, of the length
ELEMENTS = (8, 16)
SHARE = 0.5


def rows(case: str) -> Iterator[Row]:
    """Error of the tip on the finest mesh, and the order of the last refinement."""
    exact = roll_up.closed_form(SHARE)
    coarse, fine = (
        np.abs(roll_up.rolled(SHARE, n, THICKNESS) - exact).max() / roll_up.LENGTH for n in ELEMENTS
    )
    mesh = f"shell {ELEMENTS[-1]} × 1"
    yield absolutely(case, "error of the tip over the length", mesh, 0.0, EXACT, fine, LARGEST)
    yield absolutely(case, "order of the tip", mesh, ORDER, THEORY, np.log2(coarse / fine), SLACK)
