"""Tables of spring constants and moduli from a calibration's document."""

import re
from typing import Any

import numpy as np

from lumped.moduli import second_moment
from sheetbench.answers.table import Column, Table, number
from sheetbench.scenes import SpringSet
from sheetbench.scenes.language.schema import sentences

UNITS = {"A": "N/m", "D": "N·m", "S": "N/m"}


def springs(calibration: dict[str, Any]) -> Table:
    """Return the table of constants, a row per family, and per direction if directions differ; for unequal
    cells the least and the largest that is not 0. calibration: its `document`."""
    rows, meanings = [], sentences(SpringSet)
    by_axis = [value if isinstance(value, dict) else {"": value} for value in calibration["springs"].values()]
    unequal = any(np.ndim(k) for directions in by_axis for k in directions.values())
    for name, directions in zip(calibration["springs"], by_axis, strict=True):
        meaning = re.split(r"[.:] |, energy|\.$", meanings.get(name, ""))[0]
        for axis, k in directions.items():
            nonzero = np.ravel(k)[np.ravel(k) != 0.0] if np.any(k) else np.zeros(1)  # 0 in holes
            ends = [float(nonzero.min()), float(nonzero.max())] if unequal else [k]
            rows.append((f"{name} {axis}".strip(), meaning, *ends))
    headings = ("least", "largest") if unequal else ("stiffness",)
    constants = (Column(heading, "N/m", "N/m", 1.0, "#.6g") for heading in headings)
    columns = (Column("spring"), Column("what it is", prose=True), *constants)
    note = f"layer distance {1e3 * calibration['layer_distance']:.6g} mm"
    return Table("Spring constants", columns, tuple(rows), "springs", text=note)


def moduli(calibration: dict[str, Any]) -> Table:
    """Return the table of moduli, a row each: the sheet's, the target of the springs on this grid, the
    lattice's.

    Targets are the sheet's moduli, but for the transverse shear: the sheet has κGh, the target is MacNeal's
    S* (`lumped.moduli`), with which cells bend as the sheet does.
    """
    rows = []
    for row in calibration["moduli"]:
        target, got = row["asked"], row["got"]
        off = (got - target) / target if target else None
        sheet = row.get("kappa_G_h", target)
        rows.append((row["name"], UNITS.get(row["name"][:1], ""), sheet, target, got, off))
    values = (Column(name, form="#.6g") for name in ("sheet", "target", "lattice"))
    columns = (Column("modulus"), Column("unit"), *values, Column("off target by", "", "%", 100.0, "z.2f"))
    note = (
        "S: the target is S*, 1/S* = 1/κGh + l²/12D11, below the sheet's κGh on purpose: cells of length l "
        "are too stiff in shear by l²/12D11"
    )
    caption, note = "Moduli of the sheet and of the lattice", note + _edges(calibration)
    return Table(caption, columns, tuple(rows), "moduli", text=note)


def _edges(calibration: dict[str, Any]) -> str:
    """Return the end of a sentence with the factor of D66 in cells along free, hinged and held edges."""
    shear, layers = calibration["springs"].get("edge_shear"), calibration["grid"][2]
    if not shear:
        return ""
    square = second_moment(layers) * calibration["layer_distance"] ** 2
    got = {row["name"]: row["got"] for row in calibration["moduli"]}
    both = [*shear.values()] if isinstance(shear, dict) else [shear, shear]
    factors: list[float] = []
    for cells, along in zip(both, ("1", "2"), strict=True):
        normal = got.get(f"D{along}{along}", got["D11"])  # square cells have one value for both
        twisting = got["D66"] - got.get(f"D{along}6", 0.0) ** 2 / normal
        factors += [1.0 + float(k) * square / twisting for k in (np.min(cells), np.max(cells))]
    share = " to ".join(dict.fromkeys(number(end, ".3f") for end in (min(factors), max(factors))))
    modulus = "D66 less D16²/D11 or D26²/D22" if "D16" in got else "D66"
    place = "in cells along free, hinged and held edges"
    return f". {modulus}: times {share} {place}, to match the torsion of a strip"
