"""Which functions of the solvers each test runs, so that a fault is tried on tests that run it.

Usage, in the tree: python record.py BOOK [pytest's arguments]
BOOK, a JSON line a test: its name, the seconds of processor time it took, and the functions of Python that it
entered, by itself or by its fixtures, as "module function". What compiled kernels call is not seen. Tests in
BOOK are not run again.
"""

from __future__ import annotations

import json
import sys
import threading
from collections.abc import Iterator
from pathlib import Path
from types import CodeType, FrameType
from typing import Any

import pytest
from judge import spent
from reach import PACKAGES, rows

INSIDE = ".<locals>"


class Recorder:
    """Hears of every function that is entered, and writes down those of the solvers."""

    def __init__(self, tree: Path, book: Path):
        self.tree, self.book = str(tree), book
        self.entered: set[CodeType] = set()
        self._of_fixture: dict[Any, set[CodeType]] = {}
        self._known = {row["test"] for row in rows(book)}

    def hear(self, frame: FrameType, event: str, _: object) -> None:
        """What sys.settrace calls when a function is entered; its lines are not followed."""
        self.entered.add(frame.f_code)

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        items[:] = [item for item in items if item.nodeid not in self._known]

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef: Any) -> Iterator[None]:
        outer, self.entered = self.entered, set()
        try:
            return (yield)
        finally:
            self._of_fixture[fixturedef] = self.entered
            self.entered = outer | self.entered

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Iterator[None]:
        self.entered, since = set(), spent()
        sys.settrace(self.hear)
        threading.settrace(self.hear)
        try:
            return (yield)
        finally:
            sys.settrace(None)
            threading.settrace(None)  # type: ignore[arg-type]
            for name, found in item._fixtureinfo.name2fixturedefs.items():  # type: ignore[attr-defined]
                if name in item.fixturenames:  # type: ignore[attr-defined]
                    self.entered |= self._of_fixture.get(found[-1], set())
            row = {"test": item.nodeid, "seconds": round(spent() - since, 2), "runs": self.functions()}
            with self.book.open("a") as book:
                book.write(json.dumps(row) + "\n")

    def functions(self) -> list[str]:
        """Of the solvers, among what was entered."""
        found = set()
        for code in self.entered:
            if code.co_filename.startswith(self.tree) and not code.co_qualname.endswith(">"):
                module = code.co_filename[len(self.tree) + 1 :]
                if module.startswith(PACKAGES):
                    found.add(f"{module} {code.co_qualname.replace(INSIDE, '')}")
        return sorted(found)


def main() -> int:
    book, *options = sys.argv[1:]
    recorder = Recorder(Path.cwd(), Path(book).resolve())
    return pytest.main(["-q", "-p", "no:cacheprovider", "--no-header", "--tb=line", *options], [recorder])


if __name__ == "__main__":
    sys.exit(main())
