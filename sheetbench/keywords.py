"""Functions of `import sheetbench` refuse what does not exist by name, as the terminal does its options."""

from __future__ import annotations

from collections.abc import Callable
from difflib import get_close_matches
from functools import cache, wraps
from inspect import Parameter, signature
from typing import Any

from sheetbench.errors import BadInput

ALSO = {"lumped": "grid", "method": "calibration"}  # names of one option, as on the command line


@cache
def in_words(name: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """Return the function; it raises BadInput for arguments that it does not have and for those that are
    missing, and takes the other names of `ALSO`."""
    own = signature(function)
    kinds = {one.kind for one in own.parameters.values()}
    others = {} if Parameter.VAR_KEYWORD in kinds else ALSO

    @wraps(function)
    def run(*values: Any, **named: Any) -> Any:
        for other, usual in others.items():
            if other in named and other not in own.parameters and usual in own.parameters:
                if usual in named:
                    raise BadInput(f"{name}: {other} and {usual} are one; give one of them")
                named[usual] = named.pop(other)
        try:
            own.bind(*values, **named)
        except TypeError as error:
            raise BadInput(f"{name}: {_why(error, named, list(own.parameters))}") from None
        return function(*values, **named)

    return run


def _why(error: TypeError, named: dict[str, Any], known: list[str]) -> str:
    """Return what is wrong with the arguments, in words."""
    unknown = [one for one in named if one not in known]
    if not unknown:
        return str(error)
    near = get_close_matches(unknown[0], known, 1)
    meant = f"; did you mean {near[0]}?" if near else ""
    return f"no keyword '{unknown[0]}'; it has {', '.join(known)}{meant}"
