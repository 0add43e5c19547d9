"""Natural frequencies as people read them: a table of all models, and what it does not say."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from comparisons.models.grading import told
from sheetbench.answers.figure_style import Look
from sheetbench.answers.report import Picture, Report
from sheetbench.answers.table import Column, Table, number
from sheetbench.scenes.summary import few

if TYPE_CHECKING:
    from comparisons.modes.pairing import Pair
    from comparisons.modes.spectra import Spectra

FLAT = 0.3  # displacement, in thicknesses, from which on stretching stiffens a plate by percents


def report(found: Spectra) -> Report:
    """What `sheetbench modes` shows."""
    return Report(
        name="modes",
        title=found.scene.name,
        subtitle=found.scene.title,
        document=found.as_dict(),
        tables=(table(found),),
        notes=tuple(notes(found)),
        complaints=tuple(complaints(found)),
        pictures=(Picture(("modes.png", "modes.pdf"), partial(_picture, found)),),
        attachments={"modes.vtu": partial(write_shapes, found)},
        scene=found.scene,
        settings={spectrum.model: spectrum.settings for spectrum in found},
    )


def table(found: Spectra) -> Table:
    """A row per mode of the lattice: its frequency, that of the mode of the same shape of every reference,
    and how far the lattice is from the first of them."""
    references = [(spectrum, found.against(spectrum.model)) for spectrum in found[1:]]
    rows = []
    for i, (kind, frequency) in enumerate(zip(found.kinds, found[0].frequencies, strict=True)):
        row: list[Any] = [i + 1, *([kind] if kind else []), float(frequency)]
        for spectrum, pairs in references:
            match = pairs[i].is_
            row += [None, None] if match is None else [match, float(spectrum.frequencies[match - 1])]
        if references:
            first = references[0][1][i]
            row += [first.relative, first.mac]
        row += found[0].expected[i : i + 1]
        rows.append(tuple(row))
    hertz: dict[str, Any] = {"unit": "Hz", "shown_unit": "Hz", "scale": 1.0, "form": ".4g"}
    columns = [Column("mode", form="d"), *([Column("kind")] if found.kinds[0] else [])]
    columns.append(Column(found[0].model, **hertz))
    for spectrum, _ in references:
        columns += [Column(f"{spectrum.model}'s mode", form="d"), Column(spectrum.model, **hertz)]
    if references:
        columns += [Column("off by", "", "%", 100.0, "+.2f"), Column("MAC", form=".3f")]
    columns += [Column("expected", "", "%", 100.0, "+.2f")] if found[0].expected else []
    return Table(f"Natural frequencies about the {found.about} sheet", tuple(columns), tuple(rows), "modes")


def write_shapes(found: Spectra, path: Path) -> None:
    """Write every mode of every model on one plan grid, `MODEL_mode_N` each, its largest displacement a tenth
    of the longer side; `displacement` is the first model's first mode."""
    from comparisons.report.vtk import plan_mesh, write_mesh

    plan = plan_mesh(found.scene.sheet)
    largest = 0.1 * max(found.scene.sheet.lengths)
    for spectrum in found:
        for mode, shape in enumerate(spectrum.shapes(plan.points[:, :2]), 1):
            shape = largest / (abs(shape).max() or 1.0) * shape
            plan.point_data.setdefault("displacement", shape)
            plan.point_data[f"{spectrum.model}_mode_{mode}"] = shape
    write_mesh(path, plan)


def _picture(found: Spectra, paths: Sequence[Path], look: Look) -> None:
    from comparisons.modes.figure import picture

    picture(paths, found, look)


def complaints(found: Spectra) -> list[str]:
    """That modes of the flat sheet were asked of one that its loads take far from flat."""
    thickness = found.scene.sheet.thickness
    if found.about == "deformed" or found.sag is None or found.sag < FLAT * thickness:
        return []
    return [
        "this scene's sheet is not flat under its loads: by its flat stiffness it would move "
        f"{few(found.sag / thickness)} times its thickness, and these modes are the flat sheet's; "
        "--about deformed gives them about its equilibrium"
    ]


def notes(found: Spectra) -> list[str]:
    """What the table does not say: labels, rigid motions left out, actuators left out."""
    said = [" · ".join(spectrum.label for spectrum in found), *told(found[0].settings)]
    known = [100.0 * error for error in found[0].expected if error is not None]
    if known:
        of, low, high = found[0].model, number(min(known), "+.2g"), number(max(known), "+.2g")
        said.append(
            f"{of}: expected grid error of the frequencies {low} to {high} %, from a second solve "
            "on a finer grid"
        )
    for spectrum in found[1:]:
        said += _paired(found.against(spectrum.model))
    if found[0].rigid:
        said.append(f"{found[0].rigid} rigid motions, free of any frequency, are left out")
    if found.scene.actuators:
        said.append("actuators have no part in these modes: they are those of the sheet alone")
    return said


def _paired(pairs: Sequence[Pair]) -> list[str]:
    """That modes stand in another order with a reference, or have no counterpart there."""
    of, against = pairs[0].of, pairs[0].against
    swapped = [
        f"{pair.number}{f' ({pair.kind})' if pair.kind else ''} is {pair.is_}"
        for pair in pairs
        if pair.swapped
    ]
    alone = [str(pair.number) for pair in pairs if pair.is_ is None]
    said = []
    if swapped:
        said.append(
            f"swapped: {of} mode {', '.join(swapped)} of the {against}, by their shapes; "
            "the rows compare modes of the same shape"
        )
    if alone:
        said.append(
            f"{of} mode {', '.join(alone)}: none of the {against}'s first {len(pairs)} has its shape; "
            "--count lists more"
        )
    return said


def _named(pair: Pair) -> str:
    return f"{pair.number} ({pair.kind})" if pair.kind else f"{pair.number}"
