"""Which sheets are shown: of the studies that a folder holds, or of a scene that is solved first.

Both are read from the same files, those that verbs leave with --out: a scene's answers are written to a
passing folder. What is shown is what the viewer takes (`comparisons.browser`), a window too.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from comparisons.comparison.comparison import Comparison
from comparisons.pages.stage import stage
from comparisons.pages.studies import Study, read
from sheetbench.scenes.errors import BadInput


@dataclass(frozen=True)
class Staged:
    """A study's sheets; options: of the viewer."""

    title: str
    subtitle: str
    options: dict[str, Any]


def of_folder(folder: Path) -> tuple[list[Staged], list[str]]:
    """The studies with sheets in a folder and those below it, and a sentence for everything that cannot be
    read. Raises BadInput where there is nothing to show."""
    found = read(folder, loose=True)
    shown = [one for one in map(_staged, found.studies) if one is not None]
    troubles = [*found.troubles, *(said for study in found.studies for said in study.troubles)]
    if not shown:
        why = f": {troubles[0]}" if troubles else "; compare, simulate and modes leave some with --out"
        raise BadInput(f"'{folder}': no sheets there{why}")
    return shown, troubles


def of_comparison(comparison: Comparison) -> Staged:
    """Lattice, reference and their difference."""
    report = comparison.report()
    with TemporaryDirectory() as place:
        written = {name: write for name, write in report.files().items() if name.endswith((".vtu", ".json"))}
        for name, write in written.items():
            write(Path(place) / name)
        run = {"scene": comparison.scene.document(), "words": {"document": f"{report.name}.json"}}
        staged = _staged(Study(Path(place), "", "compare", tuple(written), run))
    assert staged is not None
    return staged


def _staged(study: Study) -> Staged | None:
    options = stage(study)
    if options is None:
        return None
    subtitle = study.words.get("subtitle") or (study.scene.title if study.scene is not None else "")
    return Staged(study.title, str(subtitle), options)
