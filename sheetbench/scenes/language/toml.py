"""Scenes as TOML text: a heading for each table, inline tables for the tables within."""

from collections.abc import Mapping
from decimal import Decimal
from typing import Any

import tomlkit
from tomlkit.items import AoT, InlineTable, Table

LARGE = 1e5  # written with an exponent, as 54.5e6


def to_toml(scene: Any) -> str:
    """Return the text of a file, with all digits, from which `load` reads a scene equal to this one."""
    return dumps(keys(scene))


def dumps(data: Mapping[str, Any]) -> str:
    """Return tables as text with headings and all digits."""
    text = tomlkit.document()
    for key, value in data.items():
        text[key] = _headed(value)
    return tomlkit.dumps(text)


def keys(scene: Any) -> dict[str, Any]:
    """Return the keys and values of a scene's file, without empty ones."""
    data = scene.document()
    return {key: value for key, value in data.items() if value not in ("", [], {})}


def line(key: str, value: Any) -> str:
    """Return `key = value` in one line."""
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
