"""Loads and stores that name what they reach, so that compilers vectorise loops over several arrays.

A compiler that cannot tell whether a store changes what the next spring loads takes one spring at a time, or
asks at run time, and gives up beyond some eight questions. What `load` and `store` reach by one number never
overlaps what they reach by another: they carry the scopes of LLVM's alias analysis that say so. Within one
number the compiler finds out as ever. Source: "noalias and alias.scope Metadata", LLVM Language Reference.
"""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from numba.core import cgutils, config, types
from numba.core.errors import TypingError
from numba.extending import intrinsic

from sheetbench.numerics.options import inner

KINDS = 6  # of memory, 0 to 5: what an access of one kind reaches no access of another does


def _access(kind: Any, context: Any, builder: Any, signature: Any, args: Any) -> tuple[Any, Any]:
    """A function from places to pointers, and one that marks an instruction with the scopes of an access."""
    array = context.make_array(signature.args[1])(context, builder, args[1])
    module = builder.module
    domain = module.add_metadata(["sheetbench.numerics.aliasing"])
    scopes = [module.add_metadata([f"memory {other}", domain]) for other in range(KINDS)]
    own = scopes.pop(kind.literal_value)

    def marked(instruction: Any) -> Any:
        instruction.set_metadata("alias.scope", module.add_metadata([own]))
        instruction.set_metadata("noalias", module.add_metadata(scopes))
        return instruction

    return partial(cgutils.gep_inbounds, builder, array.data), marked


def _load(_: Any, kind: Any, array: Any, i: Any) -> Any:
    """array[i] of memory of this kind."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer, marked = _access(kind, context, builder, signature, args)
        return marked(builder.load(pointer(args[2])))

    return array.dtype(kind, array, types.uint64), generate


def _store(_: Any, kind: Any, array: Any, i: Any, value: Any) -> Any:
    """array[i] = value in memory of this kind."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer, marked = _access(kind, context, builder, signature, args)
        marked(builder.store(args[3], pointer(args[2])))
        return context.get_dummy_value()

    return types.none(kind, array, types.uint64, array.dtype), generate


def _load_each(_: Any, kind: Any, array: Any, i: Any, apart: Any, count: Any) -> Any:
    """array[i], array[i + apart], …, so many, flat, as a tuple, of memory of this kind."""
    if array.layout != "C":
        raise TypingError("the array has gaps")
    found = types.UniTuple(array.dtype, count.literal_value)

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        (pointer, marked), place, values = _access(kind, context, builder, signature, args), args[2], []
        for _ in range(found.count):
            values.append(marked(builder.load(pointer(place))))
            place = builder.add(place, args[3])
        return context.make_tuple(builder, found, values)

    return found(kind, array, types.uint64, types.uint64, count), generate


def _store_each(_: Any, kind: Any, array: Any, i: Any, apart: Any, values: Any) -> Any:
    """array[i], array[i + apart], … = the values of a tuple, in memory of this kind."""
    given = types.UniTuple(array.dtype, len(values))

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        (pointer, marked), place = _access(kind, context, builder, signature, args), args[2]
        for n in range(given.count):
            marked(builder.store(builder.extract_value(args[4], n), pointer(place)))
            place = builder.add(place, args[3])
        return context.get_dummy_value()

    return types.none(kind, array, types.uint64, types.uint64, given), generate


@inner()
def empty(shape: Any, dtype: Any = np.float64) -> np.ndarray:
    """Return a new array; of one compiled function for all shapes of so many axes, where numba compiles
    NumPy's for each kind of its arguments."""
    return np.empty(shape, dtype)


@inner()
def zeros(shape: Any, dtype: Any = np.float64) -> np.ndarray:
    """Return a new array of zeros, as `empty`; a loop that fills it takes four times as long."""
    return np.zeros(shape, dtype)


constant: Any = intrinsic(prefer_literal=True)  # kinds and counts: types of literals are tried first
load: Any = constant(_load)
load_each: Any = constant(_load_each)
store: Any = constant(_store)
store_each: Any = constant(_store_each)

if getattr(config, "DISABLE_JIT", False):  # the same in Python, where kernels are not compiled

    def load(kind: int, array: np.ndarray, i: int) -> Any:
        return load_each(kind, array, i, 0, 1)[0]

    def load_each(kind: int, array: np.ndarray, i: int, apart: int, count: int) -> Any:
        flat = array.reshape(-1)
        return tuple([flat[int(i) + n * int(apart)] for n in range(count)])

    def store(kind: int, array: np.ndarray, i: int, value: Any) -> None:
        store_each(kind, array, i, 0, (value,))

    def store_each(kind: int, array: np.ndarray, i: int, apart: int, values: Any) -> None:
        flat: np.ndarray = array.view()  # never a copy, in which a store would be lost
        flat.shape = (array.size,)
        for n, value in enumerate(values):
            flat[int(i) + n * int(apart)] = value
