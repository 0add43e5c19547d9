"""docs/results.md and its picture, of the files in studies/results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from studies.trials.study import OURS, RESULTS, SCENES, read_results

DOCS = Path(__file__).parent.parent.parent / "docs"
TEXT = """\
# Results of other codes

Each code on two scenes of the [reference set](suite.md) with 8 squares a side: with numbers that people use,
and with those of `sheetbench calibrate SCENE --for CODE` ([what they are](cells.md)). Error: the largest
difference from a converged shell at the probes, of the largest displacement; time: of the run to rest.

![Error against time of every code and recipe](images/results.png)

{tables}
## Findings

{findings}
## Who is nearest at which cost

{front}
## Adding a code

1. `sheetbench suite --out suite` has the scenes; or start from
   `sheetbench calibrate SCENE --for CODE --out DIR`.
2. Write a file as those in `studies/results` are:
   code, title, licence, date, machine, command, rows.
3. `python -m pytest tests/studies/test_trials.py` says what is wrong with it; a pull request runs
   the same test.
4. `sheetbench study trials` writes this page anew.

A badge: `sheet-set 1.0, two-edges-clamped: {badge}`.
"""


def write_page() -> Path:
    """Write the page and its picture; where the page is."""
    documents = [read_results(path) for path in sorted(RESULTS.glob("*.json"))]
    front = [f"- *{scene}*: {_front(documents, scene)}" for scene in SCENES]
    best = min(_answered(documents, SCENES[0]), key=lambda one: one[1]["error"])
    text = TEXT.format(
        tables="\n".join(map(_table, documents)),
        findings="\n".join(map(_finding, documents)) + "\n",
        front="\n".join(front) + "\n",
        badge=f"{100 * best[1]['error']:.1f} %, {best[0]}",
    )
    (DOCS / "results.md").write_text(text, encoding="utf-8")
    _picture(documents)
    return DOCS / "results.md"


def _answered(documents: list[dict[str, Any]], scene: str) -> list[tuple[str, dict[str, Any]]]:
    """Code and row of every answer to a scene."""
    pairs = [(one["title"], row) for one in documents for row in one["rows"]]
    return [(title, row) for title, row in pairs if row["scene"] == scene and row["error"] is not None]


def _table(document: dict[str, Any]) -> str:
    rows = "\n".join(
        f"| {row['scene']} | {row['recipe']}; {row['mesh']} "
        f"| {row['status'] if row['error'] is None else _percent(row['error'])} "
        f"| {'–' if row['seconds'] is None else format(row['seconds'], '.3g')} |"
        for row in document["rows"]
    )
    return (
        f"## {document['title']}\n\n{document['licence']}; {document['date']}, {document['machine']}; "
        f"`{document['command']}`\n\n| scene | numbers; mesh | error | s |\n"
        f"|---|---|---:|---:|\n{rows}\n"
    )


def _finding(document: dict[str, Any]) -> str:
    """A code with our numbers beside the best of the others, scene by scene."""
    said = []
    for scene in SCENES:
        rows = [row for row in document["rows"] if row["scene"] == scene and row["error"] is not None]
        ours = min((row["error"] for row in rows if row["recipe"] == OURS), default=None)
        others = [row for row in rows if not row["recipe"].startswith(OURS)]
        if ours is None or not others:
            said.append(f"*{scene}*: no answer to compare")
            continue
        best = min(others, key=lambda row: row["error"])
        said.append(
            f"*{scene}*: {_percent(best['error'])} with {best['recipe']}, {_percent(ours)} with ours, "
            f"{best['error'] / ours:.1f} times as near"
        )
    return f"- **{document['title']}** (`{document['command']}`): {'; '.join(said)}."


def _front(documents: list[dict[str, Any]], scene: str) -> str:
    """Those that none other is both quicker and nearer than, the quickest first."""
    kept: list[tuple[str, dict[str, Any]]] = []
    for title, row in sorted(_answered(documents, scene), key=lambda one: one[1]["seconds"]):
        if not kept or row["error"] < kept[-1][1]["error"]:
            kept.append((title, row))
    return ", ".join(
        f"{title} with {row['recipe']} ({_percent(row['error'])} in {row['seconds']:.3g} s)"
        for title, row in kept
    )


def _percent(share: float | None) -> str:
    return "–" if share is None else f"{100 * share:.1f} %"


def _picture(documents: list[dict[str, Any]]) -> None:
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    from sheetbench.answers.style import STYLE

    with rc_context(STYLE):
        figure = Figure(figsize=(7.0, 3.2), layout="constrained")
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
                            label=document["title"] if row["recipe"] == OURS else None,
                        )
            axes.set(xscale="log", yscale="log", title=scene, xlabel="time to rest [s]")
        figure.axes[0].set_ylabel("error [%]   ● ours   × in use")
        figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
        figure.savefig(DOCS / "images" / "results.png", dpi=150)
