"""Scenes as TOML text: tables with their headings, what lies deeper within a line."""

from __future__ import annotations

from collections.abc import Mapping
from decimal import Decimal
from typing import Any

import tomlkit
from tomlkit.items import AoT, InlineTable, Table

LARGE = 1e5  # written with an exponent, as 54.5e6


def to_toml(scene: Any) -> str:
    """The scene as the text of a file, from which `load` reads an equal one; all digits."""
    return dumps(keys(scene))


def dumps(data: Mapping[str, Any]) -> str:
    """Return tables with headings as text; all digits."""
    text = tomlkit.document()
    for key, value in data.items():
        text[key] = _headed(value)
    return tomlkit.dumps(text)


def keys(scene: Any) -> dict[str, Any]:
    """The scene's keys and values as they stand in a file; what is absent or empty is left out."""
    data = scene.document()
    return {key: value for key, value in data.items() if value not in ("", [], {})}


def line(key: str, value: Any) -> str:
    """`key = value` in one line."""
    return tomlkit.dumps({key: _within_a_line(value)}).rstrip("\n")


def _headed(value: Any) -> Any:
    if isinstance(value, dict):
        table: Table = tomlkit.table()
        table.update({key: _within_a_line(entry) for key, entry in value.items()})
        return table
    if isinstance(value, list):
        tables: AoT = tomlkit.aot()
        tables.extend(_headed(entry) for entry in value)
        return tables
    return value


def _within_a_line(value: Any) -> Any:
    if isinstance(value, float) and abs(value) >= LARGE:
        digits = Decimal(repr(float(value))).normalize().to_eng_string()
        return tomlkit.value(digits.lower().replace("+", ""))
    if not isinstance(value, dict):
        return value
    table: InlineTable = tomlkit.inline_table()
    table.update({key: _within_a_line(entry) for key, entry in value.items()})
    return table
