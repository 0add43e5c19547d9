"""The folder of files that a comparison leaves: written one by one, each whole, the earliest first."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from comparisons.comparison import tables as summary
from comparisons.comparison.comparison import Comparison
from comparisons.report import vtk
from comparisons.report.files import to_json, write_text
from comparisons.runs import manifest
from sheetbench.scenes import Solution


class Output:
    """Writes into `folder` and remembers the names in `written`; `command` goes into the manifest."""

    def __init__(self, folder: Path, command: list[str]) -> None:
        self.folder = folder
        self.command = command
        self.written: list[str] = []

    def solution(self, solution: Solution) -> None:
        """MODEL.vtu: a solution on its own mesh. To be called as soon as the solution is there."""
        vtk.write_solution(self._name(f"{solution.model}.vtu"), solution)

    def comparison(self, comparison: Comparison) -> None:
        """The JSON document, the tables as CSV and Markdown, comparison.vtu and the manifest."""
        tables = [summary.displacements(comparison), summary.costs(comparison), summary.reactions(comparison)]
        self._text("comparison.json", to_json(comparison.as_dict()))
        for name, table in zip(("table.csv", "models.csv", "reactions.csv"), tables, strict=True):
            self._text(name, table.to_csv())
        self._text("table.md", _page(comparison, [table.to_markdown() for table in tables]))
        vtk.write_comparison(self._name("comparison.vtu"), comparison)
        settings = {solution.model: solution.settings for solution in comparison.solutions}
        self._text("manifest.json", to_json(manifest.manifest(comparison.scene, settings, self.command)))

    def picture(self, comparison: Comparison) -> str | None:
        """comparison.png; where it cannot be drawn, the reason in a sentence."""
        from comparisons.report.offscreen import why_not

        drawn = comparison.solutions[:2]
        if not all(np.all(np.isfinite(s.mesh.point_data["displacement"])) for s in drawn):
            return "a displacement is not a finite number"
        impossible = why_not()
        if impossible is None:
            from comparisons.comparison.figure import picture

            picture(self._name("comparison.png"), comparison)
        return impossible

    def _name(self, name: str) -> Path:
        self.written.append(name)
        return self.folder / name

    def _text(self, name: str, text: str) -> None:
        write_text(self._name(name), text)


def _page(comparison: Comparison, tables: list[str]) -> str:
    scene, made = comparison.scene, manifest.machine()
    title = f"# {scene.name}\n\n{scene.title}\n"
    footer = (
        f"{summary.explanation(comparison)}\n\nsheetbench {manifest.version()}, "
        f"Python {made['python']}, {made['processor']}, {made['cpu_count']} processors, {manifest.today()}.\n"
    )
    remarks = [*summary.uncertainty(comparison), *summary.complaints(comparison)]
    return "\n".join([title, *tables, *(f"- {said}\n" for said in remarks), footer])
