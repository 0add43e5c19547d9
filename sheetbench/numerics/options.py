"""Named tuples of arrays that compiled functions take quickly.

numba finds the type of an argument at every call: of an array in a tenth of a microsecond, of every named
tuple in one and more. A tuple that carries its type is taken at once; its arrays are unpacked at every call,
0.2 µs each, except those behind a `Pointer`.
"""

from __future__ import annotations

from functools import partial
from typing import Any, Generic, NamedTuple, TypeVar, cast

import numba
import numpy as np
from numba import typeof
from numba.core import config, types
from numba.experimental import structref
from numba.extending import register_jitable, typeof_impl

import sheetbench.kernels  # noqa: F401  # cache of compiled kernels

# equal for all functions, since numba compiles a function again for callers with other options; no wrappers
# for C, a tenth of the time for compiling
COMMON: dict[str, Any] = {"error_model": "numpy", "nogil": True, "no_cfunc_wrapper": True}
REORDERED = {"reassoc", "contract", "nsz"}  # sums in any order, for vector instructions; infinities count
njit: Any = partial(numba.njit, cache=True, **COMMON)
inner: Any = partial(register_jitable, **COMMON)  # compiled for compiled callers alone
T = TypeVar("T", bound=tuple[Any, ...])
_TYPES: dict[Any, Any] = {}


class TypedTuple(tuple[Any, ...]):
    """Tuple without names in Python that compiled functions take as the named tuple of its values."""

    _numba_type_: Any


@typeof_impl.register(TypedTuple)
def _typeof(value: TypedTuple, context: Any) -> Any:
    return value._numba_type_


def typed(value: T) -> T:
    """Return a named tuple of arrays, numbers and typed tuples with its type, for compiled functions."""
    if config.DISABLE_JIT:  # type: ignore[attr-defined]  # made from the environment
        return value
    if (key := _key(value)) not in _TYPES:
        _TYPES[key] = typeof(value)
    typed_tuple = TypedTuple(value)
    typed_tuple._numba_type_ = _TYPES[key]
    return cast(T, typed_tuple)


class Pointer(NamedTuple, Generic[T]):
    """A named tuple that compiled functions take by a pointer."""

    value: T


_pointer: Any = Pointer
if not config.DISABLE_JIT:  # type: ignore[attr-defined]

    @structref.register
    class PointerType(types.StructRef):  # type: ignore[misc]
        """Type of `Pointer` in compiled functions."""

    class PointerProxy(structref.StructRefProxy):
        """`Pointer` as Python gets it from compiled functions."""

    structref.define_proxy(PointerProxy, PointerType, ["value"])
    _pointer = PointerProxy


@njit
def pointer(value: T) -> Pointer[T]:
    """Return a named tuple for compiled functions, which take it by a pointer."""
    return _pointer(value)  # type: ignore[no-any-return]


def _key(value: Any) -> Any:
    if isinstance(value, TypedTuple):
        return id(value._numba_type_)  # cached, since the hash of a type hashes all its parts
    if isinstance(value, tuple):
        return type(value), *map(_key, value)
    return (value.dtype, value.ndim, value.flags.num) if isinstance(value, np.ndarray) else type(value)
