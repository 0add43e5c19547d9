"""Files of results, `results/codes/CODE.json`: a code's answers to the reference set, with their date.

A row is a scene by a recipe (numbers and a mesh). Files come with pull requests too, so they are checked.
"""

import json
import platform
from collections.abc import Iterable
from dataclasses import asdict, dataclass, replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.scoring.reference import references
from sheetbench.answers.files import write_text
from sheetbench.errors import BadInput
from studies import pages

RESULTS = pages.RESULTS / "codes"
SCENES = ("two-edges-clamped", "one-edge-clamped")  # of the picture and the front
CASES = references("statics") | references("curves")
OURS = "ours"  # begins the names of recipes with our numbers


@dataclass(frozen=True)
class Trial:
    """A scene by a recipe; error and seconds are None without an answer. inputs: checksum of the code's input
    files; moved: displacements of the scene's probes [m]."""

    scene: str
    recipe: str
    mesh: str
    status: str
    error: float | None
    seconds: float | None
    why: str = ""
    inputs: str = ""
    moved: list[list[float]] | None = None


@dataclass(frozen=True)
class CodeResults:
    """Results of a code."""

    code: str
    title: str
    licence: str
    date: str
    machine: str
    command: str
    rows: tuple[Trial, ...]

    @property
    def recipes(self) -> list[str]:
        """Names of the recipes in the order of the rows."""
        return list(dict.fromkeys(row.recipe for row in self.rows))

    def errors(self, recipe: str, suite: str = "statics") -> dict[str, float | None]:
        """Return a recipe's errors by the scenes of a suite."""
        of = [row for row in self.rows if row.recipe == recipe and CASES[row.scene].suite == suite]
        return {row.scene: row.error for row in of}

    def in_use_and_ours(self) -> dict[str, tuple[float, float]]:
        """Return, by scenes that both answer, the least error with numbers in use and the error with ours."""
        others = [self.errors(recipe) for recipe in self.recipes if not recipe.startswith(OURS)]
        pairs = {}
        for scene, error in self.errors(OURS).items():
            in_use = [value for errors in others if (value := errors.get(scene)) is not None]
            if error is not None and in_use:
                pairs[scene] = (min(in_use), error)
        return pairs


def write_results(code: str, title: str, licence: str, rows: Iterable[Trial], arguments: str) -> Path:
    """Write a code's file of results, and return it; arguments: of the `study codes` that measured them."""
    machine = f"{platform.machine()}, Python {platform.python_version()}, one thread"
    date = datetime.now(UTC).date().isoformat()
    head = CodeResults(code, title, licence, date, machine, f"sheetbench study codes {arguments}", ())
    text = json.dumps(asdict(replace(head, rows=())), indent=1, ensure_ascii=False).removesuffix("[]\n}")
    lines = ",\n".join(f"  {json.dumps(asdict(row), ensure_ascii=False)}" for row in rows)
    path = RESULTS / f"{code}.json"
    write_text(path, f"{text}[\n{lines}\n ]\n}}\n")
    return path


def read_results(path: Path) -> CodeResults:
    """Return a file's results. Raises BadInput for a file that is not valid, with the reason."""
    try:
        document: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        results = CodeResults(**{**document, "rows": tuple(Trial(**row) for row in document["rows"])})
        datetime.fromisoformat(results.date)
    except (OSError, ValueError, KeyError, TypeError) as error:
        raise BadInput(f"{path}: no file of results: {error!r}") from None
    texts = (value for key, value in vars(results).items() if key != "rows")
    if not results.rows or not all(isinstance(text, str) and text for text in texts):
        raise BadInput(f"{path}: texts and rows are not to be empty")
    for row in results.rows:
        numbers = [value for value in (row.error, row.seconds) if value is not None]
        if row.scene not in CASES or not all(0.0 <= value < np.inf for value in numbers):
            raise BadInput(f"{path}: {row.scene}, {row.recipe}: a scene of {', '.join(CASES)}, numbers ≥ 0")
        if row.status == "converged" and len(numbers) < 2:
            raise BadInput(f"{path}: {row.scene}, {row.recipe}: converged without an error or a time")
    return results


def every_result() -> list[CodeResults]:
    """Return all files of results."""
    return [read_results(path) for path in sorted(RESULTS.glob("*.json"))]
