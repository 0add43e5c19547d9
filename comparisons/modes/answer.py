"""Natural frequencies of a lattice and of references, paired by mode shape: the answer of `sheetbench
modes`."""

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

FLAT = 0.3  # displacement in thicknesses; above it stretching stiffens a plate by percents


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
        """Return the spectrum as JSON data."""
        model = {"model": self.model, "label": self.label, "settings": self.settings}
        return {**model, **self.modes.document(), "solve_seconds": self.seconds}


@dataclass(frozen=True, repr=False)
class Spectra(Answer):
    """The spectra of a scene, of the lattice and then of each reference.

    about: "flat" or "deformed"; sag [m]: largest displacement of the lattice's linear answer to the scene's
    loads, None without loads or with a free rigid motion; buckling: of the lattice, then of the references,
    empty unless requested; expected: expected grid error of each load factor of the lattice, None for a
    factor without an estimate, or one reason for all.
    """

    file_name = "modes"
    scene: Scene
    spectra: tuple[Spectrum, ...]
    about: About = "flat"
    sag: float | None = None
    buckling: tuple[Buckling, ...] = ()
    expected: tuple[float | None, ...] | NoEstimate | None = None

    def __getitem__(self, index: int) -> Spectrum:
        return self.spectra[index]

    def __len__(self) -> int:
        return len(self.spectra)

    @property
    def frequencies(self) -> np.ndarray:
        """Natural frequencies of the lattice (count,) [Hz]; `self[1].frequencies`: of a reference."""
        return self[0].frequencies

    @cached_property
    def _shapes(self) -> tuple[np.ndarray, ...]:
        """Shapes (count, n, 3) of every model on equal plan cells."""
        return tuple(on_cells(self.scene, spectrum.modes.displacement) for spectrum in self.spectra)

    @cached_property
    def kinds(self) -> tuple[str | None, ...]:
        """Kind of every mode of the lattice, None about a deformed sheet."""
        if self.about == "deformed":
            return (None,) * len(self[0].frequencies)
        return tuple(kinds(self.scene, self._shapes[0], CELLS))

    @cached_property
    def pairs(self) -> tuple[Pair, ...]:
        """Pairs of the lattice's modes and the modes of equal shape of each reference."""
        models = zip(self.spectra, self._shapes, strict=True)
        first, *others = ((spectrum.model, spectrum.frequencies, shapes) for spectrum, shapes in models)
        return pairs_of(first, others, self.kinds)

    @cached_property
    def buckling_pairs(self) -> tuple[Pair, ...]:
        """Pairs of the lattice's buckling modes and the modes of equal shape of each reference."""
        if not self.buckling:
            return ()
        first, *others = (
            (modes.model, modes.load_factors, on_cells(self.scene, modes.displacement))
            for modes in self.buckling
        )
        return pairs_of(first, others, [None] * len(first[1]))

    @cached_property
    def damping(self) -> tuple[tuple[ModeDamping, ...], ...]:
        """Damping of every model's modes about the flat sheet; empty for a material without damping and for a
        scene with its own dampers."""
        material = self.scene.material
        damps = material.dashpot_time or material.damping_rate or material.branches.times
        if self.about == "deformed" or self.scene.dampers is not None or not damps:
            return ()
        return tuple(mode_damping(material, spectrum.frequencies) for spectrum in self.spectra)

    def pairs_with(self, model: str) -> tuple[Pair, ...]:
        """Return the pairs with one reference, in the order of the lattice's modes."""
        return tuple(pair for pair in self.pairs if pair.against == model)

    def document(self) -> dict[str, Any]:
        damping = {
            spectrum.model: [asdict(mode) for mode in modes]
            for spectrum, modes in zip(self.spectra, self.damping, strict=False)
        }
        reason = self.expected.reason if isinstance(self.expected, NoEstimate) else None
        buckling = {
            "solutions": [modes.as_dict() for modes in self.buckling],
            "pairs": [pair.as_dict() for pair in self.buckling_pairs],
            **({"no_estimate": reason} if reason else {"expected_errors": self.expected}),
        }
        return {
            "scene": self.scene.document(),
            "about": self.about,
            "sag": self.sag,
            "solutions": [spectrum.as_dict() for spectrum in self.spectra],
            "pairs": [pair.as_dict() for pair in self.pairs],
            **({"damping": damping} if damping else {}),
            **({"buckling": buckling} if self.buckling else {}),
        }

    def tables(self) -> tuple[Table, ...]:
        frequencies = [(spectrum.model, spectrum.frequencies.tolist()) for spectrum in self.spectra]
        caption = f"Natural frequencies about the {self.about} sheet"
        tables = [_paired_table(caption, "modes", HERTZ(".4g"), frequencies, self.pairs, self.kinds)]
        if self.buckling:
            factors = [(modes.model, modes.load_factors.tolist()) for modes in self.buckling]
            caption, column = "Buckling: load factors, times the loads", NUMBER(".5g")
            errors = self.expected if isinstance(self.expected, tuple) else ()
            pairs = self.buckling_pairs
            tables.append(_paired_table(caption, "buckling", column, factors, pairs, expected=errors))
        damped = zip(self.spectra, self.damping, strict=False)
        return *tables, *(
            damping_table(modes, f"Damping of the modes: {spectrum.model}", f"damping-{spectrum.model}")
            for spectrum, modes in damped
        )

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("modes", "comparisons.modes.figure:compose", (self,), formats=RASTER),)

    def files(self) -> dict[str, Write]:
        return {"modes.vtu": self.write_shapes}

    def write_shapes(self, path: Path) -> None:
        """Write every mode of every model on one plan grid as `MODEL_mode_N`, its largest displacement a
        tenth of the longer side; `displacement` is the first model's first mode."""
        plan = plan_mesh(self.scene)
        largest = 0.1 * max(self.scene.sheet.lengths)
        for spectrum in self.spectra:
            for mode, shape in enumerate(spectrum.modes.displacement(plan.points[:, :2]), 1):
                shape = largest / (abs(shape).max() or 1.0) * shape
                plan.point_data.setdefault("displacement", shape)
                plan.point_data[f"{spectrum.model}_mode_{mode}"] = shape
        write_mesh(path, plan)

    def choices(self) -> dict[str, Any]:
        return {spectrum.model: spectrum.settings for spectrum in self.spectra}

    def complaints(self) -> list[str]:
        """Return a complaint if the modes are the flat sheet's and its loads bend it far."""
        thickness = self.scene.sheet.thickness
        if self.about == "deformed" or self.sag is None or self.sag < FLAT * thickness:
            return []
        return [
            f"these are modes of the flat sheet, which its loads move by {few(self.sag / thickness)} "
            "thicknesses (a linear estimate); --about deformed gives the modes about its equilibrium"
        ]

    def result(self) -> str:
        return "; ".join(
            f"{spectrum.label}: {number(float(spectrum.frequencies[0]), '.4g')} Hz"
            for spectrum in self.spectra
            if len(spectrum.frequencies)
        )

    def notes(self) -> list[str]:
        """Return notes on labels, choices, pairing, estimates, and omitted rigid motions and actuators."""
        notes = [" · ".join(spectrum.label for spectrum in self.spectra), *choice_notes(self[0].settings)]
        for spectrum in self.spectra[1:]:
            notes += _pairing_notes(self.pairs_with(spectrum.model))
        if len(self) > 1:
            notes.append("MAC: modal assurance criterion of both models' shapes, 1 for equal shapes")
        band = self.scene.material.band
        if band and any(mode.asked is None for modes in self.damping for mode in modes):
            low, high = band
            notes.append(
                f"ζ requested –: the mode is outside the band of the loss factor, {low:g} to {high:g} Hz"
            )
        if isinstance(self.expected, NoEstimate):
            notes.append(f"{self[0].model}, buckling: {self.expected}")
        elif self.expected:
            notes.append("est.: expected grid error of a load factor, from a second solve on a finer grid")
        if self[0].modes.rigid:
            notes.append(f"{self[0].modes.rigid} rigid-body modes, of frequency 0, are left out")
        if self.scene.actuators:
            notes.append("these modes are the sheet's alone, without its actuators")
        return notes


def _paired_table(
    caption: str,
    name: str,
    value: Column,
    models: Sequence[tuple[str, list[float]]],
    pairs: Sequence[Pair],
    kinds: Sequence[str | None] = (),
    expected: Sequence[float | None] = (),
) -> Table:
    """Return a table with a row per mode of the first model. A row has the mode's value, its expected error
    if known, number and value of the mode of equal shape in each other model, and difference and MAC from the
    second model."""
    (first, first_values), *others = models
    columns: list[tuple[Column, Sequence[Any]]] = [(NUMBER("d", "mode"), range(1, len(first_values) + 1))]
    columns += [(Column("kind"), kinds)] if any(kinds) else []
    columns.append((replace(value, name=first), first_values))
    columns += [(PERCENT("z.2f", "est."), expected)] if expected else []
    by_model = [[pair for pair in pairs if pair.against == model] for model, _ in others]
    for (model, values), matches in zip(others, by_model, strict=True):
        columns.append((NUMBER("d", f"{model}'s mode"), [pair.is_ for pair in matches]))
        matching_values = [pair.is_ and values[pair.is_ - 1] for pair in matches]
        columns.append((replace(value, name=model), matching_values))
    for matches in by_model[:1]:
        columns.append((PERCENT("+.2f", "difference"), [pair.relative for pair in matches]))
        columns.append((NUMBER(".3f", "MAC"), [pair.mac for pair in matches]))
    heads, rows = zip(*columns, strict=True)
    return Table.listed(caption, heads, zip(*rows, strict=True), name)


def _pairing_notes(pairs: Sequence[Pair]) -> list[str]:
    """Return notes on modes with another place in a reference's list, or without a counterpart there."""
    of, against = pairs[0].of, pairs[0].against
    swapped = [
        f"{pair.number}{f' ({pair.kind})' if pair.kind else ''} is {pair.is_}"
        for pair in pairs
        if pair.swapped
    ]
    unmatched = [str(pair.number) for pair in pairs if pair.is_ is None]
    notes = []
    if swapped:
        notes.append(
            f"swapped: {of} mode {', '.join(swapped)} of the {against}, by their shapes; "
            "the rows compare modes of equal shape"
        )
    if unmatched:
        notes.append(
            f"{of} mode {', '.join(unmatched)}: none of the {against}'s first {len(pairs)} has its shape; "
            "--count lists more"
        )
    return notes
