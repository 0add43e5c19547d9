"""The file of `sheetbench new`: a small scene, every key with its unit and description.

Optional parts follow as comments: a block takes effect when the leading "# " of its lines is deleted, and its
own comments remain comments. The descriptions are the schema's.
"""

from collections.abc import Mapping, Sequence
from textwrap import wrap
from typing import Any

from sheetbench.scenes.language.schema import branches, for_editors, kind
from sheetbench.scenes.language.toml import keys, line
from sheetbench.scenes.objects.loads import Pressure
from sheetbench.scenes.objects.material import Material
from sheetbench.scenes.objects.sheet import EDGES, Gravity, Sheet
from sheetbench.scenes.objects.supports import Clamped
from sheetbench.scenes.scene import Scene

WIDTH = 100  # of a comment line
SCHEMA = "scene.schema.json"  # beside the file, for editors
EARTH = Gravity(acceleration=(0.0, 0.0, -9.81))


def template(
    name: str,
    sheet: Sheet,
    material: Material,
    clamped: Sequence[str] = ("x0",),
    pressure: float = 0.0,
) -> str:
    """Return commented TOML of a sheet under its weight and a pressure [Pa], clamped at some edges."""
    scene = Scene(
        name=name,
        sheet=sheet,
        material=material,
        gravity=EARTH,
        supports=tuple(Clamped.model_validate({"edge": edge}) for edge in clamped),
        loads=(Pressure(value=pressure),) if pressure else (),
    )
    given = keys(scene)
    parts = [
        f"#:schema {SCHEMA}\n"
        '# A scene for sheetbench. Numbers are in SI units (m, N, Pa, kg, s, rad); others are text: "2 mm".\n'
        "# What will be solved, in words:  sheetbench check FILE\n"
        "# Both models, side by side:  sheetbench compare FILE\n",
        _block("", {"name": name}),
        _commented(_block("", {"title": "Sheet under its own weight"})),
        _block("[sheet]", given["sheet"]),
        _block("[material]", given["material"]),
        _block("[gravity]", given["gravity"]),
        *(_block("[[support]]", one, about=n == 0) for n, one in enumerate(given.get("support", ()))),
        *(_block("[[load]]", one) for one in given.get("load", ())),
        '# Optional parts: delete the "# " at the start of a block\'s lines to use it.\n'
        "# All keys: sheetbench check --schema --out DIR, in scene.md\n",
    ]
    free = next((edge for edge in EDGES if edge not in clamped), "x1")
    for heading, table in _optional_parts(sheet, free):
        parts.append(_commented(_block(heading, table, about=heading not in "".join(parts))))
    return "\n".join(parts)


def _optional_parts(sheet: Sheet, edge: str) -> list[tuple[str, dict[str, Any]]]:
    middle, corner = [length / 2.0 for length in sheet.lengths], list(sheet.lengths)
    rising = {"time": [0.0, 0.5], "factor": [0.0, 1.0]}
    chain = {"segments": 8, "bending_stiffness": 0.01, "line_density": 0.05, "radius": 1.5e-3}
    return [
        ("[air]", {"drag": 1.2, "density": 1.2}),
        ("[[support]]", {"edge": edge, "kind": "clamped", "tilt": 0.02}),
        ("[[support]]", {"edge": edge, "kind": "hinged"}),
        ("[[support]]", {"edge": edge, "kind": "held", "components": ["z"]}),
        ("[[support]]", {"edge": edge, "kind": "curved", "curvature": 4.0}),
        ("[[load]]", {"kind": "point", "at": corner, "force": [0.0, 0.0, 0.01]}),
        ("[[load]]", {"kind": "edge", "edge": edge, "force_per_length": [0.0, 0.0, 0.1]}),
        ("[[load]]", {"kind": "pressure", "value": 1.0, "history": rising}),
        ("[[mass]]", {"at": corner, "mass": 0.005}),
        ("[[actuator]]", {"kind": "chain", "edge": edge, **chain, "curvature": 4.0}),
        ("[initial]", {"shape": "static"}),
        ("[probes]", {"centre": middle, "corner": corner}),
    ]


def _block(heading: str, table: Mapping[str, Any], about: bool = True) -> str:
    """Return a table of the file: its description, its heading, and every key with its description."""
    schema = for_editors(Scene)
    top = heading.strip("[]")
    node = schema["properties"][top] if top else schema
    of_kind = next(
        branch
        for branch in branches(schema, node.get("items", node))
        if kind(branch) in (None, table.get("kind"))
    )
    lines = [*(_comment(node["description"]) if about else ()), heading] if top else []
    for key, value in table.items():
        if sentence := of_kind.get("properties", {}).get(key):
            lines += _comment(sentence["description"])
        lines.append(line(key, value))
    return "\n".join([*lines, ""])


def _comment(text: str) -> list[str]:
    return wrap(text, WIDTH, initial_indent="# ", subsequent_indent="# ")


def _commented(block: str) -> str:
    return "".join(f"# {text}\n" if text else "\n" for text in block.splitlines())
