"""Loads and stores with alias scopes, so that compilers vectorise loops over several arrays.

If a store may change the operands of the next iteration, a compiler executes one iteration at a time, or adds
checks at run time, up to some eight of them. `load` and `store` take a number for their memory: memory of
different numbers never overlaps, which LLVM's alias analysis reads from the scopes. For accesses of one
number the compiler uses its ordinary analysis. Source: "noalias and alias.scope Metadata", LLVM Language
Reference.
"""

from functools import partial
from typing import Any

import numpy as np
from numba.core import cgutils, config, types
from numba.core.errors import TypingError
from numba.extending import intrinsic

from sheetbench.numerics.options import inner

KINDS = 6  # of memory, 0 to 5: memory of different kinds does not overlap


def _access(kind: Any, context: Any, builder: Any, signature: Any, args: Any) -> tuple[Any, Any]:
    """Return a function from indices to pointers, and a function that adds an access's scopes."""
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
    """Generate array[i] from memory of a kind."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer, marked = _access(kind, context, builder, signature, args)
        return marked(builder.load(pointer(args[2])))

    return array.dtype(kind, array, types.uint64), generate


def _store(_: Any, kind: Any, array: Any, i: Any, value: Any) -> Any:
    """Generate array[i] = value in memory of a kind."""

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer, marked = _access(kind, context, builder, signature, args)
        marked(builder.store(args[3], pointer(args[2])))
        return context.get_dummy_value()

    return types.none(kind, array, types.uint64, array.dtype), generate


def _load_each(_: Any, kind: Any, array: Any, i: Any, stride: Any, count: Any) -> Any:
    """Generate the tuple of `count` flat entries array[i], array[i + stride], … from memory of a kind."""
    if array.layout != "C":
        raise TypingError("the array has gaps")
    loaded = types.UniTuple(array.dtype, count.literal_value)

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        (pointer, marked), place, values = _access(kind, context, builder, signature, args), args[2], []
        for _ in range(loaded.count):
            values.append(marked(builder.load(pointer(place))))
            place = builder.add(place, args[3])
        return context.make_tuple(builder, loaded, values)

    return loaded(kind, array, types.uint64, types.uint64, count), generate


def _store_each(_: Any, kind: Any, array: Any, i: Any, stride: Any, values: Any) -> Any:
    """Generate array[i], array[i + stride], … = the values of a tuple, in memory of a kind."""
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
    """Return a new array, by one compiled function for each number of axes. numba would compile NumPy's for
    each kind of its arguments."""
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

if getattr(config, "DISABLE_JIT", False):  # in Python, if kernels are not compiled

    def load(kind: int, array: np.ndarray, i: int) -> Any:
        return load_each(kind, array, i, 0, 1)[0]

    def load_each(kind: int, array: np.ndarray, i: int, stride: int, count: int) -> Any:
        flat = array.reshape(-1)
        return tuple([flat[int(i) + n * int(stride)] for n in range(count)])

    def store(kind: int, array: np.ndarray, i: int, value: Any) -> None:
        store_each(kind, array, i, 0, (value,))

    def store_each(kind: int, array: np.ndarray, i: int, stride: int, values: Any) -> None:
        flat: np.ndarray = array.view()  # never a copy, in which a store would be lost
        flat.shape = (array.size,)
        for n, value in enumerate(values):
            flat[int(i) + n * int(stride)] = value
