"""Validated numbers with their units, and the frozen base of every scene object. All are in SI units.

No number is larger than `LARGEST` in magnitude, and what must be positive not smaller than `SMALLEST`: beyond
them nothing is meant, and the products and quotients of the mechanics would overflow.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import Annotated, Any, Self

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    GetJsonSchemaHandler,
    Strict,
    ValidationError,
)
from pydantic_core import PydanticCustomError

from sheetbench.scenes.errors import BadInput, SceneError
from sheetbench.scenes.refusals import in_one_line
from sheetbench.scenes.schema import sentences

SMALLEST, LARGEST = 1e-12, 1e15  # E of a diamond is 1e12 Pa


def require_positive(name: str, value: object, unit: str) -> None:
    """Raise BadInput unless a value is left out (None) or a positive number within bounds."""
    if value is None:
        return
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise BadInput(f"{name} = {value!r}: must be a number [{unit}]")
    if not (value > 0 and isfinite(value)):
        raise BadInput(f"{name} = {value:g} {unit}: must be greater than 0 and finite")
    if not SMALLEST <= value <= LARGEST:
        raise BadInput(f"{name} = {value:g} {unit}: must be between {SMALLEST:g} and {LARGEST:g}")


def _not_too_large(value: float) -> float:
    if abs(value) > LARGEST:
        raise PydanticCustomError("too_large", "too large", {"largest": LARGEST})
    return value


def _not_too_small(value: float) -> float:
    if value < SMALLEST:
        raise PydanticCustomError("too_small", "too small", {"smallest": SMALLEST})
    return _not_too_large(value)


Finite = Annotated[float, Strict(), Field(allow_inf_nan=False)]
Number = Annotated[Finite, AfterValidator(_not_too_large)]
Positive = Annotated[Finite, Field(gt=0), AfterValidator(_not_too_small)]
NonNegative = Annotated[Finite, Field(ge=0), AfterValidator(_not_too_large)]
Vector3 = tuple[Number, Number, Number]
PlanPoint = tuple[Number, Number]


@dataclass(frozen=True)
class Unit:
    """The SI unit of a number or of every number in a list; it stands as `unit` in the JSON Schema."""

    symbol: str

    def __get_pydantic_json_schema__(self, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {**handler(core), "unit": self.symbol}


class Frozen(BaseModel):
    """Base of the scene objects: immutable, and unknown keys are refused.

    A sentence below each key says what it is and which sign it has; the JSON Schema, the reference page
    (docs/scene.md) and the files that `sheetbench new` writes are made of these. Objects built with values
    that make no sense raise SceneError, in one line; values without a name are the keys in their order.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", populate_by_name=True)

    def __init__(self, *values: Any, **keys: Any) -> None:
        names = list(type(self).model_fields)
        if len(values) > len(names):
            raise TypeError(f"{type(self).__name__} has {len(names)} keys: {', '.join(names)}")
        for name, value in zip(names, values, strict=False):
            if name in keys:
                raise TypeError(f"{type(self).__name__}: {name} is given twice")
            keys[name] = value
        try:
            super().__init__(**keys)
        except ValidationError as error:
            raise SceneError(f"{type(self).__name__}: {in_one_line(error, type(self))}") from None

    def replace(self, **values: Any) -> Self:
        """The same with other values for some keys. Raises SceneError for what makes no sense."""
        kept = {name: getattr(self, name) for name in type(self).model_fields}
        return type(self)(**{**kept, **values})

    # what is read from a file or lies within another object is built without the above, so that the whole
    # scene's faults are told together
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def __get_pydantic_json_schema__(cls, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        schema = handler(core)
        keys = handler.resolve_ref_schema(schema).get("properties", {})
        for name, field in cls.model_fields.items():  # pydantic would read the sources at every import
            if name in (said := sentences(cls)):
                keys[field.alias or name]["description"] = said[name]
        return schema
