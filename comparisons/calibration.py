"""Spring constants for a sheet, as tables and as the [springs] table of a scene."""

from __future__ import annotations

from typing import Any

from comparisons.tables import Column, Table

_UNITS = {"A": "N/m", "D": "N·m", "S": "N/m"}
_MEANINGS = {
    "axial": "ka, along x and y in a layer",
    "diagonal": "kd, diagonal in a layer",
    "vertical": "kz, through the thickness",
    "cross": "kdT, between layers, along x and y",
    "cross_diagonal": "kddT, between layers, diagonal",
    "area": "area spring of a cell in a layer",
    "mid_area": "area spring of a mid-surface cell",
}


def springs(calibration: dict[str, Any]) -> Table:
    """A row per family, and per direction where they differ; `calibration` as its `as_dict` gives it."""
    rows = []
    for name, value in calibration["springs"].items():
        directions = value if isinstance(value, dict) else {"": value}
        rows += [(f"{name} {axis}".strip(), _MEANINGS.get(name, ""), k) for axis, k in directions.items()]
    columns = (
        Column("spring"),
        Column("what it is", prose=True),
        Column("stiffness", "N/m", "N/m", 1.0, ".6g"),
    )
    return Table("Spring constants", columns, tuple(rows))


def moduli(calibration: dict[str, Any]) -> Table:
    """A row per modulus: what the sheet asks and what the lattice has."""
    rows = []
    for row in calibration["moduli"]:
        asked, got = row["asked"], row["got"]
        off = (got - asked) / asked if asked else None
        rows.append((row["name"], _UNITS.get(row["name"][:1], ""), asked, got, off))
    columns = (
        Column("modulus"),
        Column("unit"),
        Column("asked", form=".6g"),
        Column("got", form=".6g"),
        Column("off by", "", "%", 100.0, "z.2f"),
    )
    return Table("Moduli of the sheet and of the lattice", columns, tuple(rows))


def to_toml(calibration: dict[str, Any]) -> str:
    """The [springs] table for pasting into a scene; all digits."""
    lines = ["[springs]"]
    for name, value in calibration["springs"].items():
        lines.append(f"{name} = {_toml(value)}")
    lines.append(f"layer_distance = {_toml(calibration['layer_distance'])}")
    return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{axis} = {_toml(k)}" for axis, k in value.items()) + " }"
    return repr(float(value))
