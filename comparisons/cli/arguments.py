"""Conversion of a command's arguments: items of lists, and values of calls in Python."""

from __future__ import annotations

import json
import re
import reprlib
from collections.abc import Callable, Mapping
from inspect import Parameter
from numbers import Number
from os import PathLike
from pathlib import Path
from typing import Annotated, Any, get_args, get_origin

from comparisons.cli.options import Kind

SIZE = "int | Sequence[int] | str"
IN_PYTHON = {  # types accepted in Python, by the parameter's name or metavar
    "measured": "Displacements | str | Path",
    **dict.fromkeys(("SCENE", "SCENES"), "Scene | str | Path"),
    **dict.fromkeys(("GRID", "GRIDS", "N", "N,N,N", "ELEMENTS"), SIZE),
    **dict.fromkeys(("DIR", "FILE", "FILES"), "str | Path"),
    **dict.fromkeys(("MODEL", "MODELS"), "Spec | str"),
    **{"CELL": "Cell | str", "G": "Grading | float | str", "M": "float | Sequence[float] | str"},
}
OURS = ("sheetbench", "comparisons", "lumped", "fem_reference")  # packages


def kind_of(parameter: Parameter) -> Kind:
    """Return the Kind of a parameter."""
    metadata = getattr(parameter.annotation, "__metadata__", ())
    return next((entry for entry in metadata if isinstance(entry, Kind)), Kind())


def plain(parameter: Parameter) -> Parameter:
    """Return a parameter without its Kind and its typer settings."""
    annotation = parameter.annotation
    if get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    return parameter.replace(annotation=annotation)


def in_python(parameter: Parameter, metavar: str | None) -> Parameter:
    """Return a parameter with the types that it accepts in Python; metavar: name of its value."""
    annotation = plain(parameter).annotation
    if isinstance(annotation, str):
        return parameter
    text, metavar = str(annotation), (metavar or "").strip("[]")
    accepted = next((kind for kind in ("int", "bool", "float") if kind in text), "str")
    if "tuple" in text:
        accepted = "tuple[float, float]"
    elif accepted == "float":
        accepted = "float | str"
    elif accepted == "str":
        accepted = IN_PYTHON.get(parameter.name) or IN_PYTHON.get(
            metavar, "str | Path" if "Path" in text else "str"
        )
    if "list[" in text:
        mapping = "Mapping[str, Any] | " if "=" in metavar or metavar == "FILES" else ""
        accepted = f"{mapping}Sequence[{accepted}] | {accepted}"
    return parameter.replace(annotation=f"{accepted} | None" if "None" in text else accepted)


def conversion(parameter: Parameter, separator: str | None = None) -> Callable[[Any], Any]:
    """Return a function that converts an argument in Python to a parsed option; separator: of lists."""
    kind = str(plain(parameter).annotation)
    unit = kind_of(parameter).unit

    def convert(value: Any) -> Any:
        if value is None:
            return None
        if unit is not None or kind in ("<class 'float'>", "float | None"):
            from sheetbench.scenes.language.units import amount

            return amount(parameter.name, value, unit or "")
        if kind.startswith("list["):
            return items_of(parameter.name, value, separator)
        if "Path" in kind and isinstance(value, str):
            return Path(value)
        return value if "tuple" in kind else _single(parameter.name, value, numbers="Path" not in kind)

    return convert


def items_of(name: str, value: Any, separator: str | None) -> list[Any]:
    """Return the items of a list argument; a single value counts as a list.

    Texts are split at the separator; a mapping becomes texts key=value or key=a,b; numbers become texts as 9
    or 9x5, paths texts; objects of our packages stay unchanged.
    """
    value = [f"{key}={_listed(v)}" for key, v in value.items()] if isinstance(value, Mapping) else value
    items: list[Any] = []
    for item in value if isinstance(value, list | tuple) else [value]:
        item = _single(name, item)
        if isinstance(item, str) and separator is not None:
            items += filter(None, map(str.strip, re.split(separator, item)))
        elif isinstance(item, str) or type(item).__module__.startswith(OURS):
            items.append(item)
        else:
            items.append("x".join(map(str, item)) if isinstance(item, list | tuple) else str(item))
    return items


def _listed(values: Any) -> str:
    """Return a mapping's value as text, items of lists and arrays separated by commas."""
    items = getattr(values, "tolist", lambda: values)()
    items = items if isinstance(items, list | tuple) else [items]
    return ",".join(item if isinstance(item, str) else json.dumps(item, default=str) for item in items)


def _single(name: str, value: Any, numbers: bool = True) -> Any:
    """Return a value that is a text, a path, an object of our packages, or with `numbers` one or several
    numbers. Raises BadInput for other types."""
    if isinstance(value, str | PathLike) or type(value).__module__.startswith(OURS):
        return value
    items = value if value and isinstance(value, list | tuple) else [value]
    if numbers and all(isinstance(item, Number) for item in items):
        return value
    from sheetbench.errors import BadInput

    raise BadInput(f"{name} = {reprlib.repr(value)}: a {type(value).__name__} is not accepted")
