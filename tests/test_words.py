"""Docstrings are plain technical English, and those of public names have numpydoc's sections."""

from enum import Enum
from importlib import import_module
from inspect import isclass, isroutine

import pytest
from english import KINDS, accepted, findings
from numpydoc.docscrape import get_doc_object
from numpydoc.validate import validate

PACKAGES = ("sheetbench", "lumped", "fem_reference")
ROOMS = (*PACKAGES, "comparisons", "studies")
IGNORED = {  # numpydoc's codes
    "SA01": "no See Also: the reference is in reading order, and the site links every name",
    "ES01": "a summary may be the whole text: Parameters, Returns and Notes have the rest",
    "EX01": "an Examples section only where a short one runs; the pages of docs have others",
    "GL01": "the summary is on the opening line, as everywhere in the house",
    "GL02": "the closing quotes may end the last line of a short text",
    "GL03": "follows from GL01 and GL02",
}


@pytest.fixture(scope="module")
def clauses():
    return [one for package in ROOMS for one in findings(package)]


@pytest.mark.parametrize("kind", KINDS)
def test_no_clause_is_of_a_kind_that_readers_stumble_over(kind, clauses):
    exceptions = accepted()
    left = [one for one in clauses if one.kind == kind and not any(entry.covers(one) for entry in exceptions)]
    assert not left, "\n".join(map(str, left))


def test_every_exception_is_still_needed_and_has_a_reason(clauses):
    for entry in accepted():
        assert entry.reason.strip(), entry
        assert any(entry.covers(one) for one in clauses), entry


def is_documented(public):
    """Data have no docstring, and an enumeration has its members in place of parameters."""
    return isroutine(public) or (isclass(public) and not issubclass(public, Enum))


@pytest.mark.parametrize("package", PACKAGES)
def test_public_docstrings_have_the_sections_of_numpydoc(package):
    module = import_module(package)
    names = [name for name in module.__all__ if is_documented(getattr(module, name))]
    faults = [
        f"{package}.{name}: {code} {text}"
        for name in names
        for code, text in validate(get_doc_object(getattr(module, name)))["errors"]
        if code not in IGNORED
    ]
    assert names and not faults, "\n".join(faults)
