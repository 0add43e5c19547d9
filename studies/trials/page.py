"""docs/results.md and its picture, of the files in studies/results."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from statistics import geometric_mean
from typing import Any

from comparisons.scoring.reference import VERSION
from studies.trials.study import CASES, OURS, RESULTS, SCENES, read_results

NO_BREAK = "\u00a0"  # between a number and its unit, where tables are narrow
DOCS = Path(__file__).parent.parent.parent / "docs"
TEXT = """\
# Results of other codes

Each code on those {count} statics of the [reference set](suite.md) and its {curves}
[curves](master-curves.md) that its triangles can have (not curved, tilted or sliding edges, chains, pressure
or moments along edges): with numbers that people use, and with those of
`sheetbench calibrate SCENE --for CODE` ([what they are](cells.md)). Meshes have 8 squares along the shorter
side, of curves 4, unless others are named. Error: the largest difference from the set's converged shell at
the probes, of the largest displacement; s: processor time of the run to rest. Every run is a process of its
own with a limit of processor time; one that crashes or does not come to rest says so in its place. "not run":
there was no time for it yet.

![Error against time of every code and recipe](images/results.png)

## Cantilever and test 1: in use and ours

{chosen}
`sheetbench study trials` prints this table from the stored rows and writes the page; `make trials` runs what
is missing.

## Findings

{findings}
## Who is nearest at which cost

{front}
{tables}
## Codes that were not run

SOFA, ArcSim, Codim-IPC, ppf-contact-solver and OpenUSD's proposal have no wheel that runs here. They get
files (`sheetbench calibrate SCENE --for sofa --out DIR`), which are read back: the law of their source,
with the file's numbers, is our energy of the same mesh (`tests/comparisons/codes/test_codes.py`). What
they cannot be follows from their [cells](cells.md).

## Running them

`make trials` makes an environment of pinned wheels for each code (`studies/trials/requirements-CODE.txt`; on
disk MuJoCo 0.2 GB, PyBullet 0.4, Newton with Warp 0.6, Genesis with PyTorch 4) and runs all of them, without
a network, on one thread. Rows of `studies/results` that had the same inputs stay as they are, and it goes on
where it was stopped: `make trials TRIED=mujoco ARGS='--budget 60'` is one code and a minute.
`sheetbench study trials CODE=PYTHON` takes an environment of your own, `--seconds` is the limit of a run.

## Adding a code

1. `sheetbench suite --out suite` writes the scenes and a form; or start from
   `sheetbench calibrate SCENE --for CODE --out DIR`.
2. `sheetbench score suite/answers-statics.csv` says how far your answers are off, and their place.
3. Write `studies/results/CODE.json` as those that are there: code, title, licence, date, machine, command,
   and a row for each scene and recipe (scene, recipe, mesh, status, error as a fraction, seconds).
4. `sheetbench study trials` writes this page anew, or says what is wrong with the file. Send both as a pull
   request; `make test` has its test (`tests/studies/results`).

A badge: `sheet-set {version}, two-edges-clamped: {badge}`.
"""
WHY = {  # what the numbers do not say by themselves; each with the command that shows it
    "mujoco": (
        "With the sheet's own E, ν and h a one-diagonal mesh twists too stiffly, and hinges on clamps bend "
        "half a square only: `sheetbench homogenise one-diagonal SCENE --hinge height`.",
        "Without `young` a flex has no stiffness at all: there is no default to try.",
    ),
    "newton": (
        "On a one-diagonal grid its hinges twist 4.6 times as stiffly as rubber of ν = 0.48 "
        "(`sheetbench homogenise one-diagonal two-edges-clamped --coefficient hinge=6.8`, D/l: "
        "(1 + √2)/2 where (1 − ν)/2 is asked, over D); alternate diagonals 2.7 times, and the best k is then "
        "60 % of D/l.",
        "VBD starts every step from free fall and does not arrive: with 10 iterations and steps of 3 times "
        "what a wave takes from vertex to vertex, *two-edges-clamped* rests at −17.8 mm, with 1.5 and 5 "
        "iterations at −15.1, with shorter and shorter steps at −13.4, where the shell has −13.5 "
        "(`STEPS`, `ITERATIONS` of `run_newton.py`).",
    ),
    "pybullet": (
        "Damping as in its examples (0.1 N·s/m) stops nothing within minutes. Damped along the springs by "
        "10 ms of their stiffness, which it takes implicitly, the sheet rests in seconds at steps of 1 ms: "
        "`run_pybullet.py` of `sheetbench calibrate SCENE --for pybullet`.",
        "Every vertex has the same mass, so that free rims weigh too much; a hinged edge holds both layers "
        "and so is clamped (*hinged-round*); and there is no force on a single vertex (*corner-force*).",
        "*thin* is 22 % off and *soft-two-edges* 41 % because 8 squares are too few: layers H apart in "
        "squares of side l resist shear by springs inclined by H/l, and in *thin* the weight turns over 39 % "
        "of them with 8 squares, 22 % with 16, 0.6 % with 24. The same springs, brought to rest by "
        "minimising their energy, are 29 % off with 16 squares and 0.5 % with 24. `sheetbench calibrate "
        "thin.toml --for pybullet` (the scene: `sheetbench suite --out suite`) names the mesh to take.",
        "In *two-edges-clamped* two errors cancel: with the sheet's own masses the same springs are 15 % "
        "too stiff with 8 squares and 9 % with 16, and equal masses make the free rims heavy by as much.",
    ),
    "genesis": (
        "`bending_compliance` gives a flat sheet no stiffness: the force of a hinge has sin² of its angle "
        "where the multiplier is divided (`_kernel_solve_bending`). With compliance next to 0 the stiffness "
        "is `bending_relaxation`/(W dt²): `run_genesis.py` of `sheetbench calibrate SCENE --for genesis`.",
        "A hinge's W counts only vertices that are free: with one relaxation for all, as the material has "
        "it, hinges on and next to a clamp are 1.3 to 6 times as stiff, on a mesh of its own with a ragged "
        "clamp. A cantilever was 41 % too stiff by that; a linear plate of such hinges is 40 %. The script "
        "keeps the mesh that is given and writes every hinge's own relaxation, every side's "
        "compliance and every vertex's mass into the solver's fields.",
        "`particle_size` as long as the mesh's sides, as Genesis makes it, lets neighbours touch as soon as "
        "a side is pressed: they then push and stick by friction (`_func_solve_collision`), and "
        "*two-edges-clamped* creeps and was stopped 12.8 % off. With 0.9 of the sides it rests in 7.5 s "
        "instead of 45, at −12.994 mm, where the energy of the same mesh has its minimum at −12.991 "
        "(`APART` of `run_genesis.py`).",
        "`stretch_compliance` c is as stiff as 1/(c + (1/m₁ + 1/m₂) dt²): at usual steps the step and the "
        "masses decide, not c. With the numbers in use it has its own mesh, a probe is the nearest particle, "
        "and there is no force on a single one.",
    ),
}


def write_page() -> Path:
    """Write the page and its picture; where the page is."""
    documents = [read_results(path) for path in sorted(RESULTS.glob("*.json"))]
    front = [f"- *{scene}*: {_front(documents, scene)}" for scene in SCENES]
    best = min(_answered(documents, SCENES[0]), key=lambda one: one[1]["error"])
    text = TEXT.format(
        count=len(_scenes("statics")),
        curves=len(_scenes("curves")),
        version=VERSION,
        tables="\n".join(map(_table, documents)),
        chosen=chosen(),
        findings="\n".join(map(_finding, documents)).replace(" %", f"{NO_BREAK}%") + "\n",
        front="\n".join(front) + "\n",
        badge=f"{_percent(best[1]['error'])}, {best[0]}",
    )
    (DOCS / "results.md").write_text(text, encoding="utf-8")
    _picture(documents)
    return DOCS / "results.md"


def chosen() -> str:
    """Every code in SCENES: the best of the numbers in use, ours, and how many times as near they are."""
    documents = [read_results(path) for path in sorted(RESULTS.glob("*.json"))]
    lines = ["| code | scene | best in use | ours | times as near |", "|---|---|---:|---:|---:|"]
    for document in documents:
        for scene, best, error in _pairs(document):
            if scene in SCENES:
                cells = (document["title"], scene, _percent(best), _percent(error), f"{best / error:.1f}")
                lines.append(f"| {' | '.join(cells)} |".replace(" %", f"{NO_BREAK}%"))
    return "\n".join(lines) + "\n"


def _pairs(document: dict[str, Any]) -> list[tuple[str, float, float]]:
    """Scenes that numbers in use and ours both answer: the least error in use, and ours."""
    in_use = {row["recipe"] for row in document["rows"] if not row["recipe"].startswith(OURS)}
    errors = [_errors(document, one) for one in in_use]
    found = []
    for scene, error in _errors(document, OURS).items():
        others = [known for one in errors if (known := one.get(scene)) is not None]
        if error is not None and others:
            found.append((scene, min(others), error))
    return found


def _answered(documents: list[dict[str, Any]], scene: str) -> list[tuple[str, dict[str, Any]]]:
    """Code and row of every answer to a scene."""
    pairs = [(one["title"], row) for one in documents for row in one["rows"]]
    return [(title, row) for title, row in pairs if row["scene"] == scene and row["error"] is not None]


def _table(document: dict[str, Any]) -> str:
    """Scenes down, recipes across; below each suite's the geometric mean of the scenes answered."""
    recipes = list(dict.fromkeys(row["recipe"] for row in document["rows"]))
    cells = {(row["scene"], row["recipe"]): row for row in document["rows"]}
    lines = [f"| scene | {' | '.join(recipes)} |", f"|---|{'---:|' * len(recipes)}"]
    for suite in ("statics", "curves"):
        scenes = [scene for scene in _scenes(suite) if any((scene, one) in cells for one in recipes)]
        for scene in scenes:
            lines.append(f"| {scene} | {' | '.join(_cell(cells.get((scene, one))) for one in recipes)} |")
        if scenes:
            means = " | ".join(_mean(_errors(document, one, suite).values()) for one in recipes)
            lines.append(f"| *geometric mean, {suite}* | {means} |")
    about = f"{document['licence']}; {document['date']}, {document['machine']}; `{document['command']}`"
    return f"## {document['title']}\n\n{about}\n\n" + "\n".join(lines) + "\n"


def _cell(row: dict[str, Any] | None) -> str:
    if row is None:
        return "not run"
    spent = "" if row["seconds"] is None else f", {row['seconds']:.2g} s"
    text = (row["status"] if row["error"] is None else _percent(row["error"])) + spent
    return text.replace(" ", NO_BREAK).replace(f",{NO_BREAK}", ", ")


def _scenes(suite: str) -> list[str]:
    return [name for name, case in CASES.items() if case.suite == suite]


def _mean(errors: Iterable[float | None]) -> str:
    known = [error for error in errors if error is not None]
    return f"{_percent(geometric_mean(known))} of {len(known)}".replace(" ", NO_BREAK) if known else "–"


def _errors(document: dict[str, Any], recipe: str, suite: str = "statics") -> dict[str, float | None]:
    rows = [row for row in document["rows"] if row["recipe"] == recipe]
    return {row["scene"]: row["error"] for row in rows if CASES[row["scene"]].suite == suite}


def _finding(document: dict[str, Any]) -> str:
    """A code with our numbers beside the best of those in use, over the scenes that both answer; and why."""
    sentences: list[str] = []
    if pairs := _pairs(document):
        means = [geometric_mean(errors) for errors in list(zip(*pairs, strict=True))[1:]]
        in_use, ours = map(_percent, means)
        sentences.append(
            f"Geometric mean of {len(pairs)} statics: {in_use} with the best in use, {ours} with ours."
        )
    if curves := [error for error in _errors(document, OURS, "curves").values() if error is not None]:
        sentences.append(f"{len(curves)} curves with ours: {_percent(geometric_mean(curves))}.")
    why = "".join(f"\n  - {one}" for one in WHY.get(document["code"], ()))
    return (
        f"- **{document['title']}** (`{document['command']}`): {' '.join(sentences) or _means(document)}{why}"
    )


def _means(document: dict[str, Any]) -> str:
    """The mean of every recipe of a code that has none of ours."""
    recipes = dict.fromkeys(row["recipe"] for row in document["rows"])
    return "; ".join(f"{one}: {_mean(_errors(document, one).values())}" for one in recipes) + "."


def _front(documents: list[dict[str, Any]], scene: str) -> str:
    """Those that none other is both quicker and nearer than, the quickest first."""
    kept: list[tuple[str, dict[str, Any]]] = []
    for title, row in sorted(_answered(documents, scene), key=lambda one: one[1]["seconds"]):
        if not kept or row["error"] < kept[-1][1]["error"]:
            kept.append((title, row))
    return "; ".join(
        f"{title}, with {row['recipe']} ({_percent(row['error'])} in {row['seconds']:.3g} s)"
        for title, row in kept
    )


def _percent(share: float) -> str:
    return f"{100 * share:.{1 if share < 1.0 else 0}f} %"


def _picture(documents: list[dict[str, Any]]) -> None:
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    from sheetbench.answers.style import STYLE

    with rc_context(STYLE):
        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
        names = {document["title"]: document["title"] for document in documents}
        for axes, scene in zip(figure.subplots(1, 2, sharey=True), SCENES, strict=True):
            for number, document in enumerate(documents):
                for row in document["rows"]:
                    if row["scene"] == scene and row["error"] is not None:
                        ours = row["recipe"].startswith(OURS)
                        axes.plot(
                            row["seconds"],
                            100 * row["error"],
                            "o" if ours else "x",
                            color=f"C{number}",
                            label=names.pop(document["title"], None),
                        )
            axes.set(xscale="log", yscale="log", title=scene, xlabel="time to rest [s]")
        figure.axes[0].set_ylabel("error [%]   ● ours   × in use")
        figure.legend(loc="outside lower center", ncols=3)
        figure.savefig(DOCS / "images" / "results.png", dpi=150)
