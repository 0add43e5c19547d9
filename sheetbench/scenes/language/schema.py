"""The scene language as a JSON Schema (draft 2020-12), read off the types: every key, unit, bound, default.

Editors complete and check a scene with it; the reference page and the refusals are made of it too. A number
has two keywords more than the standard's: `unit`, its SI unit, and `hint`, a value to write in place of one
beyond its bounds. Null does not occur: TOML has none.
"""

import ast
import inspect
from copy import deepcopy
from functools import cache
from itertools import pairwise
from typing import Any

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue


class _AsWritten(GenerateJsonSchema):
    """Generator of a schema without null, which no scene can hold, and without titles, which repeat keys."""

    def nullable_schema(self, schema: Any) -> JsonSchemaValue:
        return self.generate_inner(schema["schema"])

    def field_title_should_be_set(self, schema: Any) -> bool:
        return False


@cache
def json_schema(model: type[BaseModel]) -> dict[str, Any]:
    """Return the schema of a scene or a part of it, with classes under `$defs`."""
    schema = model.model_json_schema(by_alias=True, schema_generator=_AsWritten)
    for table in (schema, *schema.get("$defs", {}).values()):
        keys = table.get("properties", {})
        for key in keys.values():
            if key.get("default", 0) is None:
                del key["default"]
            for one in key.get("items", {}).get("discriminator", {}).get("mapping", {}).values():
                # a table of several kinds needs its kind: only an object in Python has it by its class
                kinds = schema["$defs"][one.rpartition("/")[2]]
                kinds["properties"]["kind"].pop("default", None)
                needed = {"kind", *kinds.get("required", ())}
                kinds["required"] = sorted(needed, key=list(kinds["properties"]).index)
    return schema


@cache
def for_editors(model: type[BaseModel]) -> dict[str, Any]:
    """Return the schema as a document for editors, which show its sentences: they contain the units."""
    schema = deepcopy(json_schema(model))
    for table in (schema, *schema["$defs"].values()):
        for key in table["properties"].values():
            if "unit" in key:
                key["description"] = f"[{key['unit']}] {key['description']}"
                _or_text(key)
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **schema}


def _or_text(node: Any) -> None:
    """Let every number within a node also be text with a unit, as "2 mm"."""
    if isinstance(node, list):
        for entry in node:
            _or_text(entry)
    elif isinstance(node, dict) and node.get("type") == "number":
        bounds = {key: node.pop(key) for key in list(node) if key not in ("default", "description", "unit")}
        node["anyOf"] = [bounds, {"type": "string"}]
    elif isinstance(node, dict):
        for key in ("items", "prefixItems", "anyOf", "oneOf", "additionalProperties"):
            _or_text(node.get(key))


@cache
def sentences(table: type[BaseModel]) -> dict[str, str]:
    """Return the sentence below each key of a class and of its bases, from their source code."""
    texts: dict[str, str] = {}
    for each in reversed(table.__mro__):
        if not (issubclass(each, BaseModel) and each.model_fields):
            continue
        try:
            source = ast.parse(inspect.getsource(each))
        except OSError:  # installed without its source
            continue
        body = next(node.body for node in source.body if isinstance(node, ast.ClassDef))
        for key, below in pairwise(body):
            match key, below:
                case ast.AnnAssign(target=ast.Name(id=name)), ast.Expr(value=ast.Constant(value=str(text))):
                    texts[name] = " ".join(text.split())
    if "kind" in table.model_fields:  # the kind stands for the class
        texts.setdefault("kind", " ".join((vars(table)["__doc__"] or "").split()))
    return texts


def resolved(schema: dict[str, Any], node: dict[str, Any]) -> dict[str, Any]:
    """Return the node that a reference stands for, with the keywords given beside the reference."""
    if "$ref" not in node:
        return node
    beside = {key: value for key, value in node.items() if key != "$ref"}
    return {**schema["$defs"][node["$ref"].rpartition("/")[2]], **beside}


def branches(schema: dict[str, Any], node: dict[str, Any]) -> list[dict[str, Any]]:
    """Return the alternatives of a node, its kinds or the forms of its value; the node if it has none."""
    node = resolved(schema, node)
    either = node.get("oneOf") or node.get("anyOf")
    return [node] if either is None else [part for each in either for part in branches(schema, each)]


def kind(table: dict[str, Any]) -> str | None:
    """Return the value that a table's key `kind` must have, None without this key."""
    key: dict[str, Any] = table.get("properties", {}).get("kind", {})
    return key.get("const")
