"""Variants of a scene: values of keys of its file, each beside every value of the others.

A key is written as in the file with dots between, entries of a list by their number: `sheet.thickness`,
`load.2.value`, `support1.tilt`, `gravity.acceleration.3`. A value is what the file may hold there, with a
unit of its own or not; `a..b:n` stands for n of them from a to b at equal distances.
"""

from __future__ import annotations

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
    """A scene and what was varied: values in SI units by key."""

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
    """Return a scene for every combination of values, the last key's values the quickest to change.

    vary: texts KEY=VALUES. Raises BadInput for what cannot be read, SceneError for a scene that cannot be.
    """
    listed: dict[str, list[Any]] = {}
    for text in vary:
        key, equals, values = text.partition("=")
        if not equals or key.strip() in listed or not (found := _values(key, values)):
            raise BadInput(
                f"--vary = '{text}': write each key once, as sheet.thickness=1mm,2mm or KEY=a..b:5"
            )
        listed[key.strip()] = found
    if not listed:
        raise BadInput("--vary: nothing to vary; write KEY=a,b,c, as sheet.thickness=1mm,2mm")
    if (count := int(np.prod([len(values) for values in listed.values()]))) > MOST:
        raise BadInput(f"--vary: {count} variants, at most {MOST} are solved")
    return [_variant(scene, dict(zip(listed, values, strict=True))) for values in product(*listed.values())]


def unit_of(key: str) -> str:
    """Return the SI unit of a key's values, "" where it has none."""
    return unit_at(_path(key), json_schema(Scene)) or ""


def _values(key: str, text: str) -> list[Any]:
    """Return the values that a text lists; brackets hold those together that are one list."""
    found: list[Any] = []
    for part in filter(None, map(str.strip, re.split(r",(?![^\[]*\])", text))):
        if (between := _RANGE.fullmatch(part)) is None:
            found.append(_value(part))
            continue
        first, unit, last, other, count = between.groups()
        if (unit and unit != other) or not 2 <= int(count) <= MOST:
            raise BadInput(f"--vary {key} = '{part}': write a..b:n, both in one unit, n from 2 to {MOST}")
        numbers = np.linspace(float(first), float(last), int(count)).tolist()
        found += [f"{x:.12g} {other}" if other else float(f"{x:.12g}") for x in numbers]
    return found


def _value(text: str) -> Any:
    """Return a number, a list, true or false as JSON has them, any other text as it is."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return text


def _path(key: str) -> Path:
    parts = re.sub(r"(?<=[a-z])(\d+)(?=\.)", r".\1", key.strip()).split(".")
    return tuple(int(part) - 1 if part.isdecimal() else part for part in parts)


def _variant(scene: Scene, values: Mapping[str, Any]) -> Variant:
    """Return the scene with other values. Raises SceneError where it cannot be."""
    data, chosen = scene.document(), scene.model_dump(by_alias=True, exclude_defaults=True)
    if scene.replace(probes={}).probes == scene.probes:
        del data["probes"]  # chosen by the outline
    said = ", ".join(f"{key} = {value}" for key, value in values.items())
    for key, value in values.items():
        *place, last = _path(key)
        if last == "kind":  # the defaults of another one are not of this
            table = _get(data, place, {})
            for name in set(table) - set(_get(chosen, place, table)):
                del table[name]
        _put(data, key, value)
    try:
        found = Scene.model_validate(data)
    except ValidationError as error:
        raise SceneError(f"--vary {said}: {in_one_line(error, Scene)}") from None
    document = found.document()
    return Variant(found, {key: _get(document, _path(key), value) for key, value in values.items()})


def _put(data: Any, key: str, value: Any) -> None:
    """Put a value at its place in a scene's document; a table that is not there yet is made."""
    *path, last = _path(key)
    of = data
    for part in path:
        named = isinstance(of, dict) and isinstance(part, str)
        of = of.setdefault(part, {}) if named else _entry(of, part, key)
    if not (isinstance(of, dict) and isinstance(last, str)):
        _entry(of, last, key)
    of[last] = value


def _entry(of: Any, part: str | int, key: str) -> Any:
    if not isinstance(of, list) or not isinstance(part, int) or not 0 <= part < len(of):
        raise BadInput(f"--vary {key}: the scene has no such entry; lists count from 1, as support.1.tilt")
    return of[part]


def _get(document: Any, path: Iterable[str | int], usual: Any) -> Any:
    """Return the value at a place, the usual one where there is none."""
    for part in path:
        try:
            document = document[part]
        except (KeyError, IndexError, TypeError):
            return usual
    return document
