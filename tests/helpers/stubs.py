"""`make stubs`: `sheetbench/__init__.pyi`, the names and verbs of `import sheetbench` for type checkers.

A verb's parameters are those of its function; what it returns is the annotation of its command: `A`, or
`Annotated[A | B, "option: B"]`, B where the option is given.
"""

import ast
import re
from inspect import Parameter, Signature, signature
from pathlib import Path

import sheetbench
from comparisons.cli.app import VERBS
from sheetbench.choices import FUNCTIONS

STUB = Path(sheetbench.__file__).with_suffix(".pyi")
HEAD = '''"""Names of `import sheetbench` for type checkers: made by `make stubs`, not by hand."""

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, overload

from comparisons.models.spec import Spec
from sheetbench import scenes as scenes
from sheetbench.scenes.objects.grading import Grading
'''


def imports() -> list[str]:
    """Return a line for every name that is taken from a module, and for every answer of a verb."""
    lines = [
        f"from {module} import {there} as {name}" for name, (module, there) in sheetbench._PLACES.items()
    ]
    for verb in FUNCTIONS:
        source = Path(sheetbench.__file__).parents[1] / "comparisons" / "cli" / f"{verb}.py"
        tree = ast.parse(source.read_text(encoding="utf-8"))
        checked = [node for node in tree.body if isinstance(node, ast.If)]  # if TYPE_CHECKING
        names = re.findall(r"\w+", str(signature(getattr(sheetbench, verb)).return_annotation))
        for node in (one for block in checked for one in block.body if isinstance(one, ast.ImportFrom)):
            lines += [f"from {node.module} import {one.name}" for one in node.names if one.name in names]
    return sorted(dict.fromkeys(lines))


def overloads(verb: str) -> list[tuple[str, Signature]]:
    """Return what a verb returns, and its parameters then."""
    own = signature(getattr(sheetbench, verb))
    text = own.return_annotation if isinstance(own.return_annotation, str) else own.return_annotation.__name__
    options = dict(re.findall(r"['\"](\w+): ([^'\"]+)['\"]", text))
    if not options:
        return [(text, own)]
    usual = re.match(r"Annotated\[(\w+)", text)[1]
    each = own.parameters.values()
    cases = [(usual, own.replace(parameters=[_without(one, options) for one in each]))]
    for option, answer in options.items():
        others = {name: of for name, of in options.items() if of != answer}
        needed = [_needed(one) if one.name == option else _without(one, others) for one in each]
        cases.append((answer, own.replace(parameters=needed)))
    return cases


def _without(one: Parameter, options: dict[str, str]) -> Parameter:
    return one.replace(annotation="None") if one.name in options else one


def _needed(one: Parameter) -> Parameter:
    return one.replace(annotation=one.annotation.removesuffix(" | None"), default=Parameter.empty)


def stub() -> str:
    """Return the text of the stub."""
    parts = [HEAD, *imports(), ""]
    for verb in FUNCTIONS:
        cases = overloads(verb)
        for returned, own in cases:
            parts += ["@overload"] * (len(cases) > 1) + [f"def {verb}({_listed(own)}) -> {returned}: ..."]
    names = "\n".join(f'    "{name}",' for name in sheetbench.__all__)
    return "\n".join([*parts, "", "__version__: str", f"__all__ = [\n{names}\n]", ""])


def _listed(names: Signature) -> str:
    """Return the parameters; a group's keywords after the star, `grid` by its other name too."""
    shown = []
    for one in names.parameters.values():
        if one.kind is Parameter.KEYWORD_ONLY and "*" not in shown:
            shown.append("*")
        usual = "" if one.default is Parameter.empty else " = ..."
        shown.append(f"{one.name}: {one.annotation}{usual}")
    if "grid" in names.parameters:
        shown.append(f"lumped: {names.parameters['grid'].annotation} = ...")
    return ", ".join(shown)


assert set(FUNCTIONS) <= set(VERBS)
if __name__ == "__main__":
    STUB.write_text(stub(), encoding="utf-8")
