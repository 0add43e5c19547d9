"""Which mutants are tried: as many from each solver, drawn by a seed; the rest of a session is skipped.

Not drawn, since no run can tell them from the original: other operators between types in annotations, and a
compiled function left to the interpreter.
"""

from __future__ import annotations

import argparse
import random
from collections import defaultdict
from pathlib import Path

from cosmic_ray.work_db import WorkDB, use_db
from cosmic_ray.work_item import WorkerOutcome, WorkItem, WorkResult

SKIPPED = WorkResult(WorkerOutcome.SKIPPED, output="not drawn")


def can_be_told(item: WorkItem) -> bool:
    return not any(
        "BitOr" in mutation.operator_name or mutation.operator_name.endswith("RemoveDecorator")
        for mutation in item.mutations
    )


def drawn(items: list[WorkItem], size: int, seed: int) -> set[str]:
    """The identities of ``size`` mutants, shared evenly among the top packages."""
    packages = defaultdict(list)
    for item in sorted(items, key=lambda item: str(item.mutations)):
        packages[item.mutations[0].module_path.parts[0]].append(item.job_id)
    dice = random.Random(seed)
    share = -(-size // len(packages))
    return {job for jobs in packages.values() for job in dice.sample(jobs, min(share, len(jobs)))}


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("session", type=Path)
    asked.add_argument("--size", type=int, default=300)
    asked.add_argument("--seed", type=int, default=1)
    options = asked.parse_args()
    with use_db(str(options.session), WorkDB.Mode.open) as session:
        items = list(session.work_items)
        kept = drawn([item for item in items if can_be_told(item)], options.size, options.seed)
        session.set_multiple_results([item.job_id for item in items if item.job_id not in kept], SKIPPED)
    print(f"{len(kept)} of {len(items)} mutants are drawn")


if __name__ == "__main__":
    main()
