"""The reference page of the scene language, generated from the schema: all keys, table by table.

The documentation's build and `sheetbench check --schema --out DIR` write it as scene.md.
"""

from typing import Any

from sheetbench.scenes.language.schema import branches, json_schema, kind, resolved
from sheetbench.scenes.scene import Scene

HEAD = """# Every key of a scene

*Made from the types by `make docs-scene`; the same as a JSON Schema, for editors: `check --schema`.*

A scene is a TOML file, or in Python `sheetbench.Scene(…)` with the same keys (the lists are `supports`,
`loads` and `actuators` there). All quantities are in SI units: metres, newtons, pascals, kilograms, seconds,
radians. `sheetbench new my-sheet.toml` writes one to start from, `sheetbench check my-sheet.toml` says in
words what it means, `sheetbench check --out DIR` copies those that come with the program.

![Axes, edges, and the sense of what has a sign](images/scene.svg)

The flat, stress-free sheet's mid-surface is z = 0, with 0 ≤ x ≤ `length_x` and 0 ≤ y ≤ `length_y`; z points
up. An edge is named by the axis it is normal to and the end of that axis: `x0`, `x1`, `y0`, `y1`.
Displacements are the mid-surface's, from that state.
"""
WITHIN = """## Tables within tables

Written in a line, as `history = {time = [0.0, 0.5], factor = [0.0, 1.0]}`, or under headings of their own, as
`[[material.relaxation]]`. Tables over time are linear between samples, before the first and after the last
one constant; `simulate` follows them, statics take the last sample.
"""
WORDS = {"number": "number", "integer": "whole number", "string": "text", "boolean": "true or false"}
SIGNS = {"exclusiveMinimum": ">", "minimum": "≥", "exclusiveMaximum": "<", "maximum": "≤"}
HEADINGS: dict[Any, str] = {"object": "[{}]", "array": "[[{}]]"}  # of keys that take tables


def markdown() -> str:
    """Return the page as Markdown."""
    schema = json_schema(Scene)
    keys, shown = schema["properties"], list[dict[str, Any]]()
    types = {key: resolved(schema, node).get("type") for key, node in keys.items()}
    headings = {key: HEADINGS[types[key]].format(key) for key in keys if types[key] in HEADINGS}
    plain = {key: node for key, node in keys.items() if key not in headings}
    parts = [HEAD, "## At the top\n", _keys_table({**schema, "properties": plain}, schema)]
    for key, heading in headings.items():
        parts += [f"## {heading}\n", f"{keys[key]['description']}\n"]
        tables = branches(schema, keys[key].get("items", keys[key]))
        for table in tables:
            parts += [f'### kind = "{kind(table)}"\n'] * (len(tables) > 1)
            parts += [_keys_table(table, schema)] if "properties" in table else []
        shown += tables
    parts.append(WITHIN)
    for name, table in schema["$defs"].items():
        if not any(table["properties"].items() <= other.get("properties", {}).items() for other in shown):
            parents = (schema, *schema["$defs"].values())
            nodes = [item for parent in parents for item in parent["properties"].items()]
            users = ", ".join(dict.fromkeys(f"`{key}`" for key, node in nodes if f"/{name}'" in str(node)))
            parts += [f"### For {users}\n", f"{table['description']}\n", _keys_table(table, schema)]
    return "\n".join(parts)


def _keys_table(table: dict[str, Any], schema: dict[str, Any]) -> str:
    """Return the keys of a table in Markdown, required keys first."""
    lines = ["| key | unit | value | unless given | what it is |", "| --- | --- | --- | --- | --- |"]
    required = table.get("required", ())
    for key, node in sorted(table["properties"].items(), key=lambda item: item[0] not in required):
        default = "*needed*" if key in required else _default_text(node.get("default"))
        cells = (f"`{key}`", node.get("unit", ""), value(node, schema), default, node["description"])
        lines.append(f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |")
    return "\n".join(lines) + "\n"


def value(node: dict[str, Any], schema: dict[str, Any]) -> str:
    """Return the valid values of a key in words."""
    return " or ".join(dict.fromkeys(_branch_text(branch, schema) for branch in branches(schema, node)))


def _branch_text(node: dict[str, Any], schema: dict[str, Any]) -> str:
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
    bounds = (f"{sign} {str(node[name]).replace('-', '−')}" for name, sign in SIGNS.items() if name in node)
    return f"{WORDS[node['type']]} {', '.join(bounds)}".strip()


def _default_text(default: Any) -> str:
    if default is None or default == [] or default == "":
        return "–"
    return f'"{default}"' if isinstance(default, str) else str(default).lower()
