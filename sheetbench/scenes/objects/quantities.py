"""Validated numbers with their units, and the frozen base of every scene object. All are in SI units.

No number is larger than `LARGEST` in magnitude, and what must be positive not smaller than `SMALLEST`: beyond
them nothing is meant, and the products and quotients of the mechanics would overflow.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from inspect import Parameter, Signature
from math import isfinite
from typing import Annotated, Any, Self, dataclass_transform, get_type_hints

from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Discriminator,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    Strict,
    Tag,
    ValidationError,
)
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, PydanticCustomError
from pydantic_core.core_schema import no_info_before_validator_function

from sheetbench.errors import BadInput, SceneError
from sheetbench.scenes.language.refusals import in_one_line
from sheetbench.scenes.language.schema import sentences
from sheetbench.scenes.language.units import converted

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


def _form(value: Any) -> str:
    if isinstance(value, dict | BaseModel):
        return "a table"
    return "a list" if isinstance(value, list | tuple) else "a number"


# of a key that takes a number, a list or a table: which of them a value is
FORM = Discriminator(_form)
A_NUMBER, A_LIST, A_TABLE = Tag("a number"), Tag("a list"), Tag("a table")


@dataclass(frozen=True)
class Unit:
    """The SI unit of a number or of every number in a list; it stands as `unit` in the JSON Schema.

    The number may be text with a unit of its own, as "2 mm" (`sheetbench.scenes.language.units`).
    """

    symbol: str

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return no_info_before_validator_function(lambda value: converted(value, self.symbol), handler(source))

    def __get_pydantic_json_schema__(self, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {**handler(core), "unit": self.symbol}


Length = Annotated[Positive, Unit("m")]
Angle = Annotated[Number, Unit("rad")]
Modulus = Annotated[Positive, Unit("Pa")]
Density = Annotated[Positive, Unit("kg/m³")]
PoissonRatio = Annotated[Finite, Field(gt=-1, lt=0.5)]  # of what is isotropic


@dataclass_transform(frozen_default=True, field_specifiers=(Field,))
class Frozen(BaseModel, frozen=True):
    """Base of the scene objects: immutable, and unknown keys are refused.

    A sentence below each key says what it is and which sign it has; the JSON Schema, the reference page
    (docs/scene.md) and the files that `sheetbench new` writes are made of these. Objects built with values
    that make no sense raise SceneError, in one line; values without a name are the keys in their order, but
    for those that are keyword-only (`kind`, `title`, `history`, `motion`).
    """

    model_config = ConfigDict(extra="forbid", populate_by_name=True)

    def __init__(self, *values: Any, **keys: Any) -> None:
        names = [name for name, field in type(self).model_fields.items() if not field.kw_only]
        if len(values) > len(names):
            raise TypeError(f"{type(self).__name__} takes {len(names)} values by place: {', '.join(names)}")
        for name, value in zip(names, values, strict=False):
            if name in keys:
                raise TypeError(f"{type(self).__name__}: {name} is given twice")
            keys[name] = value
        try:
            super().__init__(**keys)
        except ValidationError as error:
            raise SceneError(f"{type(self).__name__}: {in_one_line(error, type(self))}") from None

    # what is read from a file or lies within another object is built without the above, so that the whole
    # scene's faults are reported together
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        cls.__signature__ = _signature(cls.model_fields)

    def __setattr__(self, name: str, value: Any) -> None:
        raise SceneError(
            f"{type(self).__name__}.{name} cannot be changed, the object is frozen: "
            f"replace({name}=…) gives another one"
        )

    def __repr_args__(self) -> Iterator[tuple[str, Any]]:
        """What differs from the usual, as it would be written."""
        for name, field in type(self).model_fields.items():
            if (value := getattr(self, name)) != field.get_default(call_default_factory=True):
                yield name, value

    def __str__(self) -> str:
        return repr(self)

    def replace(self, **values: Any) -> Self:
        """Return a copy with other values for some keys. Raises SceneError for what makes no sense."""
        fields = type(self).model_fields.items()
        kept = {name: value for name, one in fields if (value := getattr(self, name)) is not one.default}
        return type(self)(**{**kept, **values})

    @classmethod
    def __get_pydantic_json_schema__(cls, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        schema = handler(core)
        keys = handler.resolve_ref_schema(schema).get("properties", {})
        for name, field in cls.model_fields.items():  # pydantic would read the sources at every import
            if name in (texts := sentences(cls)):
                keys[field.validation_alias or name]["description"] = texts[name]
        return schema


def _signature(fields: dict[str, FieldInfo]) -> Signature:
    """Return the keys of an object as `help` shows them, without bounds; first those that need no name."""
    annotations = {name: field.annotation for name, field in fields.items()}
    types = get_type_hints(type("Keys", (), {"__annotations__": annotations}))
    parameters: list[Parameter] = []
    needed = False  # by place, here or farther on
    for name, field in sorted(fields.items(), key=lambda item: bool(item[1].kw_only))[::-1]:
        kind = Parameter.KEYWORD_ONLY if field.kw_only else Parameter.POSITIONAL_OR_KEYWORD
        needed = field.is_required() or (needed and not field.kw_only)
        usual = Parameter.empty if needed else field.get_default(call_default_factory=True)
        parameters.append(Parameter(name, kind, default=usual, annotation=types[name]))
    return Signature(parameters[::-1])
