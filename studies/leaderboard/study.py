"""Where models stand on statics and curves of the reference set: `sheetbench study leaderboard [MODEL …]`.

Our own models, and other people's programs as plug-ins: what each gets wrong on every case, and its time. It
writes these rows into the set's file and leaves its values alone (`make standing`). Models as `tradeoff
--model` has them ("mujoco:grid=9"), all of `STANDING` unless named, those of `SLOW` only where named; what is
not installed keeps its rows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Elements, External, Lattice, Spec, spec_of
from comparisons.scoring.reference import FILE, Reference, document, references
from sheetbench.answers.files import plain, to_json, write_text
from sheetbench.errors import BadInput, require_choice

REPEATS = 3
MODELS = (
    *(Lattice(n, "consistent") for n in (5, 9, 17)),
    *(Lattice(9, c) for c in ("consistent-membrane", "central", "uniform")),
    Elements("plate", 16),
    Elements("shell", 4),
    Elements("shell", 8),
    External("mujoco", {"grid": 9}),
    External("mujoco", {"grid": 17}),
    External("kratos", {"elements": 16}),
    External("calculix", {"elements": 4}),
)
SLOW = (External("felupe", {"elements": 4}),)  # minutes


def row(case: Reference, candidate: Spec) -> dict[str, Any]:
    """Return what a model gets wrong on a case, and its median time."""
    answers = [solve(resolve(case.scene, candidate)) for _ in range(REPEATS)]
    final = answers[-1]
    there = final.comparable
    return {
        "case": case.name,
        "model": candidate.model,
        "settings": candidate.settings,
        "status": str(final.status),
        "error": error(final.displacement(case.scene.probe_points()), case.values) if there else None,
        "seconds": float(np.median([answer.solve_seconds for answer in answers])) if there else None,
    }


def measure(names: Sequence[str], say: Callable[[str], None], suite: str = "statics") -> None:
    """Measure models by name on a suite, and put the rows into the set's file; those of other suites stay.
    Raises BadInput for an unknown model."""
    known = {str(candidate): candidate for candidate in (*MODELS, *SLOW)}
    for name in names:
        require_choice("model", name, known)
    rows: dict[str, list[dict[str, Any]]] = {}
    for kept in document()["standing"]:
        rows.setdefault(str(spec_of(kept["model"], kept["settings"])), []).append(kept)
    for name in names or map(str, MODELS):
        try:
            cases = references(suite)
            others = [kept for kept in rows.get(name, []) if kept["case"] not in cases]
            rows[name] = others + [row(case, known[name]) for case in cases.values()]
        except BadInput as missing:
            say(f"{name}: {missing}")
            continue
        leaderboard = [kept for name in known for kept in rows.get(name, [])]
        write_text(FILE, to_json(plain({**document(), "standing": leaderboard})))
        say(name)
