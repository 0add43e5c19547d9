"""Arguments of a command: items of lists, and values in Python as the command takes them."""

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
IN_PYTHON = {  # what else than a text is taken, by the parameter's name or what its value is called
    "measured": "Displacements | str | Path",
    **dict.fromkeys(("SCENE", "SCENES"), "Scene | str | Path"),
    **dict.fromkeys(("GRID", "GRIDS", "N", "N,N,N", "ELEMENTS"), SIZE),
    **dict.fromkeys(("DIR", "FILE", "FILES"), "str | Path"),
    **dict.fromkeys(("MODEL", "MODELS"), "Spec | str"),
    **{"CELL": "Cell | str", "G": "Grading | float | str", "M": "float | Sequence[float] | str"},
}
OURS = ("sheetbench", "comparisons", "lumped", "fem_reference")  # packages


def kind_of(parameter: Parameter) -> Kind:
    """Return what an option takes beyond its type."""
    more = getattr(parameter.annotation, "__metadata__", ())
    return next((one for one in more if isinstance(one, Kind)), Kind())


def plain(parameter: Parameter) -> Parameter:
    """Return a parameter without its Kind and what typer reads of it."""
    annotation = parameter.annotation
    if get_origin(annotation) is Annotated:
        annotation = get_args(annotation)[0]
    return parameter.replace(annotation=annotation)


def in_python(parameter: Parameter, metavar: str | None) -> Parameter:
    """Return a parameter with the types that it takes in Python; metavar: what its value is called."""
    own = plain(parameter).annotation
    if isinstance(own, str):
        return parameter
    text, called = str(own), (metavar or "").strip("[]")
    taken = next((kind for kind in ("int", "bool", "float") if kind in text), "str")
    if "tuple" in text:
        taken = "tuple[float, float]"
    elif taken == "float":
        taken = "float | str"
    elif taken == "str":
        taken = IN_PYTHON.get(parameter.name) or IN_PYTHON.get(
            called, "str | Path" if "Path" in text else "str"
        )
    if "list[" in text:
        mapped = "Mapping[str, Any] | " if "=" in called or called == "FILES" else ""
        taken = f"{mapped}Sequence[{taken}] | {taken}"
    return parameter.replace(annotation=f"{taken} | None" if "None" in text else taken)


def conversion(parameter: Parameter, separator: str | None = None) -> Callable[[Any], Any]:
    """Return the conversion of an argument in Python to what the terminal makes of an option's text;
    separator: of a list's items."""
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
    """Return the items of a list: of one that is given alone, of a mapping as key=value or key=a,b; texts in
    parts at the separator, numbers as 9 or 9x5, paths as text, objects of ours as they are."""
    value = [f"{key}={_listed(one)}" for key, one in value.items()] if isinstance(value, Mapping) else value
    found: list[Any] = []
    for one in value if isinstance(value, list | tuple) else [value]:
        one = _single(name, one)
        if isinstance(one, str) and separator is not None:
            found += filter(None, map(str.strip, re.split(separator, one)))
        elif isinstance(one, str) or type(one).__module__.startswith(OURS):
            found.append(one)
        else:
            found.append("x".join(map(str, one)) if isinstance(one, list | tuple) else str(one))
    return found


def _listed(values: Any) -> str:
    """Return a mapping's value as text: of a list or an array its items with commas between."""
    each = getattr(values, "tolist", lambda: values)()
    each = each if isinstance(each, list | tuple) else [each]
    return ",".join(one if isinstance(one, str) else json.dumps(one, default=str) for one in each)


def _single(name: str, value: Any, numbers: bool = True) -> Any:
    """Return a text, a path, an object of ours, or where they may be one or several numbers. Raises BadInput
    for any other."""
    if isinstance(value, str | PathLike) or type(value).__module__.startswith(OURS):
        return value
    each = value if value and isinstance(value, list | tuple) else [value]
    if numbers and all(isinstance(one, Number) for one in each):
        return value
    from sheetbench.errors import BadInput

    raise BadInput(f"{name} = {reprlib.repr(value)}: a {type(value).__name__} is not taken")
