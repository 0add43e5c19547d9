"""Arguments of functions of `import sheetbench`, refused by name where there are none, as options are."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from inspect import Signature
from typing import Any

from sheetbench.errors import BadInput

ALSO = {"lumped": "grid"}  # names of one option, as on the command line


def bound(name: str, own: Signature, values: tuple[Any, ...], named: Mapping[str, Any]) -> dict[str, Any]:
    """Return all arguments of a call by name, defaults too; other names of `ALSO` by the usual one. Raises
    BadInput for arguments that the function does not have and for those that are missing."""
    given = dict(named)
    for other, usual in ALSO.items():
        if other in given and other not in own.parameters and usual in own.parameters:
            if usual in given:
                raise BadInput(f"{name}: {other} and {usual} are one; give one of them")
            given[usual] = given.pop(other)
    try:
        found = own.bind(*values, **given)
    except TypeError as error:
        raise BadInput(f"{name}: {_why(error, given, list(own.parameters))}") from None
    found.apply_defaults()
    return dict(found.arguments)


def _why(error: TypeError, named: dict[str, Any], known: list[str]) -> str:
    """Return what is wrong with the arguments, in words."""
    unknown = [one for one in named if one not in known]
    if not unknown:
        return str(error)
    near = get_close_matches(unknown[0], known, 1)
    meant = f"; did you mean {near[0]}?" if near else ""
    return f"no keyword '{unknown[0]}'; it has {', '.join(known)}{meant}"
