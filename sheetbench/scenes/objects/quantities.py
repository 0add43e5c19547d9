"""Validated numbers with their units, and the frozen base of every scene object. All are in SI units.

No number is larger than `LARGEST` in magnitude, and no positive number smaller than `SMALLEST`: numbers
beyond them are slips, and the products and quotients of the mechanics would overflow.
"""

from collections.abc import Callable, Iterable, Iterator
from inspect import Parameter, Signature, cleandoc
from math import isfinite
from typing import (
    Annotated,
    Any,
    ClassVar,
    NamedTuple,
    Self,
    dataclass_transform,
    get_args,
    get_origin,
    get_type_hints,
)

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    GetCoreSchemaHandler,
    GetJsonSchemaHandler,
    ValidationError,
    model_validator,
)
from pydantic_core import CoreSchema, PydanticCustomError, core_schema

from sheetbench.errors import BadInput, SceneError, WrongArgument
from sheetbench.scenes.language.docstrings import Documented
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


class Real:
    """A finite number, no text, within bounds (`gt`, `ge`, `lt`, `le`), with a further check. It makes its
    schema as a whole: pydantic would apply each part of an annotation anew at every use. hint: a value to
    write in place of a number beyond the bounds, for the JSON Schema."""

    def __init__(self, check: Callable[[float], float] | None = None, hint: str = "", **bounds: Any):
        self.check, self.hint, self.bounds = check, hint, bounds

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        number = core_schema.float_schema(strict=True, allow_inf_nan=False, **self.bounds)
        return core_schema.no_info_after_validator_function(self.check, number) if self.check else number

    def __get_pydantic_json_schema__(self, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {**handler(core), **({"hint": self.hint} if self.hint else {})}


Finite = Annotated[float, Real()]
Number = Annotated[float, Real(_not_too_large)]
Positive = Annotated[float, Real(_not_too_small, gt=0)]
NonNegative = Annotated[float, Real(_not_too_large, ge=0)]
Vector3 = tuple[Number, Number, Number]
PlanPoint = tuple[Number, Number]


def _form(value: Any) -> str:
    if isinstance(value, dict | BaseModel):
        return "a table"
    return "a list" if isinstance(value, list | tuple) else "a number"


class Forms:
    """Mark of a key that takes a number, a list or a table: a fault refers to the form that the value has."""

    NAMES: ClassVar[dict[Any, str]] = {Annotated: "a number", tuple: "a list", None: "a table"}

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        choices = {self.NAMES[get_origin(one)]: handler.generate_schema(one) for one in get_args(source)}
        return core_schema.tagged_union_schema(choices, _form)


class Unit(NamedTuple):
    """The SI unit of a number or of every number in a list; it stands as `unit` in the JSON Schema.

    The number may be text with a unit of its own, as "2 mm" (`sheetbench.scenes.language.units`).
    """

    symbol: str

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_before_validator_function(
            lambda value: converted(value, self.symbol), handler(source)
        )

    def __get_pydantic_json_schema__(self, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return {**handler(core), "unit": self.symbol}


Length = Annotated[Positive, Unit("m")]
Angle = Annotated[Number, Unit("rad")]
Modulus = Annotated[Positive, Unit("Pa")]
Density = Annotated[Positive, Unit("kg/m³")]
VOLUME_KEPT = "write 0.4999 for a material that keeps its volume"
PoissonRatio = Annotated[float, Real(hint=VOLUME_KEPT, gt=-1, lt=0.5)]  # of isotropic materials


METACLASS: Any = {"metaclass": Documented}  # which type checkers need not see


@dataclass_transform(frozen_default=True, field_specifiers=(Field,))
class Frozen(BaseModel, frozen=True, **METACLASS):
    """Base of the scene objects: immutable, and unknown keys are refused.

    A sentence below each key gives its meaning and its sign; docstrings, the JSON Schema, the reference page
    (docs/scene.md) and the files that `sheetbench new` writes are made of the sentences. Impossible values
    raise SceneError, in one line. Values without a name stand for the keys in their order, without
    keyword-only ones (`kind`, `title`, `history`, `motion`).
    """

    model_config = ConfigDict(extra="forbid", populate_by_name=True)

    def __init__(self, *values: Any, **keys: Any) -> None:
        names = [name for name, field in type(self).model_fields.items() if not field.kw_only]
        if len(values) > len(names):
            many = f"{type(self).__name__} takes {len(names)} values by place: {', '.join(names)}"
            raise WrongArgument(many)
        try:
            super().__init__(**dict(zip(names, values, strict=False)), **keys)
        except ValidationError as error:
            wrong = {"extra_forbidden", "missing"}.intersection(one["type"] for one in error.errors())
            kind = WrongArgument if wrong else SceneError
            raise kind(f"{type(self).__name__}: {in_one_line(error, type(self))}") from None

    # an object read from a file, or within another object, is built without the above, so that the whole
    # scene's faults are reported together
    __init__.__pydantic_base_init__ = True  # type: ignore[attr-defined]

    @classmethod
    def __pydantic_init_subclass__(cls, **options: Any) -> None:
        cls.__signature__ = _Keys()  # type: ignore[assignment]  # made when it is read

    def __setattr__(self, name: str, value: Any) -> None:
        raise SceneError(
            f"{type(self).__name__}.{name} cannot be changed, the object is frozen: "
            f"replace({name}=…) gives another one"
        )

    def __repr_args__(self) -> Iterator[tuple[str, Any]]:
        """Yield the keys whose values are not the defaults."""
        for name, field in type(self).model_fields.items():
            if (value := getattr(self, name)) != field.get_default(call_default_factory=True):
                yield name, value

    def __str__(self) -> str:
        return repr(self)

    def _faults(self) -> Iterator[object]:
        """Yield sentences on values that contradict each other; false values are ignored. The first sentence
        is reported."""
        yield from ()

    @model_validator(mode="after")
    def _sound(self) -> Self:
        if fault := next(filter(None, self._faults()), None):
            raise ValueError(fault)
        return self

    def given(self, names: Iterable[str]) -> dict[str, Any]:
        """Return the values of some keys, without None."""
        return {name: value for name in names if (value := getattr(self, name)) is not None}

    def replace(self, **values: Any) -> Self:
        """Return a copy with other values for some keys. Raises SceneError for impossible values."""
        fields = type(self).model_fields.items()
        kept = {name: value for name, one in fields if (value := getattr(self, name)) is not one.default}
        return type(self)(**{**kept, **values})

    @classmethod
    def __get_pydantic_json_schema__(cls, core: Any, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        schema = handler(core)
        table = handler.resolve_ref_schema(schema)
        keys = table.get("properties", {})
        table["description"] = cleandoc(vars(cls)["__doc__"] or "")
        for name, field in cls.model_fields.items():  # pydantic would read the sources at every import
            if name in (texts := sentences(cls)):
                keys[field.validation_alias or name]["description"] = texts[name]
        return schema


class _Keys:
    """Descriptor of a class's signature: its keys without bounds, the positional ones first."""

    def __get__(self, one: Any, kind: type[BaseModel]) -> Signature:
        fields = kind.model_fields
        annotations = {name: field.annotation for name, field in fields.items()}
        types = get_type_hints(type("Keys", (), {"__annotations__": annotations}))
        parameters: list[Parameter] = []
        needed = False  # by place, here or farther on
        for name, field in sorted(fields.items(), key=lambda item: bool(item[1].kw_only))[::-1]:
            how = Parameter.KEYWORD_ONLY if field.kw_only else Parameter.POSITIONAL_OR_KEYWORD
            needed = field.is_required() or (needed and not field.kw_only)
            usual = Parameter.empty if needed else field.get_default(call_default_factory=True)
            parameters.append(Parameter(name, how, default=usual, annotation=types[name]))
        return Signature(parameters[::-1])
