"""Variants of a scene: all combinations of values of some keys of its file.

A key is written as in the file, its parts joined by dots and entries of a list by number: `sheet.thickness`,
`load.2.value`, `support1.tilt`, `gravity.acceleration.3`. A value is any valid value of the file, with or
without a unit; `a..b:n` stands for n equally spaced values from a to b.
"""

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from pydantic import ValidationError

from sheetbench.answers.table import quantity
from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes import Scene
from sheetbench.scenes.language.refusals import in_one_line, unit_at
from sheetbench.scenes.language.schema import json_schema

_NUMBER = r"[-+]?[\d.]+(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"({_NUMBER})\s*(\S*?)\s*\.\.\s*({_NUMBER})\s*(\S*?)\s*:\s*(\d+)")
MOST = 10_000  # variants
Path = tuple[str | int, ...]


@dataclass(frozen=True)
class Variant:
    """A scene and its varied values in SI units, by key."""

    scene: Scene
    varied: dict[str, Any]

    def __str__(self) -> str:
        return in_words(self.varied)


def in_words(varied: Mapping[str, Any]) -> str:
    """Return values by key with their units."""
    return ", ".join(
        f"{key} = {quantity(value, unit_of(key)) if type(value) in (int, float) else value}"
        for key, value in varied.items()
    )


def variants(scene: Scene, vary: Sequence[str]) -> list[Variant]:
    """Return a scene for every combination of values; the last key varies fastest. vary: texts KEY=VALUES.
    Raises BadInput for an invalid text, SceneError for an invalid scene."""
    listed: dict[str, list[Any]] = {}
    for text in vary:
        key, equals, values = text.partition("=")
        if not equals or key.strip() in listed or not (parsed := _values(key, values)):
            raise BadInput(
                f"--vary = '{text}': write each key once, as sheet.thickness=1mm,2mm or KEY=a..b:5"
            )
        listed[key.strip()] = parsed
    if not listed:
        raise BadInput("--vary: nothing to vary; write KEY=a,b,c, as sheet.thickness=1mm,2mm")
    if (count := int(np.prod([len(values) for values in listed.values()]))) > MOST:
        raise BadInput(f"--vary: {count} variants, at most {MOST} are solved")
    return [_variant(scene, dict(zip(listed, values, strict=True))) for values in product(*listed.values())]


def unit_of(key: str) -> str:
    """Return the SI unit of a key's values, "" without one."""
    return unit_at(_path(key), json_schema(Scene)) or ""


def _values(key: str, text: str) -> list[Any]:
    """Return the values listed in a text; a list as one value is in brackets."""
    out: list[Any] = []
    for part in filter(None, map(str.strip, re.split(r",(?![^\[]*\])", text))):
        if (match := _RANGE.fullmatch(part)) is None:
            out.append(_value(part))
            continue
        first, unit, last, other, count = match.groups()
        if (unit and unit != other) or not 2 <= int(count) <= MOST:
            raise BadInput(f"--vary {key} = '{part}': write a..b:n, both in one unit, n from 2 to {MOST}")
        numbers = np.linspace(float(first), float(last), int(count)).tolist()
        out += [f"{x:.12g} {other}" if other else float(f"{x:.12g}") for x in numbers]
    return out


def _value(text: str) -> Any:
    """Return the value of a JSON text, any other text unchanged."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text


def _path(key: str) -> Path:
    parts = re.sub(r"(?<=[a-z])(\d+)(?=\.)", r".\1", key.strip()).split(".")
    return tuple(int(part) - 1 if part.isdecimal() else part for part in parts)


def _variant(scene: Scene, values: Mapping[str, Any]) -> Variant:
    """Return the scene with other values. Raises SceneError for an invalid scene."""
    data, given = scene.document(), scene.model_dump(by_alias=True, exclude_defaults=True)
    if scene.replace(probes={}).probes == scene.probes:
        del data["probes"]  # default probes depend on the outline
    text = ", ".join(f"{key} = {value}" for key, value in values.items())
    for key, value in values.items():
        *path, last = _path(key)
        if last == "kind":  # another kind has other defaults
            table = _get(data, path, {})
            for name in set(table) - set(_get(given, path, table)):
                del table[name]
        _put(data, key, value)
    try:
        variant = Scene.model_validate(data)
    except ValidationError as error:
        raise SceneError(f"--vary {text}: {in_one_line(error, Scene)}") from None
    document = variant.document()
    return Variant(variant, {key: _get(document, _path(key), value) for key, value in values.items()})


def _put(data: Any, key: str, value: Any) -> None:
    """Put a value into a scene's document; missing tables are made."""
    *path, last = _path(key)
    node = data
    for part in path:
        is_table = isinstance(node, dict) and isinstance(part, str)
        node = node.setdefault(part, {}) if is_table else _entry(node, part, key)
    if not (isinstance(node, dict) and isinstance(last, str)):
        _entry(node, last, key)
    node[last] = value


def _entry(node: Any, part: str | int, key: str) -> Any:
    if not isinstance(node, list) or not isinstance(part, int) or not 0 <= part < len(node):
        raise BadInput(f"--vary {key}: the scene has no such entry; lists count from 1, as support.1.tilt")
    return node[part]


def _get(document: Any, path: Iterable[str | int], default: Any) -> Any:
    """Return the value at a path of a document, the default if there is none."""
    for part in path:
        try:
            document = document[part]
        except (KeyError, IndexError, TypeError):
            return default
    return document
