"""`python -m comparisons.cli.advisor_study --out DIR`: the advisor on scenes drawn at random, resumable."""

from __future__ import annotations

import argparse
import os

from comparisons.advice.validation import study
from comparisons.cli.finish import finish


def main() -> None:
    """Carry out the study and show it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", default="advisor-study")
    parser.add_argument("--scenes", type=int, default=60)
    parser.add_argument("--compared", type=int, default=20)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    asked = parser.parse_args()
    with finish("advisor-study", False, asked.out) as end:
        with end.campaign() as (store, _, progress):
            found = study(store, asked.scenes, asked.compared, workers=asked.workers, progress=progress)
        end(found.report())


if __name__ == "__main__":
    main()
