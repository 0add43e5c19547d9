"""Which tests enter a function, how long they take, and which of them fails in a tree with a fault."""

import ast
import json
import multiprocessing
import os
import sys
from pathlib import Path

import pytest
from nearest import FOLDERS, Nearest, words_of

FILES = (6, 18)  # of tests, the nearest, that are looked at; more where none of them enters the function
SECONDS = 20.0  # of CPU that the tests of a fault take together
WAIT = 300.0  # s: tests that take longer have noticed a fault
FORK = multiprocessing.get_context("fork")


class Entered:
    """The tests of a tree, run in forks of this process, which has imported what they import."""

    def __init__(self, tree: Path, kept: Path):
        self._kept, self._nearest = kept, Nearest(tree)
        kept.mkdir(exist_ok=True)
        os.chdir(tree)
        os.environ["PYTHONPATH"] = str(tree)
        sys.path.insert(0, str(tree))
        for name in ("comparisons.cli", "fem_reference", "lumped"):
            __import__(name)

    def tests(self, file: str, line: int) -> list[str]:
        """Return the tests that enter the function at a line, else its module, else the nearest: the quickest
        files first, as many tests as run within SECONDS."""
        function = f"{file}:{function_at(Path(file).read_text(), line)}"
        nearest = self._nearest.tests(file, words_of(file, ""))
        for count, part in ((FILES[0], function), (FILES[1], function), (FILES[0], f"{file}:"), (FILES[0], "")):
            found = [self._entering(test, part) for test in nearest[:count]]
            if any(found):
                break
        tests: dict[str, float] = {}
        for seconds in sorted(found, key=lambda seconds: sum(seconds.values())):
            for test in sorted(seconds, key=seconds.__getitem__):
                if not tests or sum(tests.values()) + seconds[test] <= SECONDS:
                    tests[test] = seconds[test]
        return list(tests)

    def failed(self, tests: list[str]) -> str:
        """Return the first test that fails, or what else ends them; "" where all pass."""
        said = _run("-x", *tests)
        return said["failed"][0] if said["failed"] else "no test runs" * (said["status"] != 0)

    def _entering(self, test: str, part: str) -> dict[str, float]:
        """Return the tests of a file that enter a function, or any whose name begins so, and their seconds."""
        kept = self._kept / f"{test.replace('/', '.')}-{Path(test).stat().st_size}.json"
        if not kept.exists():
            kept.write_text(json.dumps(_run(test)))
        said = json.loads(kept.read_text())
        names = set(said["seconds"])
        if part:
            entered = [said["entered"][name] for name in said["entered"] if name.startswith(part)]
            names = {name for tests in entered for name in tests}
        return {name: said["seconds"][name] for name in names if name not in said["failed"]}


class Seen:
    """A plug-in of pytest: the seconds of CPU of each test, what fails, and which functions each enters. What
    is entered while a fixture of several tests is made counts for all."""

    def __init__(self, entering: bool):
        self._entering, self._now, self._shared = entering, set(), set()
        self._functions: dict[str, set] = {}
        self.seconds, self.failed, self.status = {}, [], 1

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_protocol(self, item):
        self._now, begun = self._functions.setdefault(item.nodeid, set()), _cpu()
        sys.setprofile(self._enter if self._entering else None)
        try:
            return (yield)
        finally:
            sys.setprofile(None)
            self.seconds[item.nodeid] = _cpu() - begun

    @pytest.hookimpl(wrapper=True)
    def pytest_fixture_setup(self, fixturedef):
        before = self._now
        self._now = before if fixturedef.scope == "function" else self._shared
        try:
            return (yield)
        finally:
            self._now = before

    def pytest_runtest_logreport(self, report):
        if report.failed:
            self.failed.append(report.nodeid)

    def _enter(self, frame, event, _):
        if event == "call":
            self._now.add((frame.f_code.co_filename, frame.f_code.co_qualname))

    def said(self) -> dict:
        """Return what the plug-in saw, in the types of JSON."""
        root, entered = f"{os.getcwd()}/", {}
        for test, functions in self._functions.items():
            for file, name in functions | self._shared:
                if file.removeprefix(root).partition("/")[0] in FOLDERS[:4]:
                    entered.setdefault(f"{file.removeprefix(root)}:{name.split('.<')[0]}", []).append(test)
        return {"seconds": self.seconds, "failed": self.failed, "status": self.status, "entered": entered}


def _run(*arguments: str) -> dict:
    """Return what a plug-in sees of a run of pytest in a fork; without -x, which functions are entered."""
    ours, theirs = FORK.Pipe()
    child = FORK.Process(target=_pytest, args=(theirs, arguments))
    child.start()
    theirs.close()
    try:
        said = ours.recv() if ours.poll(WAIT) else {"failed": [f"the limit of {WAIT:.0f} s"]}
    except EOFError:
        said = {"failed": ["a crash"]}
    child.kill()
    child.join()
    return {"seconds": {}, "entered": {}, **said}


def _pytest(pipe, arguments: tuple[str, ...]) -> None:
    """Run pytest in a fork, where the packages are imported anew."""
    for name in [name for name in sys.modules if name.partition(".")[0] in FOLDERS[:4]]:
        del sys.modules[name]
    sys.dont_write_bytecode = "-x" in arguments  # of a fault
    if sys.dont_write_bytecode:
        os.environ["PYTHONDONTWRITEBYTECODE"] = "1"
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    seen = Seen("-x" not in arguments)
    seen.status = int(pytest.main(["-q", "-n0", "-p", "no:cacheprovider", *arguments], plugins=[seen]))
    pipe.send(seen.said())


def _cpu() -> float:
    return sum(os.times()[:4])


def function_at(text: str, line: int) -> str:
    """Return the name of the function at a line, with its class's; "" outside functions."""
    name, ahead = [], ast.parse(text).body
    for node in ahead:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and node.lineno <= line <= (node.end_lineno or 0):
            name.append(node.name)
            ahead.extend(node.body if isinstance(node, ast.ClassDef) else ())
    return ".".join(name)
