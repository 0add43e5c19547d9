"""Faults of a file or package that its tests do not notice, by cosmic-ray.

Usage: python tests/helpers/mutants.py FOLDER FILE_OR_PACKAGE [COUNT]   (COUNT faults, 20 unless given)

Lines are drawn from a fixed seed, and one fault of each. The faults are put into a clone of the last commit,
one at a time, and the nearest files of tests run against it, one after the other, until one fails. FOLDER
keeps the faults and what came of them: the next command goes on there, and tries again those that survived;
one that changes no answer gets a "why" there, by hand. docs/development/robustness.md has what was found so.
"""

import difflib
import inspect
import json
import multiprocessing
import os
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path
from resource import RLIMIT_CPU, RUSAGE_CHILDREN, getrusage, setrlimit
from typing import Any

import pytest
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.ast.ast_query import ASTQuery
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names
from nearest import FOLDERS, Nearest, has, words_of

SECONDS = 8.0  # of CPU after which no further file of tests is tried
LIMIT, WAIT = 60, 900.0  # s of CPU and by the clock for one file of tests
NO_FAULT = ("BitOr", "NoOp", "Variable")  # operators of types, and those that need more than a place


def main(folder: Path, place: str, count: int) -> None:
    """Draw the faults, try them, and print how many are noticed."""
    tree, kept = folder / "tree", folder / f"{place.strip('/').replace('/', '.')}.json"
    _check_out(tree)
    faults = json.loads(kept.read_text()) if kept.exists() else []
    faults += _drawn(place, count)[len(faults) :]
    nearest = Nearest(tree)
    for fault in faults:
        if fault["result"] in ("", "survives") and "why" not in fault:
            fault |= tried(fault, nearest)
            print(f"{fault['result']} {fault['by']}\n{fault['change']}", flush=True)
            kept.write_text(json.dumps(faults, indent=1, ensure_ascii=False))
    results = {fault["file"]: Counter[str]() for fault in faults}
    for fault in faults:
        results[fault["file"]]["no fault" if "why" in fault else fault["result"]] += 1
    for file, counts in [*sorted(results.items()), (place, sum(results.values(), Counter()))]:
        print(f"{file:<60}" + "".join(f"{n:>4} {result}" for result, n in sorted(counts.items())))


def _check_out(tree: Path) -> None:
    """Make a clone of the last commit, or bring it there, and import the packages from it."""
    tree.parent.mkdir(parents=True, exist_ok=True)
    if not tree.exists():
        subprocess.run(["git", "clone", "--quiet", ".", str(tree)], check=True)
    subprocess.run(["git", "-C", str(tree), "fetch", "--quiet", str(Path.cwd()), "HEAD"], check=True)
    subprocess.run(["git", "-C", str(tree), "checkout", "--quiet", "--force", "FETCH_HEAD"], check=True)
    os.chdir(tree)
    os.environ |= {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}
    sys.path.insert(0, str(tree))
    sys.dont_write_bytecode = True  # of faults
    for name in ("comparisons.cli", "fem_reference", "lumped", "hypothesis", "matplotlib.pyplot", "skfem"):
        __import__(name)


def _drawn(place: str, count: int) -> list[dict]:
    """Return faults of lines of the files, each line as likely as another."""
    chance, faults, known = random.Random(0), [], {}
    files = sorted(Path(place).rglob("*.py")) or [Path(place)]
    lines = [(file, line) for file in files for line in range(1, file.read_text().count("\n") + 1)]
    for file, line in chance.sample(lines, len(lines)):
        if len(faults) == count:
            break
        if file not in known:
            known[file] = _operators(file.read_text())
        if line in known[file]:
            operator, occurrence, function = chance.choice(known[file][line])
            old = file.read_text()
            texts = old.splitlines(True), mutate_code(old, operator, occurrence).splitlines(True)
            change = "".join(difflib.unified_diff(*texts, f"a/{file}", f"b/{file}"))
            fault = {"file": str(file), "line": line, "function": function, "change": change}
            faults.append({**fault, "result": "", "by": ""})
    return faults


def _operators(text: str) -> dict[int, list]:
    """Return the operators that change each line, with their occurrences and the function it is in."""
    found, nodes = {}, list(ast_nodes(get_ast(text)))
    for name in operator_names():
        if not any(word in name for word in NO_FAULT):
            operator = get_operator(name)()
            places = [(start[0], node) for node in nodes for start, _ in operator.mutation_positions(node)]
            for occurrence, (line, node) in enumerate(places):
                function = ASTQuery(node).get_definition_name() or ""
                found.setdefault(line, []).append((operator, occurrence, function))
    return found


def tried(fault: dict, nearest: Nearest) -> dict[str, str]:
    """Return what tests say of a fault: noticed, by which, or survives; or that its line is gone."""
    if subprocess.run(["git", "apply"], input=fault["change"], text=True).returncode:
        return {"result": "gone", "by": ""}
    begun, words = getrusage(RUSAGE_CHILDREN).ru_utime, words_of(fault["file"], fault["function"])
    for test in nearest.tests(fault["file"], words):
        by = _first_failed(test, words)
        if by == test:  # ended by a limit or a crash: without the fault too?
            subprocess.run(["git", "apply", "--reverse"], input=fault["change"], text=True, check=True)
            by = "" if _first_failed(test, words) else f"{test}, ended"
            subprocess.run(["git", "apply"], input=fault["change"], text=True, check=True)
        if by or getrusage(RUSAGE_CHILDREN).ru_utime - begun > SECONDS:
            break
    subprocess.run(["git", "checkout", "--quiet", "."], check=True)
    return {"result": "noticed" if by else "survives", "by": by}


def _first_failed(test: str, words: list[str]) -> str:
    """Return the test of a file that fails first; the file itself where it is ended; "" where none fails."""
    ours, theirs = (fork := multiprocessing.get_context("fork")).Pipe()
    child = fork.Process(target=_pytest, args=(theirs, test, words))
    child.start()
    theirs.close()
    try:
        return ours.recv() if ours.poll(WAIT) else test
    except EOFError:
        return test
    finally:
        child.kill()
        child.join()


def _pytest(pipe: Any, test: str, words: list[str]) -> None:
    """Run a file of tests in a fork, where the packages are imported anew, and send what fails first."""
    for name in [name for name in sys.modules if name.partition(".")[0] in FOLDERS[:4]]:
        del sys.modules[name]
    setrlimit(RLIMIT_CPU, (LIMIT, LIMIT))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    failed = Failed(words)
    status = pytest.main(["-x", "-q", "-n0", "-p", "no:cacheprovider", test], plugins=[failed])
    pipe.send(failed.first or "import" * (status in (2, 3, 4)))


class Failed:
    """A plug-in of pytest: the first test that fails; tests that name the function or its module first."""

    def __init__(self, words: list[str]):
        self.first, self._words = "", words

    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Order them."""
        texts = {item: f"{item.name} {inspect.getsource(item.obj)}" for item in items}
        items.sort(key=lambda item: -sum(has(texts[item], word) for word in self._words))

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep its name."""
        self.first = self.first or report.nodeid * report.failed


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 20)
