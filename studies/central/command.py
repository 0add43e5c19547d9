"""`sheetbench study central`: the numbers of the calibration `central`, trained anew."""

from __future__ import annotations

from pathlib import Path

import lumped
from comparisons.cli import console
from sheetbench.answers.files import write_text
from studies.central.training import POISSON, trained

HEAD = '''\
"""The moduli of the calibration `central` by Poisson's ratio: `make central` finds and writes them.

ν, then a, b, c with D11 = a D, D12 = D66 = b D, A11 = c A, A12 = A66 = (b/a) c A, D and A the sheet's own;
the worst error that a sheet of these moduli makes on the training scenes that bend, on those that stretch,
and that of `cauchy` on those that bend. Trained on: `studies.central.training`.
"""

ROWS = (
'''


def command() -> None:
    """Train the calibration central, and write its table, lumped/calibration/central_table.py."""

    rows = (f"    ({', '.join(map(str, trained(poisson).numbers))}),\n" for poisson in POISSON)
    table = Path(lumped.__file__).parent / "calibration" / "central_table.py"
    write_text(table, HEAD + "".join(rows) + ")\n")
    console.tell(f"{table}: written")
