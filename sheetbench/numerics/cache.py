"""Cache of results by the content of array arguments.

Meshes, patterns and orders of elimination are equal from one solution to the next, whatever the material and
the loads. Arrays of a cached result are read-only.
"""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import numpy as np

Given = ParamSpec("Given")
Found = TypeVar("Found")


def frozen(shared: Found) -> Found:
    """Make an array, or the arrays in nested tuples, read-only; return it."""
    if isinstance(shared, np.ndarray):
        shared.flags.writeable = False
    elif isinstance(shared, tuple):
        for part in shared:
            frozen(part)
    return shared


def _bytes(*given: object, **_: object) -> float:
    return sum(one.nbytes for one in given if isinstance(one, np.ndarray))


def cached(
    last: int, most: int, size: Callable[..., float] = _bytes
) -> Callable[[Callable[Given, Found]], Callable[Given, Found]]:
    """Decorate a function of arrays and hashable arguments with a cache of its `last` results, read-only.

    Results for arguments whose `size`, in bytes unless given, exceeds `most` are not cached. The function's
    attribute `forget` empties the cache.

    >>> square = cached(last=2, most=100)(lambda a: a**2)
    >>> square(np.arange(3)) is square(np.arange(3))
    True
    """

    def decorate(function: Callable[Given, Found]) -> Callable[Given, Found]:
        found: OrderedDict[object, Found] = OrderedDict()

        @wraps(function)
        def remembering(*given: Given.args, **named: Given.kwargs) -> Found:
            if size(*given, **named) > most:
                return frozen(function(*given, **named))
            key = (tuple(map(_content, given)), tuple((name, _content(one)) for name, one in named.items()))
            out = found.get(key)
            if out is None:
                out = found[key] = frozen(function(*given, **named))
                while len(found) > last:
                    found.popitem(last=False)
            return out

        remembering.forget = found.clear  # type: ignore[attr-defined]
        return remembering

    return decorate


def _content(one: object) -> object:
    return (one.shape, one.dtype.str, one.tobytes()) if isinstance(one, np.ndarray) else one
