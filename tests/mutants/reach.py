"""Which tests run a function of the solvers, by the book that record.py keeps."""

from __future__ import annotations

import ast
import json
from collections import defaultdict
from collections.abc import Iterator, Mapping, Set
from pathlib import Path
from typing import Any

PACKAGES = ("lumped", "fem_reference", "sheetbench/numerics", "comparisons")


class Reach:
    """A book, and who calls whom: compiled functions are not seen, and are run by what runs their callers."""

    def __init__(self, tree: Path, book: Path, imports: Mapping[str, Set[str]]):
        """imports: of files as Python names them, what they import."""
        self._imports = imports
        self.seconds: dict[str, float] = {}
        self._tests: dict[str, set[str]] = defaultdict(set)
        for row in rows(book):
            self.seconds[row["test"]] = row["seconds"]
            for name in row["runs"]:
                self._tests[name].add(row["test"])
        self._callers: dict[str, set[str]] = defaultdict(set)
        self._functions = []
        for path in sorted(path for package in PACKAGES for path in (tree / package).rglob("*.py")):
            module = str(path.relative_to(tree))
            for function, named in functions(ast.parse(path.read_text()), ""):
                self._functions.append(f"{module} {function}")
                for name in named:
                    self._callers[name].add(f"{module} {function}")

    def tests(self, module: str, function: str) -> set[str]:
        """Of the book, those that run a function, or one inside of it; of a module or a class, any of it."""
        inside = (f"{module} {function}.", f"{module} {function}") if function else (f"{module} ",)
        met = {name for name in self._functions if f"{name}." == inside[0] or name.startswith(inside[0])}
        found: set[str] = set()
        ahead = list(met)
        while ahead:
            name = ahead.pop()
            if name in self._tests:
                found |= self._tests[name]
            else:
                of, function = name.split(" ")
                callers = self._callers[function.rpartition(".")[2]] - met
                callers = {caller for caller in callers if self._may_call(caller.split(" ")[0], of)}
                met |= callers
                ahead.extend(callers)
        return found

    def _may_call(self, caller: str, module: str) -> bool:
        """Whether a file is another, or imports it."""
        named, wanted = (name.removesuffix(".py").replace("/", ".") for name in (caller, module))
        return named == wanted or wanted in self._imports.get(named, ())


def functions(node: ast.AST, where: str) -> Iterator[tuple[str, set[str]]]:
    """Every function with the names that it speaks."""
    for child in ast.iter_child_nodes(node):
        named = isinstance(child, ast.FunctionDef | ast.ClassDef)
        inner = f"{where}.{child.name}".lstrip(".") if named else where
        if isinstance(child, ast.FunctionDef):
            spoken = {name.id for name in ast.walk(child) if isinstance(name, ast.Name)}
            yield inner, spoken | {name.attr for name in ast.walk(child) if isinstance(name, ast.Attribute)}
        yield from functions(child, inner)


def rows(book: Path) -> list[dict[str, Any]]:
    """What is written down; nothing where nothing is."""
    return [json.loads(line) for line in book.read_text().splitlines()] if book.exists() else []
