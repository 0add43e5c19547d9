"""The reason of a scene's refusal: pydantic's list of faults as one line of keys, values and allowed values.

    load 2.pressure = 200.0: unknown key; known: history, kind, value

Lists count from 1. The line names at most three faults, and the number of further ones.
"""

from collections.abc import Iterable
from difflib import get_close_matches
from reprlib import Repr
from typing import Any

from pydantic import BaseModel, ValidationError

from sheetbench.errors import BadInput
from sheetbench.scenes.language.limits import unsupported_note
from sheetbench.scenes.language.schema import branches, json_schema, kind
from sheetbench.scenes.language.units import quantity

SHOWN = 3  # faults
LONGEST = 60  # characters of a key or a value
MANY_DIGITS = 30


def in_one_line(error: ValidationError, model: type[BaseModel]) -> str:
    """Return the faults of data for `model`, separated by semicolons."""
    faults = [fault for fault in error.errors(include_url=False) if not _is_consequence(fault)]
    more = [f"and {len(faults) - SHOWN} more"] if len(faults) > SHOWN else []
    return "; ".join([*(_sentence(fault, json_schema(model)) for fault in faults[:SHOWN]), *more])


def did_you_mean(word: str, known: Iterable[str]) -> str | None:
    """Return the known word that is nearest in spelling, None if none is near."""
    by_lower = {name.lower(): name for name in known}
    near = get_close_matches(word.lower(), by_lower, n=1)
    return by_lower[near[0]] if near else None


def as_written(value: Any) -> str:
    """Return a value as it was written, shortened if it is long."""
    return _SHORT.repr(value)


class _Short(Repr):
    def repr_int(self, x: int, level: int) -> str:
        digits = int(abs(x).bit_length() * 0.30103) + 1
        return repr(x) if digits <= MANY_DIGITS else f"a number of about {digits} digits"

    def repr_bool(self, x: bool, level: int) -> str:
        return str(x).lower()  # TOML's spelling


_SHORT = _Short()
_SHORT.maxstring = _SHORT.maxother = LONGEST


def _is_consequence(fault: Any) -> bool:
    """Return whether a fault only reports the number of entries that are left by other faults."""
    return fault["type"] == "too_short" and len(fault["input"]) >= fault["ctx"]["min_length"]


def _sentence(fault: Any, schema: dict[str, Any]) -> str:
    where, nodes = _locate(fault["loc"], schema)
    key, value, facts = in_keys(where), fault["input"], fault.get("ctx", {})
    given = f"{key} = {as_written(value)}"
    match fault["type"]:
        case "extra_forbidden":
            if not_modelled := unsupported_note(str(where[-1])):
                return f"{key}: {not_modelled}"
            keys = _keys(_locate(fault["loc"][:-1], schema)[1])
            near = did_you_mean(str(where[-1]), keys)
            hint = f"did you mean {near}?" if near else f"known: {', '.join(keys)}"
            return f"{given}: unknown key; {hint}"
        case "missing":
            return f"{key}: missing"
        case "value_error":
            text = str(facts["error"])
            of_key = text.partition(":")[0] in _keys(nodes)
            return f"{key}{'.' if of_key else ': '}{text}" if key else text
        case "union_tag_not_found":
            return f"{key}: kind is missing; {_choose('', nodes)}"
        case "union_tag_invalid" if facts["tag"] in _FORMS:
            return f"{given}: must be {facts['expected_tags'].replace(chr(39), '').replace(', ', ' or ')}"
        case "union_tag_invalid":
            tag = facts["tag"]
            return f"{key}: kind = {as_written(tag)}: {unsupported_note(str(tag)) or _choose(tag, nodes)}"
        case "literal_error":
            return f"{given}: {_choose(value, nodes)}"
        case "float_type" if isinstance(value, str) and (unit := unit_at(fault["loc"], schema)) is not None:
            try:
                quantity(value, unit)
            except BadInput as error:
                return f"{key}: {error}"
            return f"{key}: '{value}' is text: write the number [{unit}] without quotes, or with a unit"
        case "tuple_type":
            if _keys([entry for node in nodes for entry in _nodes_inside(node, 0, schema)]):
                return f"{given}: must be a list of tables, each headed [[{key}]]"
            sizes = [f" of {len(node['prefixItems'])}" for node in nodes if "prefixItems" in node]
            return f"{given}: must be a list{min(sizes, default='')}"
        case "model_type" | "model_attributes_type" | "dict_type":
            keys = _keys(nodes)
            return f"{given}: must be a table" + f" with the keys {', '.join(keys)}" * bool(keys)
    unnamed = f"is not allowed ({fault['type'].replace('_', ' ')})"
    allowed = f"must {ALLOWED[fault['type']].format(**facts)}" if fault["type"] in ALLOWED else unnamed
    hints = [f"; {node['hint']}" for node in nodes if fault["type"] == "less_than" and "hint" in node]
    return f"{given}: {allowed}{''.join(hints[:1])}"


def unit_at(location: tuple[int | str, ...], schema: dict[str, Any]) -> str | None:
    """Return the SI unit of the number at a location, or None if it has none."""
    places = (_locate(location[:end], schema)[1] for end in range(len(location), 0, -1))
    return next((str(node["unit"]) for nodes in places for node in nodes if "unit" in node), None)


ALLOWED = {  # by pydantic's types of fault
    "float_type": "be a number",
    "finite_number": "be finite",
    "int_type": "be a whole number",
    "string_type": "be text, in quotes",
    "greater_than": "be greater than {gt:g}",
    "greater_than_equal": "be {ge:g} or more",
    "less_than": "be less than {lt:g}",
    "less_than_equal": "be {le:g} or less",
    "too_large": "be {largest:g} or less in magnitude",
    "too_small": "be {smallest:g} or more",
    "string_too_short": "not be empty",
    "too_short": "have {min_length} or more entries, not {actual_length}",
    "too_long": "have {max_length} entries, not {actual_length}",
}


def _choose(word: object, nodes: list[dict[str, Any]]) -> str:
    """Return the words allowed in place of a word: the kinds of tables, or the texts that a key takes."""
    tables = [node["properties"]["kind"] for node in nodes if kind(node)]
    choices = [str(each) for one in tables or nodes for each in one.get("enum", [one.get("const")])]
    near = did_you_mean(str(word), choices)
    return f"did you mean {near}? " * bool(near) + f"choose one of {', '.join(choices)}"


def _locate(
    location: tuple[int | str, ...], schema: dict[str, Any]
) -> tuple[list[int | str], list[dict[str, Any]]]:
    """Return the keys and list numbers of a fault's location, and the nodes of the schema there.

    Between them pydantic names the kind of table that it took, which is no key.
    """
    where: list[int | str] = []
    nodes = branches(schema, schema)
    for part in location:
        of_kind = [node for node in nodes if kind(node) == part]
        if of_kind and len(nodes) > 1:
            nodes = of_kind
            continue
        inside = [below for node in nodes for below in _nodes_inside(node, part, schema)]
        if isinstance(part, str) and not inside and part in _FORMS:
            continue
        where.append(part)
        nodes = inside
    return where, nodes


_FORMS = {"a number", "a list", "a table"}


def _nodes_inside(node: dict[str, Any], part: int | str, schema: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the schema's nodes of an entry of a list or a key of a table."""
    if isinstance(part, int):
        items = (node.get("prefixItems") or [])[part : part + 1] or [node.get("items")]
    else:
        items = [node.get("properties", {}).get(part, node.get("additionalProperties"))]
    return [branch for below in items if isinstance(below, dict) for branch in branches(schema, below)]


def in_keys(where: Iterable[int | str]) -> str:
    """Return the keys and list numbers of a place as text: 'load 2.pressure'."""
    texts = (f" {p + 1}" if isinstance(p, int) else f".{p}" for p in where)
    parts = (text if len(text) <= LONGEST + 1 else f"{text[: LONGEST + 1]}…" for text in texts)
    return "".join(parts).removeprefix(".")


def _keys(nodes: list[dict[str, Any]]) -> list[str]:
    """Return the keys of the tables that may stand at a place, sorted."""
    return sorted({key for node in nodes for key in node.get("properties", {})})
