"""The reference page of the scene language, docs/scene.md, made of the schema: all keys, table by table.

`make docs-scene` writes it, and a test holds that page and types say the same.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator
from typing import Any

from sheetbench.scenes.scene import Scene
from sheetbench.scenes.schema import branches, json_schema, kind, resolved

HEAD = """# Every key of a scene

*Made from the types by `make docs-scene`; the same as a JSON Schema, for editors: `sheetbench schema`.*

A scene is a TOML file, or in Python `sheetbench.Scene(…)` with the same keys (the lists are `supports`,
`loads` and `actuators` there). All quantities are in SI units: metres, newtons, pascals, kilograms, seconds,
radians. `sheetbench new my-sheet.toml` writes one to start from, `sheetbench check my-sheet.toml` says in
words what it means, `sheetbench scenes --out DIR` copies those that come with the program.

![Axes, edges, and the sense of what has a sign](images/scene.svg)

The flat, stress-free sheet's mid-surface is z = 0, with 0 ≤ x ≤ `length_x` and 0 ≤ y ≤ `length_y`; z points
up. An edge is named by the axis it is normal to and the end of that axis: `x0`, `x1`, `y0`, `y1`.
Displacements are the mid-surface's, from that state.
"""
OVER_TIME = """## Tables over time

Written as inline tables: `history = {time = [0.0, 0.5], factor = [0.0, 1.0]}`. Between samples they are
linear, before the first and after the last one constant. `simulate` follows them; statics take the last
sample.
"""


def markdown() -> str:
    """The page."""
    schema = json_schema(Scene)
    top = schema["properties"]
    tables = {key for key, node in top.items() if _heading(key, node, schema)}
    parts = [HEAD, "## At the top\n", _keys_table(schema, schema, leave_out=tables)]
    for key, node in top.items():
        if (heading := _heading(key, node, schema)) is None:
            continue
        parts += [f"## {heading}\n", f"{node['description']}\n"]
        below = branches(schema, node.get("items", node))
        if key == "probes":
            parts.append("Any name, with a plan point [x, y] in metres: `P1 = [0.094, 0.094]`.\n")
            continue
        for table in below:
            if len(below) > 1:
                optional = "" if "kind" in table["required"] else " The kind where none is given."
                parts.append(f'### kind = "{kind(table)}"\n')
                parts.append(f"{table['properties']['kind']['description']}{optional}\n")
            parts.append(_keys_table(table, schema, leave_out={"kind"} if len(below) > 1 else ()))
            for inner, items in table["properties"].items():
                if "$ref" in (entries := items.get("items", {})):
                    inside = resolved(schema, entries)
                    parts += [f"### [[{key}.{inner}]]\n", f"{inside['description']}\n"]
                    parts.append(_keys_table(inside, schema))
            if "mesh" in table["properties"]:
                inside = branches(schema, table["properties"]["mesh"])[-1]
                parts += ["### sheet.mesh\n", f"{inside['description']}\n", _keys_table(inside, schema)]
            if "shape" in table["properties"]:
                parts += _shapes(table["properties"]["shape"], schema)
    parts.append(OVER_TIME)
    for name, table in sorted(schema["$defs"].items()):
        if table["properties"].get("time", {}).get("type") == "array" and kind(table) is None:
            users = ", ".join(f"`{user}`" for user in _users(name, schema))
            parts += [f"### For {users}\n", _keys_table(table, schema)]
    return "\n".join(parts)


def _shapes(node: dict[str, Any], schema: dict[str, Any]) -> Iterator[str]:
    """The keys of a shape, and of each of its kinds that is a table."""
    shape = resolved(schema, node)
    yield f"### shape\n\n{shape['description']}\n"
    yield _keys_table(shape, schema)
    for name, each in shape["properties"].items():
        for table in branches(schema, each):
            if table.get("type") == "object":
                yield f"### shape.{name}\n\n{table['description']}\n"
                yield _keys_table(table, schema)


def _heading(key: str, node: dict[str, Any], schema: dict[str, Any]) -> str | None:
    """How a table of the top is headed in TOML; None for a key with a value of its own."""
    node = resolved(schema, node)
    if node.get("type") == "object":
        return f"[{key}]"
    return f"[[{key}]]" if node.get("type") == "array" else None


def _keys_table(table: dict[str, Any], schema: dict[str, Any], leave_out: Collection[str] = ()) -> str:
    """The keys, those that are needed first."""
    lines = ["| key | unit | value | unless given | what it is |", "| --- | --- | --- | --- | --- |"]
    needed = table.get("required", ())
    for key, node in sorted(table["properties"].items(), key=lambda item: item[0] not in needed):
        if key in leave_out:
            continue
        default = "*needed*" if key in needed else _shown(node.get("default"))
        cells = (f"`{key}`", node.get("unit", ""), value(node, schema), default, node["description"])
        lines.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
    return "\n".join(lines) + "\n"


def value(node: dict[str, Any], schema: dict[str, Any]) -> str:
    """What a key takes, in words."""
    return " or ".join(dict.fromkeys(_one(each, schema) for each in branches(schema, node)))


def _one(node: dict[str, Any], schema: dict[str, Any]) -> str:
    if "const" in node or "enum" in node:
        return ", ".join(f'"{choice}"' for choice in node.get("enum", [node.get("const")]))
    if node.get("type") == "object":
        return "{" + ", ".join(node.get("properties", ())) + "}"
    if node.get("type") == "array":
        if "prefixItems" in node:
            return f"list of {len(node['prefixItems'])} numbers"
        entries = value(node["items"], schema)
        noun = next((noun for noun in ("list", "number") if noun in entries), entries)
        return f"list of {entries.replace(noun, f'{noun}s', 1)}"
    words = {"number": "number", "integer": "whole number", "string": "text"}[node["type"]]
    return " ".join([words, ", ".join(_bounds(node))]).strip()


def _bounds(node: dict[str, Any]) -> Iterator[str]:
    signs = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
    for name, sign in signs.items():
        if name in node:
            yield f"{sign} {str(node[name]).replace('-', '−')}"


def _shown(default: Any) -> str:
    if default is None or default == [] or default == "":
        return "–"
    return f'"{default}"' if isinstance(default, str) else str(default)


def _users(name: str, schema: dict[str, Any]) -> list[str]:
    """The keys that take the table of this name."""
    tables = [schema, *schema["$defs"].values()]
    keys = (
        key
        for table in tables
        for key, node in table["properties"].items()
        if any(below.get("$ref", "").endswith(f"/{name}") for below in [node, *node.get("oneOf", ())])
    )
    return list(dict.fromkeys(keys))
