"""`python -m comparisons.cli.central_table`: the numbers of the calibration `central`, trained anew."""

from __future__ import annotations

import sys
from pathlib import Path

import lumped
from comparisons.calibration.central_training import POISSON, trained
from comparisons.report.files import write_text

HEAD = '''\
"""The moduli of the calibration `central` by Poisson's ratio: `make central` finds and writes them.

ν, then a, b, c with D11 = a D, D12 = D66 = b D, A11 = c A, A12 = A66 = (b/a) c A, D and A the sheet's own;
the worst error that a sheet of these moduli makes on the training scenes that bend, on those that stretch,
and that of `cauchy` on those that bend. Trained on: `comparisons.calibration.central_training`.
"""

ROWS = (
'''


def main() -> None:
    """Train, and write the table."""
    rows = (f"    ({', '.join(map(str, trained(poisson).numbers))}),\n" for poisson in POISSON)
    table = Path(lumped.__file__).parent / "calibration" / "central_table.py"
    write_text(table, HEAD + "".join(rows) + ")\n")
    print(f"{table}: written", file=sys.stderr)


if __name__ == "__main__":
    main()
