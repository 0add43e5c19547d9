"""Where models stand on the statics of the set: `python -m comparisons.suite.standing [MODEL …]`.

Our own models, and other people's programs as plug-ins: what each gets wrong on every case, and its time. It
writes these rows into the set's file and leaves its values alone (`make standing`). Models as `tradeoff
--model` has them ("mujoco:grid=9"), all of `STANDING` unless named, those of `SLOW` only where named; what is
not installed keeps its rows.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from typing import Any

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.models import registry
from comparisons.models.candidate import Candidate, written
from comparisons.report.files import plain, to_json, write_text
from comparisons.suite.reference import FILE, Reference, document, references
from sheetbench.scenes.errors import BadInput, require_choice

REPEATS = 3
STANDING = (
    *(Candidate("lumped", {"grid": n, "calibration": "consistent"}) for n in (5, 9, 17)),
    *(
        Candidate("lumped", {"grid": 9, "calibration": c})
        for c in ("consistent-membrane", "central", "uniform")
    ),
    Candidate("plate", {"elements": 16}),
    Candidate("shell", {"elements": 4}),
    Candidate("shell", {"elements": 8}),
    Candidate("mujoco", {"grid": 9}),
    Candidate("mujoco", {"grid": 17}),
    Candidate("kratos", {"elements": 16}),
    Candidate("calculix", {"elements": 4}),
)
SLOW = (Candidate("felupe", {"elements": 4}),)  # minutes


def standing(case: Reference, candidate: Candidate) -> dict[str, Any]:
    """What a model gets wrong on a case, and its median time."""
    answers = [registry.solve(case.scene, candidate.model, **candidate.settings) for _ in range(REPEATS)]
    found = answers[-1]
    off = error(found.displacement(case.scene.probe_points()), case.values) if found.comparable else None
    return {
        "case": case.name,
        "model": candidate.model,
        "settings": candidate.settings,
        "status": str(found.status),
        "error": off,
        "seconds": float(np.median([answer.solve_seconds for answer in answers]))
        if found.comparable
        else None,
    }


def measured(candidate: Candidate) -> Iterator[dict[str, Any]]:
    """Its rows over the statics, none where it is not installed."""
    for case in references("statics").values():
        try:
            yield standing(case, candidate)
        except BadInput as missing:
            print(f"{written(candidate)}: {missing}", file=sys.stderr)
            return


def main(names: list[str]) -> None:
    """Measure, and put the rows into the file."""
    known = {written(candidate): candidate for candidate in (*STANDING, *SLOW)}
    for name in names:
        require_choice("model", name, known)
    rows: dict[str, list[dict[str, Any]]] = {}
    for row in document()["standing"]:
        rows.setdefault(written(Candidate(row["model"], row["settings"])), []).append(row)
    for name in names or map(written, STANDING):
        if found := list(measured(known[name])):
            rows[name] = found
            kept = [row for name in known for row in rows.get(name, [])]
            write_text(FILE, to_json(plain({**document(), "standing": kept})))
            print(name, file=sys.stderr)


if __name__ == "__main__":
    main(sys.argv[1:])
