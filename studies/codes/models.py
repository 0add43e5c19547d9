"""Our models and other people's programs in this process, on the reference set: errors and median times.

Their ladders of sizes on test 1 are files of results beside those of the trials; where they stand on a
whole suite is kept in the set's own file, for `score` to compare answers with. What is not installed keeps
its rows.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from comparisons.models.spec import Elements, External, Lattice, Spec, spec_of
from comparisons.scoring.reference import FILE, Reference, document, references
from comparisons.sweep import task
from comparisons.sweep.differences import error
from comparisons.sweep.solved import Ask, Solved
from sheetbench.answers.files import plain, to_json, write_text
from sheetbench.errors import BadInput, require_choice
from studies.codes.results import CASES, SCENES, Trial, write_results

REPEATS = 3
LADDERS: dict[str, tuple[str, str, tuple[Spec, ...]]] = {  # title, licence, models
    "lattice": ("sheetbench, lattice", "MIT", tuple(Lattice(n) for n in (3, 5, 9, 17, 33))),
    "oblique": (
        "sheetbench, lattice with oblique shear",
        "MIT",
        tuple(Lattice(n, "consistent-oblique") for n in (5, 9, 17)),
    ),
    "shell": ("sheetbench, shell", "MIT", tuple(Elements("shell", n) for n in (4, 8, 12, 16))),
    "solid": ("sheetbench, solid", "MIT", tuple(Elements("solid", n) for n in (4, 8))),
    **{
        code: (title, licence, tuple(External(code, {"elements": n}) for n in sizes))
        for code, title, licence, sizes in (
            ("kratos", "Kratos, thin shell", "BSD-4-Clause", (8, 16, 32)),
            ("calculix", "CalculiX, 20-node bricks", "GPL-2.0", (4, 6, 8, 12)),
            ("felupe", "FElupe, 20-node bricks", "GPL-3.0", (4, 6, 8)),
        )
    },
}
STANDING = (
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
    """Return the error of a model on a case, and its median time."""
    ask = Ask(case.scene, candidate, REPEATS)
    found = task.solve(**ask.task.arguments)
    one = Solved(ask, found["status"], row=found)
    return {
        "case": case.name,
        "model": candidate.model,
        "settings": candidate.settings,
        "status": one.status,
        "error": error(one.u, case.values) if one.usable else None,
        "seconds": one.seconds if one.usable else None,
    }


def climb(code: str, say: Callable[[str], None]) -> None:
    """Measure a ladder of sizes on test 1, and write its file of results."""
    title, licence, models = LADDERS[code]
    rows = []
    for candidate in models:
        size = next(value for key, value in candidate.settings.items() if key in ("grid", "elements"))
        recipe = f"{size} × {size}" if isinstance(size, int) else " × ".join(map(str, size[:2]))
        found = row(CASES[SCENES[0]], candidate)
        say(f"{title}, {recipe}: {found['status']}, {found['error']}")
        rows.append(
            Trial(SCENES[0], recipe, candidate.model, *(found[k] for k in ("status", "error", "seconds")))
        )
    write_results(code, title, licence, rows, f"--ladder {code}")


def stand(names: Sequence[str], say: Callable[[str], None], suite: str = "statics") -> None:
    """Measure models by name on a suite, and put the rows into the set's file; those of other suites stay.
    Raises BadInput for an unknown model."""
    known = {str(candidate): candidate for candidate in (*STANDING, *SLOW)}
    for name in names:
        require_choice("model", name, known)
    rows: dict[str, list[dict[str, Any]]] = {}
    for kept in document()["standing"]:
        rows.setdefault(str(spec_of(kept["model"], kept["settings"])), []).append(kept)
    for name in names or map(str, STANDING):
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
