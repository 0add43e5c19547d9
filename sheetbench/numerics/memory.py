"""Loads and stores that name what they reach, so that compilers vectorise loops over several arrays.

A compiler that cannot tell whether a store changes what the next spring loads takes one spring at a time, or
asks at run time, and gives up beyond some eight questions. What `load` and `store` reach by one number never
overlaps what they reach by another: they carry the scopes of LLVM's alias analysis that say so. Within one
number the compiler finds out as ever. Source: "noalias and alias.scope Metadata", LLVM Language Reference.
"""

from __future__ import annotations

from typing import Any

from numba.core import cgutils, types
from numba.core.errors import RequireLiteralValue
from numba.extending import intrinsic
from numba.np.arrayobj import make_array

KINDS = 6  # of memory, 0 to 5: what an access of one kind reaches no access of another does


def _reached(kind: Any, context: Any, builder: Any, signature: Any, args: Any) -> tuple[Any, dict[str, Any]]:
    """Pointer to an element, and the scopes of an access to it."""
    array = make_array(signature.args[1])(context, builder, args[1])
    module = builder.module
    domain = module.add_metadata(["sheetbench.numerics.memory"])
    scopes = [module.add_metadata([f"memory {other}", domain]) for other in range(KINDS)]
    own = scopes.pop(kind.literal_value)
    marks = {"alias.scope": module.add_metadata([own]), "noalias": module.add_metadata(scopes)}
    return cgutils.gep_inbounds(builder, array.data, args[2]), marks


def _marked(instruction: Any, marks: dict[str, Any]) -> Any:
    for name, mark in marks.items():
        instruction.set_metadata(name, mark)
    return instruction


def _load(_: Any, kind: Any, array: Any, i: Any) -> Any:
    """array[i] of memory of this kind."""
    if not isinstance(kind, types.IntegerLiteral):
        raise RequireLiteralValue("the kind of memory is a constant")

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer, marks = _reached(kind, context, builder, signature, args)
        return _marked(builder.load(pointer), marks)

    return array.dtype(kind, array, types.uint64), generate


def _store(_: Any, kind: Any, array: Any, i: Any, value: Any) -> Any:
    """array[i] = value in memory of this kind."""
    if not isinstance(kind, types.IntegerLiteral):
        raise RequireLiteralValue("the kind of memory is a constant")

    def generate(context: Any, builder: Any, signature: Any, args: Any) -> Any:
        pointer, marks = _reached(kind, context, builder, signature, args)
        _marked(builder.store(args[3], pointer), marks)
        return context.get_dummy_value()

    return types.none(kind, array, types.uint64, array.dtype), generate


load: Any = intrinsic(prefer_literal=True)(_load)
store: Any = intrinsic(prefer_literal=True)(_store)
