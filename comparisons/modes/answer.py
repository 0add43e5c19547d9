"""Natural frequencies of a lattice beside those of references: the answer of `sheetbench modes`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.models.expected_error import NoEstimate
from comparisons.models.grading import choice_notes
from comparisons.modes.damping import ModeDamping, damping_table, mode_damping
from comparisons.modes.pairing import CELLS, Pair, kinds, on_cells, pairs_of
from comparisons.pictures.array_files import write_mesh
from comparisons.pictures.plan import plan_mesh
from sheetbench.answers.answer import Answer
from sheetbench.answers.modes import Buckling, NaturalModes
from sheetbench.answers.report import RASTER, Picture, Write
from sheetbench.answers.solution import About
from sheetbench.answers.table import HERTZ, NUMBER, PERCENT, Column, Table, number
from sheetbench.scenes import Scene
from sheetbench.scenes.language.summary import few

FLAT = 0.3  # displacement, in thicknesses, from which on stretching stiffens a plate by percents


@dataclass(frozen=True)
class Spectrum:
    """A model's lowest natural modes, with its settings and the seconds of the solve."""

    model: str
    label: str
    settings: dict[str, Any]
    seconds: float
    modes: NaturalModes

    @property
    def frequencies(self) -> np.ndarray:
        """The natural frequencies (count,) [Hz]."""
        return self.modes.frequencies

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        own = {"model": self.model, "label": self.label, "settings": self.settings}
        return {**own, **self.modes.document(), "solve_seconds": self.seconds}


@dataclass(frozen=True, repr=False)
class Spectra(Answer):
    """The spectra of a scene, the lattice's first, then that of each reference.

    about: "flat" or "deformed"; sag [m]: the largest displacement that the lattice's flat tangent gives under
    the scene's loads, None where there are none, or nothing that stops a rigid motion; buckling: of the
    lattice first, then of the references, none unless requested; expected: the grid error to expect of each
    of the lattice's load factors, None of one without, or why there is none of any.
    """

    file_name = "modes"
    scene: Scene
    found: tuple[Spectrum, ...]
    about: About = "flat"
    sag: float | None = None
    buckling: tuple[Buckling, ...] = ()
    expected: tuple[float | None, ...] | NoEstimate | None = None

    def __getitem__(self, index: int) -> Spectrum:
        return self.found[index]

    def __len__(self) -> int:
        return len(self.found)

    @property
    def frequencies(self) -> np.ndarray:
        """The lattice's (count,) [Hz]; the first reference's are `self[1].frequencies`."""
        return self[0].frequencies

    @cached_property
    def _sampled(self) -> tuple[np.ndarray, ...]:
        """Shapes (count, n, 3) of every model on equal plan cells."""
        return tuple(on_cells(self.scene, spectrum.modes.displacement) for spectrum in self.found)

    @cached_property
    def kinds(self) -> tuple[str | None, ...]:
        """What kind of mode every one of the lattice is; None about a deformed sheet."""
        if self.about == "deformed":
            return (None,) * len(self[0].frequencies)
        return tuple(kinds(self.scene, self._sampled[0], CELLS))

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """Every mode of the lattice with the mode of the same shape of each reference."""
        models = zip(self.found, self._sampled, strict=True)
        first, *others = ((one.model, one.frequencies, shapes) for one, shapes in models)
        return pairs_of(first, others, self.kinds)

    @cached_property
    def buckling_pairs(self) -> tuple[Pair, ...]:
        """Every buckling mode of the lattice with that of the same shape of each reference."""
        if not self.buckling:
            return ()
        first, *others = (
            (one.model, one.load_factors, on_cells(self.scene, one.displacement)) for one in self.buckling
        )
        return pairs_of(first, others, [None] * len(first[1]))

    @cached_property
    def damping(self) -> tuple[tuple[ModeDamping, ...], ...]:
        """Damping of every model's modes about the flat sheet; none of a material that does not damp, and of
        a scene with dampers of its own."""
        material = self.scene.material
        damps = material.dashpot_time or material.damping_rate or material.branches.times
        if self.about == "deformed" or self.scene.dampers is not None or not damps:
            return ()
        return tuple(mode_damping(material, spectrum.frequencies) for spectrum in self.found)

    def against(self, model: str) -> tuple[Pair, ...]:
        """Return the pairs with one reference, in the order of the lattice's modes."""
        return tuple(pair for pair in self.pairs if pair.against == model)

    def document(self) -> dict[str, Any]:
        damping = {
            spectrum.model: [asdict(mode) for mode in modes]
            for spectrum, modes in zip(self.found, self.damping, strict=False)
        }
        why_not = self.expected.reason if isinstance(self.expected, NoEstimate) else None
        buckling = {
            "solutions": [one.as_dict() for one in self.buckling],
            "pairs": [pair.as_dict() for pair in self.buckling_pairs],
            **({"no_estimate": why_not} if why_not else {"expected_errors": self.expected}),
        }
        return {
            "scene": self.scene.document(),
            "about": self.about,
            "sag": self.sag,
            "solutions": [spectrum.as_dict() for spectrum in self.found],
            "pairs": [pair.as_dict() for pair in self.pairs],
            **({"damping": damping} if damping else {}),
            **({"buckling": buckling} if self.buckling else {}),
        }

    def tables(self) -> tuple[Table, ...]:
        found = [(one.model, one.frequencies.tolist()) for one in self.found]
        caption = f"Natural frequencies about the {self.about} sheet"
        shown = [_paired(caption, "modes", HERTZ(".4g"), found, self.pairs, self.kinds)]
        if self.buckling:
            buckled = [(one.model, one.load_factors.tolist()) for one in self.buckling]
            caption, factor = "Buckling: load factors, times the loads", NUMBER(".5g")
            errors = self.expected if isinstance(self.expected, tuple) else ()
            shown.append(_paired(caption, "buckling", factor, buckled, self.buckling_pairs, expected=errors))
        damped = zip(self.found, self.damping, strict=False)
        return *shown, *(
            damping_table(modes, f"Damping of the modes: {one.model}", f"damping-{one.model}")
            for one, modes in damped
        )

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("modes", "comparisons.modes.figure:compose", (self,), formats=RASTER),)

    def files(self) -> dict[str, Write]:
        return {"modes.vtu": self.write_shapes}

    def write_shapes(self, path: Path) -> None:
        """Write every mode of every model on one plan grid, `MODEL_mode_N` each, its largest displacement a
        tenth of the longer side; `displacement` is the first model's first mode."""
        plan = plan_mesh(self.scene)
        largest = 0.1 * max(self.scene.sheet.lengths)
        for spectrum in self.found:
            for mode, shape in enumerate(spectrum.modes.displacement(plan.points[:, :2]), 1):
                shape = largest / (abs(shape).max() or 1.0) * shape
                plan.point_data.setdefault("displacement", shape)
                plan.point_data[f"{spectrum.model}_mode_{mode}"] = shape
        write_mesh(path, plan)

    def choices(self) -> dict[str, Any]:
        return {spectrum.model: spectrum.settings for spectrum in self.found}

    def complaints(self) -> list[str]:
        """A complaint where the modes are the flat sheet's and its loads take it far from flat."""
        thickness = self.scene.sheet.thickness
        if self.about == "deformed" or self.sag is None or self.sag < FLAT * thickness:
            return []
        return [
            f"these are modes of the flat sheet, which its loads move by {few(self.sag / thickness)} "
            "thicknesses (a linear estimate); --about deformed gives those about its equilibrium"
        ]

    def result(self) -> str:
        return "; ".join(
            f"{one.label}: {number(float(one.frequencies[0]), '.4g')} Hz"
            for one in self.found
            if len(one.frequencies)
        )

    def notes(self) -> list[str]:
        """Return what the table does not say: labels, rigid motions left out, actuators left out."""
        notes = [" · ".join(spectrum.label for spectrum in self.found), *choice_notes(self[0].settings)]
        for spectrum in self.found[1:]:
            notes += _pairing_notes(self.against(spectrum.model))
        if len(self) > 1:
            notes.append("MAC: modal assurance criterion of both models' shapes, 1 where they are the same")
        band = self.scene.material.band
        if band and any(mode.asked is None for modes in self.damping for mode in modes):
            notes.append(
                "ζ requested –: the mode is outside the band of the loss factor, {:g} to {:g} Hz".format(
                    *band
                )
            )
        if isinstance(self.expected, NoEstimate):
            notes.append(f"{self[0].model}, buckling: {self.expected}")
        elif self.expected:
            notes.append("est.: grid error to expect of a load factor, from a second solve on a finer grid")
        if self[0].modes.rigid:
            notes.append(f"{self[0].modes.rigid} rigid-body modes, of frequency 0, are left out")
        if self.scene.actuators:
            notes.append("these modes are the sheet's alone, without its actuators")
        return notes


def _paired(
    caption: str,
    name: str,
    value: Column,
    found: Sequence[tuple[str, list[float]]],
    pairs: Sequence[Pair],
    kinds: Sequence[str | None] = (),
    expected: Sequence[float | None] = (),
) -> Table:
    """Return a row per mode of the first model: its value, the error expected of it where that is known, and
    number and value of the mode of the same shape of each other; difference and MAC from the second."""
    (first, own), *others = found
    columns: list[tuple[Column, Sequence[Any]]] = [(NUMBER("d", "mode"), range(1, len(own) + 1))]
    columns += [(Column("kind"), kinds)] if any(kinds) else []
    columns.append((replace(value, name=first), own))
    columns += [(PERCENT("z.2f", "est."), expected)] if expected else []
    beside = [[pair for pair in pairs if pair.against == model] for model, _ in others]
    for (model, values), theirs in zip(others, beside, strict=True):
        columns.append((NUMBER("d", f"{model}'s mode"), [pair.is_ for pair in theirs]))
        same = [pair.is_ and values[pair.is_ - 1] for pair in theirs]
        columns.append((replace(value, name=model), same))
    for theirs in beside[:1]:
        columns.append((PERCENT("+.2f", "difference"), [pair.relative for pair in theirs]))
        columns.append((NUMBER(".3f", "MAC"), [pair.mac for pair in theirs]))
    heads, rows = zip(*columns, strict=True)
    return Table.listed(caption, heads, zip(*rows, strict=True), name)


def _pairing_notes(pairs: Sequence[Pair]) -> list[str]:
    """That modes stand in another order with a reference, or have no counterpart there."""
    of, against = pairs[0].of, pairs[0].against
    swapped = [
        f"{pair.number}{f' ({pair.kind})' if pair.kind else ''} is {pair.is_}"
        for pair in pairs
        if pair.swapped
    ]
    alone = [str(pair.number) for pair in pairs if pair.is_ is None]
    notes = []
    if swapped:
        notes.append(
            f"swapped: {of} mode {', '.join(swapped)} of the {against}, by their shapes; "
            "the rows compare modes of the same shape"
        )
    if alone:
        notes.append(
            f"{of} mode {', '.join(alone)}: none of the {against}'s first {len(pairs)} has its shape; "
            "--count lists more"
        )
    return notes
