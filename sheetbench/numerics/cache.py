"""Cache of results by the content of array arguments.

Meshes, patterns and orders of elimination do not change from one solution to the next with the material and
the loads. Arrays of a cached result are read-only.
"""

from collections import OrderedDict
from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

import numpy as np

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


def frozen(result: Result) -> Result:
    """Make an array, or the arrays in nested tuples, read-only; return it."""
    if isinstance(result, np.ndarray):
        result.flags.writeable = False
    elif isinstance(result, tuple):
        for part in result:
            frozen(part)
    return result


def _bytes(*arguments: object, **_: object) -> float:
    return sum(argument.nbytes for argument in arguments if isinstance(argument, np.ndarray))


def cached(
    last: int, most: int, size: Callable[..., float] = _bytes
) -> Callable[[Callable[Arguments, Result]], Callable[Arguments, Result]]:
    """Decorate a function of arrays and hashable arguments with a cache of its `last` results, which are
    read-only.

    Results for arguments whose `size`, in bytes unless given, exceeds `most` are not cached. The function's
    attribute `forget` empties the cache.

    >>> square = cached(last=2, most=100)(lambda a: a**2)
    >>> square(np.arange(3)) is square(np.arange(3))
    True
    """

    def decorate(function: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
        results: OrderedDict[object, Result] = OrderedDict()

        @wraps(function)
        def remembering(*values: Arguments.args, **named: Arguments.kwargs) -> Result:
            if size(*values, **named) > most:
                return frozen(function(*values, **named))
            key = (tuple(map(_content, values)), tuple((name, _content(v)) for name, v in named.items()))
            result = results.get(key)
            if result is None:
                result = results[key] = frozen(function(*values, **named))
                while len(results) > last:
                    results.popitem(last=False)
            return result

        remembering.forget = results.clear  # type: ignore[attr-defined]
        return remembering

    return decorate


def _content(value: object) -> object:
    return (value.shape, value.dtype.str, value.tobytes()) if isinstance(value, np.ndarray) else value
