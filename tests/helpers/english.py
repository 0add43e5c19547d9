"""Clauses of docstrings that a reader stumbles over; `python tests/helpers/english.py PACKAGE…` lists them.

Six kinds, each a pattern: relative clauses without a noun ("Return what …"), "what" as a noun, "as X has it",
verbs of people for code, pronouns without a noun, sentences without a subject. A pattern also finds plain
sentences; tests/helpers/english_exceptions.txt lists the plain ones that stay, with a reason each.
"""

import ast
import re
import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parents[2]
KINDS = {
    "return what": r"\b(Return|return|Returns|Add|Give|Keep|Put|Compute|Turn|Take off|Say|Find)"
    r" (what|where|how|which|whatever)\b",
    "what as a noun": r"(?<!Return )(?<!return )\bwhat (is|are|has|have|it|they|stands|lies|holds|a|an|the|"
    r"can|could|does|do|would|its|each|springs|supports|follows|remains|numba|makes)\b",
    "as X has it": r"\bas [A-Za-zÀ-ÿ&’'\. ]{1,30} ha(s|ve) (it|them)\b",
    "verbs of people": r"\b(tells?|told|asks?|asked|knows?|says?|said|is looked (at|for)|"
    r"looks? (at|for|after)|gives? up|wants?|hears?|nobody|whoever|somebody|who)\b",
    "pronoun without noun": r"\b(that of|those of|those that|those which|likewise|the same|one's own|these|"
    r"apart|such)\b",
    "no subject": r"^(Of|As of|By|None|Once|The same|Zero|With|Within|Where|From|In|To|After|Beside)\b",
}
DOCUMENTED = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)


class Finding(NamedTuple):
    """A clause of one kind, and the object in whose docstring it stands."""

    path: str
    name: str
    kind: str
    clause: str

    def __str__(self) -> str:
        return f"{self.path}:{self.name} [{self.kind}] {self.clause}"


class Accepted(NamedTuple):
    """An entry of the list of exceptions: a clause (its beginning) that stays, and the reason."""

    path: str
    name: str
    clause: str
    reason: str

    def covers(self, finding: Finding) -> bool:
        """Return whether this entry accepts a clause."""
        same_object = (self.path, self.name) == (finding.path, finding.name)
        return same_object and finding.clause.startswith(self.clause)


def docstrings(tree: ast.AST, prefix: str = "") -> Iterator[tuple[str, str]]:
    """Yield the dotted name and the docstring of a module ("") and of its classes and functions."""
    if isinstance(tree, DOCUMENTED) and (text := ast.get_docstring(tree)):
        yield prefix, text
    for node in ast.iter_child_nodes(tree):
        name = getattr(node, "name", "") if isinstance(node, DOCUMENTED) else ""
        yield from docstrings(node, f"{prefix}.{name}".strip(".") if name else prefix)


def clauses(docstring: str) -> Iterator[str]:
    """Yield the clauses of a docstring, without examples, headings of sections and types of parameters."""
    text = re.sub(r"^ *>>>.*(?:\n(?! *\n).*)*", "", docstring, flags=re.MULTILINE)
    text = re.sub(r"^.*\n *-{3,}$", "\n", text, flags=re.MULTILINE)
    text = re.sub(r"^[\w*, ]+ : .*$", "\n", text, flags=re.MULTILINE)
    for part in re.split(r"\n\s*\n", text):
        yield from re.split(r"(?<=[.;:]) ", re.sub(r"\s+", " ", part).strip())


def findings(package: str, root: Path = ROOT) -> list[Finding]:
    """Return the clauses of every kind in the docstrings of a package."""
    found = []
    for path in sorted((root / package).rglob("*.py")):
        place = path.relative_to(root).as_posix()
        for name, text in docstrings(ast.parse(path.read_text(encoding="utf-8"))):
            for clause in clauses(text):
                found += [
                    Finding(place, name, kind, clause) for kind, p in KINDS.items() if re.search(p, clause)
                ]
    return found


def accepted() -> list[Accepted]:
    """Return the exceptions listed by hand: a line each, `path:object | clause | reason`."""
    lines = (Path(__file__).parent / "english_exceptions.txt").read_text(encoding="utf-8").splitlines()
    fields = [line.split(" | ") for line in lines if line and not line.startswith("#")]
    return [Accepted(*place.split(":"), clause, reason) for place, clause, reason in fields]


if __name__ == "__main__":
    listed = [one for package in sys.argv[1:] for one in findings(package.strip("/"))]
    kept = [one for one in listed if not any(entry.covers(one) for entry in accepted())]
    print(*kept, sep="\n")
    for kind, count in Counter(one.kind for one in kept).most_common():
        print(f"{count:5} {kind}")
