"""Natural frequencies of a lattice beside those of a reference: tables and the JSON document.

Both are about the undeformed, stress-free sheet: loads, weight and actuators have no part in them. A sheet
that supports leave free to move has rigid motions, whose frequency is zero; they are counted and left out.
Modes are told apart by their place in the list, lowest first.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from comparisons.models.grids import Asked, scene_grid
from comparisons.models.registry import check_lattice, check_reference, scene_springs
from comparisons.report.table import Column, Table
from sheetbench.scenes import Scene, load
from sheetbench.scenes.errors import BadInput
from sheetbench.scenes.grid import Grid


@dataclass(frozen=True)
class Spectrum:
    """A model's lowest natural frequencies (count,) [Hz]; rigid: rigid motions left out."""

    model: str
    label: str
    settings: dict[str, Any]
    frequencies: np.ndarray
    rigid: int
    unknowns: int
    seconds: float

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return {
            "model": self.model,
            "label": self.label,
            "settings": self.settings,
            "frequencies_hz": self.frequencies,
            "rigid_modes": self.rigid,
            "unknowns": self.unknowns,
            "solve_seconds": self.seconds,
        }


def spectra(
    scene: Scene | str | Path,
    *,
    count: int = 10,
    grid: Asked = None,
    calibration: str | None = None,
    references: Sequence[str] = ("shell",),
    elements: int = 16,
    starting: Callable[[str], None] = lambda model: None,
) -> list[Spectrum]:
    """The lattice's spectrum, then that of each reference.

    Raises SceneError for a scene that cannot be read, BadInput for choices that do not exist and a count
    that a mesh cannot give.
    """
    scene = scene if isinstance(scene, Scene) else load(scene)
    if count < 1:
        raise BadInput(f"--count = {count}: at least 1")
    check_lattice(calibration, None, None)
    for reference in references:
        check_reference(reference, elements)
    masses = scene_grid(scene, grid)
    starting("lumped")
    found = [_lattice(scene, count, masses, calibration)]
    for reference in references:
        starting(reference)
        found.append(_reference(scene, reference, count, elements))
    return found


def _lattice(scene: Scene, count: int, grid: Grid, calibration: str | None) -> Spectrum:
    import lumped

    springs = scene_springs(scene, grid=grid, calibration=calibration)
    begin = perf_counter()
    modes = lumped.modes(scene, springs, count)
    seconds = perf_counter() - begin
    return Spectrum(
        model="lumped",
        label=f"lumped {'×'.join(str(n) for n in springs.grid)} {springs.method}",
        settings={"grid": list(springs.grid), "calibration": springs.method},
        frequencies=modes.frequencies,
        rigid=modes.rigid,
        unknowns=modes.unknowns,
        seconds=seconds,
    )


def _reference(scene: Scene, model: str, count: int, elements: int) -> Spectrum:
    import fem_reference

    modes = fem_reference.modes(scene, model, elements, count)
    return Spectrum(
        model=model,
        label=modes.label,
        settings=modes.settings,
        frequencies=modes.frequencies,
        rigid=modes.rigid_modes,
        unknowns=modes.unknowns,
        seconds=modes.solve_seconds,
    )


def as_dict(scene: Scene, found: Sequence[Spectrum]) -> dict[str, Any]:
    """The JSON document of `sheetbench modes`."""
    return {
        "scene": scene.model_dump(mode="json", by_alias=True, exclude_none=True),
        "solutions": [spectrum.as_dict() for spectrum in found],
    }


def table(found: Sequence[Spectrum]) -> Table:
    """A row per mode: the frequency of every model, and how far each is from the first reference's."""
    names = [spectrum.model for spectrum in found]
    first = found[1].frequencies if len(found) > 1 else None
    rows = []
    for i in range(len(found[0].frequencies)):
        row: list[Any] = [i + 1, *(float(spectrum.frequencies[i]) for spectrum in found)]
        if first is not None:
            row.append(float(found[0].frequencies[i] / first[i] - 1.0))
        rows.append(tuple(row))
    columns = [Column("mode", form="d"), *(Column(name, "Hz", "Hz", 1.0, ".4g") for name in names)]
    if first is not None:
        columns.append(Column("off by", "", "%", 100.0, "+.2f"))
    return Table("Natural frequencies about the flat sheet", tuple(columns), tuple(rows))


def notes(scene: Scene, found: Sequence[Spectrum]) -> list[str]:
    """What the table does not say: labels, rigid motions left out, actuators left out."""
    said = [" · ".join(spectrum.label for spectrum in found)]
    if found[0].rigid:
        said.append(f"{found[0].rigid} rigid motions, free of any frequency, are left out")
    if scene.actuators:
        said.append("actuators have no part in these modes: they are those of the sheet alone")
    return said
