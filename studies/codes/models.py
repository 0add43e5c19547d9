"""Our models and other people's programs in this process, on the reference set: errors and median times.

Their ladders of sizes on test 1 are files of results beside the trials' files; their errors on a whole suite
are kept in the set's own file, for `score` to compare answers with. The rows of programs that are not
installed stay.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from comparisons.models.spec import Elements, External, Lattice, Spec, spec_of
from comparisons.scoring.reference import FILE, Reference, document, references
from comparisons.sweep import task
from comparisons.sweep.differences import error
from comparisons.sweep.solved import Request, Solved
from sheetbench.answers.files import plain, to_json, write_text
from sheetbench.errors import BadInput, require_choice
from studies.codes.results import CASES, SCENES, Trial, write_results

REPEATS = 3


class Sizes(NamedTuple):
    """A program's models by size."""

    title: str
    licence: str
    models: tuple[Spec, ...]


SIZES = {
    "lattice": Sizes("sheetbench, lattice", "MIT", tuple(Lattice(n) for n in (3, 5, 9, 17, 33))),
    "oblique": Sizes(
        "sheetbench, lattice with oblique shear",
        "MIT",
        tuple(Lattice(n, "consistent-oblique") for n in (5, 9, 17)),
    ),
    "shell": Sizes("sheetbench, shell", "MIT", tuple(Elements("shell", n) for n in (4, 8, 12, 16))),
    "solid": Sizes("sheetbench, solid", "MIT", tuple(Elements("solid", n) for n in (4, 8))),
    **{
        code: Sizes(title, licence, tuple(External(code, {"elements": n}) for n in sizes))
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
    request = Request(case.scene, candidate, REPEATS)
    result = task.solve(**request.task.arguments)
    solved = Solved(request, result["status"], row=result)
    return {
        "case": case.name,
        "model": candidate.model,
        "settings": candidate.settings,
        "status": solved.status,
        "error": error(solved.u, case.values) if solved.usable else None,
        "seconds": solved.seconds if solved.usable else None,
    }


def measure_sizes(code: str, progress: Callable[[str], None]) -> None:
    """Measure a program's models by size on test 1, and write its file of results."""
    sizes, rows = SIZES[code], []
    for candidate in sizes.models:
        size = next(value for key, value in candidate.settings.items() if key in ("grid", "elements"))
        recipe = f"{size} × {size}" if isinstance(size, int) else " × ".join(map(str, size[:2]))
        result = row(CASES[SCENES[0]], candidate)
        progress(f"{sizes.title}, {recipe}: {result['status']}, {result['error']}")
        rows.append(
            Trial(SCENES[0], recipe, candidate.model, *(result[k] for k in ("status", "error", "seconds")))
        )
    write_results(code, sizes.title, sizes.licence, rows, f"--ladder {code}")


def measure_models(names: Sequence[str], progress: Callable[[str], None], suite: str = "statics") -> None:
    """Measure models by name on a suite, and put the rows into the set's file; rows of other suites stay.
    Raises BadInput for an unknown model."""
    candidates = {str(candidate): candidate for candidate in (*STANDING, *SLOW)}
    for name in names:
        require_choice("model", name, candidates)
    rows: dict[str, list[dict[str, Any]]] = {}
    for stored in document()["standing"]:
        rows.setdefault(str(spec_of(stored["model"], stored["settings"])), []).append(stored)
    for name in names or map(str, STANDING):
        try:
            cases = references(suite)
            of_other_suites = [stored for stored in rows.get(name, []) if stored["case"] not in cases]
            rows[name] = of_other_suites + [row(case, candidates[name]) for case in cases.values()]
        except BadInput as missing:
            progress(f"{name}: {missing}")
            continue
        leaderboard = [stored for name in candidates for stored in rows.get(name, [])]
        write_text(FILE, to_json(plain({**document(), "standing": leaderboard})))
        progress(name)
