"""Docstrings of scene objects: numpydoc's section of parameters, made of the sentence below each key."""

from collections.abc import Iterator
from inspect import cleandoc, signature
from textwrap import indent, wrap
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel

from sheetbench.scenes.language.schema import sentences

WIDTH = 100  # characters of a line


class Documented(type(BaseModel)):  # type: ignore[misc]
    # Metaclass: `__doc__` of a class is its text with the section of parameters, made when it is read.
    @property
    def __doc__(cls: Any) -> str | None:  # type: ignore[override]
        text: str | None = vars(cls)["__doc__"]
        if not text or not cls.model_fields:
            return text
        return "\n".join([cleandoc(text), "", "Parameters", "----------", *_parameters(cls), ""])


def _parameters(table: type[BaseModel]) -> Iterator[str]:
    texts = sentences(table)
    for name in signature(table).parameters:
        field = table.model_fields[name]
        # an annotation has a mark at least
        annotated: Any = Annotated[field.annotation, *field.metadata, None]
        unit = f" [{symbol}]" if (symbol := _unit(annotated)) else ""
        yield f"{name} : {_type(annotated)}{unit}{'' if field.is_required() else ', optional'}"
        yield indent("\n".join(wrap(texts[name], WIDTH)), "    ")


def _type(annotation: Any) -> str:
    """Return an annotation in numpydoc's words: `float or (float, float)`, `tuple of Layer`."""
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return _type(parts[0])
    if origin in (Union, UnionType):
        return " or ".join(dict.fromkeys(map(_type, parts)))
    if origin is Literal:
        return f"{{{', '.join(map(repr, parts))}}}"
    if origin is tuple and parts[-1] is not Ellipsis:
        return f"({', '.join(map(_type, parts))})"
    if origin in (tuple, dict):
        return f"{origin.__name__} of {' to '.join(_type(part) for part in parts if part is not Ellipsis)}"
    return "None" if annotation is NoneType else str(annotation.__name__)


def _unit(annotation: Any) -> str:
    """Return the symbol of the first unit in an annotation, "" without one."""
    marks = (getattr(mark, "symbol", "") for mark in getattr(annotation, "__metadata__", ()))
    return next(filter(None, (*marks, *map(_unit, get_args(annotation)))), "")
