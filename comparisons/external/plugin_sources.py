"""The Python files that a plug-in consists of: its own, and those beside it that it imports.

What it imports from elsewhere, installed packages say, is not looked at.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator, Mapping
from hashlib import sha256
from importlib.util import find_spec
from pathlib import Path


def of_file(file: Path) -> dict[str, Path]:
    """Return a file and what it imports from its own folder, modules and packages, by their paths in
    there."""
    folder = file.resolve().parent
    found: dict[str, Path] = {}
    waiting = [file.resolve()]
    while waiting:
        path = waiting.pop()
        name = path.relative_to(folder).as_posix()
        if name in found:
            continue
        found[name] = path
        for imported in _imported(path):
            module, package = folder / f"{imported}.py", folder / imported
            if module.is_file():
                waiting.append(module)
            elif (package / "__init__.py").is_file():
                waiting.extend(package.rglob("*.py"))
    return found


def of_module(name: str) -> dict[str, Path]:
    """Return the package that an installed module is in, or the module where it is in none, as `of_file`."""
    spec = find_spec(name.partition(".")[0])
    if spec is None or spec.origin is None:
        return {}
    places = spec.submodule_search_locations
    if not places:
        return of_file(Path(spec.origin))
    files = ((Path(place), path) for place in places for path in Path(place).rglob("*.py"))
    return {path.relative_to(place).as_posix(): path for place, path in files}


def digest(files: Mapping[str, Path], *more: str) -> str:
    """Return what follows from the files' names and contents, and from more texts."""
    lines = [f"{name} {sha256(path.read_bytes()).hexdigest()}" for name, path in sorted(files.items())]
    return sha256("\n".join([*more, *lines]).encode()).hexdigest()


def _imported(path: Path) -> Iterator[str]:
    """Return the first parts of the names that a file imports."""
    try:
        tree = ast.parse(path.read_bytes())
    except (SyntaxError, ValueError):  # reported when it is loaded
        return
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
            yield node.module.partition(".")[0]
