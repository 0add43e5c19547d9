"""`python -m comparisons.cli.peers_study --out DIR`: ours and other people's codes in one run."""

from __future__ import annotations

import argparse

from comparisons.cli.finish import finish
from comparisons.peers.study import QUESTIONS, study


def main() -> None:
    """Carry out the study and show it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", default="peers")
    parser.add_argument("--question", choices=QUESTIONS, action="append")
    asked = parser.parse_args()
    with finish("peers", False, asked.out) as end:
        end(study(asked.question or list(QUESTIONS), end.progress))


if __name__ == "__main__":
    main()
