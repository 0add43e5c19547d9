"""What numba does for every function that it compiles and that the kernels here do not need.

Imported where something is compiled: with all in the cache nothing here is.
"""

from __future__ import annotations

from functools import cache
from typing import Any

from numba.core import ir, types
from numba.core.extending import models, overload, register_model
from numba.core.targetconfig import TargetConfig
from numba.core.typing.npydecl import NumpyRulesArrayOperator
from numba.np import arrayobj

NO_VARIABLES = {ir.Loc, ir.Scope, ir.Const, ir.Arg, ir.Global, str, int, bool, type(None)}


def shorten() -> None:
    """Have numba do less, in this process."""
    register_model(types.Array)(OneReference)
    arrayobj.raise_with_shape_context = refuse
    overload(refuse)(_refused)
    setattr(TargetConfig, "values", values)  # noqa: B010  # methods of numba's
    setattr(NumpyRulesArrayOperator, "generic", _of_arrays)  # noqa: B010
    setattr(ir.Inst, "_rec_list_vars", variables)  # noqa: B010


class OneReference(models.ArrayModel):  # type: ignore[misc]
    """An array whose memory alone counts references: numba looks for others in shape, strides and pointers
    wherever an array is taken or dropped, a fifth of all instructions, which LLVM removes later."""

    def traverse(self, builder: Any) -> list[Any]:
        """Return the one part that has references."""
        return [part for part in super().traverse(builder) if isinstance(part[0], types.MemInfoPointer)]


def refuse(source: Any, place: Any) -> Any:
    """Say of an array that does not fit where it is put that it does not, and not what shapes the two have:
    numba compiles what makes text of numbers into all that put an array into another, a fifth of a shell's
    time. Compiled only."""


def _refused(source: Any, place: Any) -> Any:
    def refused(source: Any, place: Any) -> Any:
        raise ValueError("cannot assign slice: its shape is another")

    return refused


def values(self: Any) -> dict[str, Any]:
    """Return a function's compiler options, which are compared at every call of an operator, by name; numba
    looks each up on its own (a twentieth of the time)."""
    return _defaults(type(self)) | self._values  # type: ignore[arg-type]


@cache
def _defaults(kind: Any) -> dict[str, Any]:
    return {name: option.default for name, option in kind.options.items()}


def _of_arrays(self: Any, args: Any, kws: Any) -> Any:
    """The type of an operator on arrays; None at once for numbers, which no loop of NumPy's is looked for."""
    inside = (each.type if isinstance(each, types.Optional) else each for each in args)
    if any(isinstance(each, types.ArrayCompatible) for each in inside):
        return _of_arrays_as_numba(self, args, kws)
    return None


_of_arrays_as_numba = NumpyRulesArrayOperator.generic


def variables(self: ir.Inst, value: Any) -> list[ir.Var]:
    """Return the variables in a part of an instruction, which most parts are not looked through for."""
    if type(value) is ir.Var:
        return [value]
    if type(value) in NO_VARIABLES:
        return []
    if isinstance(value, ir.Inst):
        return value.list_vars()
    if isinstance(value, dict):
        value = value.values()
    elif not isinstance(value, list | tuple):
        return []
    return [found for part in value for found in variables(self, part)]
