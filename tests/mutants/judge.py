"""Whether tests notice: run, the promising and quick ones first, until one fails or enough time is spent.

Usage, in the tree to be judged: python judge.py ASKED VERDICT
ASKED, JSON: files of tests, the nearest first; tests to be skipped; words that promising tests use; seconds
that may be spent, and more by a test that was begun; what single tests are known to take. VERDICT, JSON: the
test that failed or null, the seconds of processor time spent, and what each test took; or the test that runs.
"""

from __future__ import annotations

import inspect
import json
import math
import os
import resource
import sys
from pathlib import Path
from typing import Any

import pytest
from nearest import SPOKEN_OF, has

NEW = 100.0  # in favour of a test that was not run yet: such are written for what has survived


def spent() -> float:
    """Seconds of processor time, of ended children too."""
    times = os.times()
    return times.user + times.system + times.children_user + times.children_system


class Watch:
    """Orders the tests, remembers what failed, ends the run when time is over."""

    def __init__(self, asked: dict[str, Any], verdict: Path):
        self.asked, self.verdict = asked, verdict
        self.files = [name.partition("::")[0] for name in asked["files"]]
        self.failed: str | None = None
        self.took: dict[str, float] = {}
        self._since = 0.0
        self._too_long: set[str] = set()

    def effort(self, item: pytest.Item) -> float:
        """The logarithm of the time that a test takes by how likely it is to notice."""
        place = self.files.index(item.nodeid.partition("::")[0])
        text = item.nodeid + inspect.getsource(item.function)  # type: ignore[attr-defined]
        spoken = sum(has(text, word) for word in self.asked["words"])
        seconds = self.asked["took"].get(item.nodeid)
        new = NEW if seconds is None else 0.0
        return math.log2(max(seconds or 0.0, 0.1)) + math.log2(1 + place) - SPOKEN_OF * spoken - new

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        skipped = set(self.asked["skipped"])
        items[:] = sorted((item for item in items if item.nodeid not in skipped), key=self.effort)

    def pytest_runtest_setup(self, item: pytest.Item) -> None:
        if self.asked["took"].get(item.nodeid, 0.0) > self.asked["seconds"] - spent():
            self._too_long.add(item.nodeid)
            pytest.skip("longer than what is left")

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        self._since = spent()
        self.verdict.write_text(json.dumps({"running": nodeid}))  # what stays where the test does not end

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.failed = self.failed or report.nodeid

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        if nodeid not in self._too_long:
            self.took[nodeid] = round(spent() - self._since, 2)

    def pytest_runtest_teardown(self, item: pytest.Item) -> None:
        if spent() > self.asked["seconds"]:
            item.session.shouldstop = "enough"


def main() -> None:
    asked, verdict = (Path(name) for name in sys.argv[1:])
    watch = Watch(json.loads(asked.read_text()), verdict)
    limit = math.ceil(watch.asked["longest"] + watch.asked["seconds"])
    resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
    options = ["-q", "-x", "-p", "no:cacheprovider", "--no-header", "--tb=line"]
    pytest.main([*options, *watch.asked["files"]], plugins=[watch])
    found = {"failed": watch.failed, "seconds": round(spent(), 1), "took": watch.took}
    verdict.write_text(json.dumps(found))


if __name__ == "__main__":
    main()
