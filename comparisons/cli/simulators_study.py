"""`python -m comparisons.cli.simulators_study --out DIR`: other simulators with what we export for them."""

from __future__ import annotations

import argparse

from comparisons.cli.finish import finish
from comparisons.simulators.study import study


def main() -> None:
    """Carry out the study and show it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", default="simulators")
    asked = parser.parse_args()
    with finish("simulators", False, asked.out) as end:
        end(study(end.progress))


if __name__ == "__main__":
    main()
