"""Faults of a file or package that its tests do not notice, by cosmic-ray.

Usage: python tests/helpers/mutants.py FOLDER FILE_OR_PACKAGE [COUNT]   (COUNT faults, 20 unless given)

Faults of lines drawn from a fixed seed are put into a clone of the last commit, one at a time, and the
nearest files of tests run, until one fails. FOLDER keeps the faults and what came of them: the next command
goes on there, and tries those again that survived; one that changes no answer gets a "why" there, by hand.
"""

import difflib
import inspect
import json
import multiprocessing
import os
import random
import resource
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from concurrent.futures.process import BrokenProcessPool, ProcessPoolExecutor
from functools import cache
from itertools import islice
from pathlib import Path
from types import SimpleNamespace

import pytest
from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.ast.ast_query import ASTQuery
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names
from nearest import FOLDERS, Nearest, has, words_of

SECONDS = 20.0  # of CPU after which no further file of tests is tried
LIMIT = 120  # s of CPU of one file of tests
NO_FAULT = ("BitOr", "NoOp", "Variable")  # operators of types, and those that need more than a place


def main(folder: Path, place: str, count: int) -> None:
    """Draw the faults, try them, and print how many are noticed."""
    tree, kept = folder / "tree", folder / f"{place.strip('/').replace('/', '.')}.json"
    check_out(tree)
    faults = json.loads(kept.read_text()) if kept.exists() else []
    faults += islice(drawn(place), len(faults), count)
    nearest, results = Nearest(tree), Counter[tuple[str, str]]()
    for fault in faults:
        if fault["result"] in ("", "survives") and "why" not in fault:
            fault |= tried(fault, nearest)
            print(f"{fault['result']} {fault['by'] or fault['change']}", flush=True)
            kept.write_text(json.dumps(faults, indent=1, ensure_ascii=False))
        results[fault["file"], "no fault" if "why" in fault else fault["result"]] += 1
    for (file, result), number in sorted(results.items()):
        print(f"{file:<60}{number:>4} {result}")


def check_out(tree: Path) -> None:
    """Make a clone of the last commit, or bring it there, and import the packages from it."""
    if not tree.exists():
        subprocess.run(["git", "clone", "--quiet", ".", str(tree)], check=True)
    subprocess.run(["git", "-C", str(tree), "fetch", "--quiet", str(Path.cwd()), "HEAD"], check=True)
    subprocess.run(["git", "-C", str(tree), "checkout", "--quiet", "--force", "FETCH_HEAD"], check=True)
    os.chdir(tree)
    os.environ |= {"PYTHONPATH": str(tree), "PYTHONDONTWRITEBYTECODE": "1"}  # none of faults
    sys.path.insert(0, str(tree))
    for name in ("comparisons.cli", "fem_reference", "lumped", "hypothesis", "matplotlib.pyplot"):
        __import__(name)


def drawn(place: str) -> Iterator[dict[str, str]]:
    """Yield a fault of each line of the files that can have one, in any order."""
    chance = random.Random(0)
    files = sorted(Path(place).rglob("*.py")) or [Path(place)]
    lines = [(file, line) for file in files for line in range(1, file.read_text().count("\n") + 1)]
    for file, line in chance.sample(lines, len(lines)):
        if line in operators(file):
            operator, occurrence, function = chance.choice(operators(file)[line])
            texts = file.read_text(), mutate_code(file.read_text(), operator, occurrence)
            lines_of = (text.splitlines(keepends=True) for text in texts)
            change = "".join(difflib.unified_diff(*lines_of, f"a/{file}", f"b/{file}"))
            yield {"file": str(file), "function": function, "change": change, "result": "", "by": ""}


@cache
def operators(file: Path) -> dict[int, list]:
    """Return the operators that change each line, with their occurrences and the function it is in."""
    found, nodes = {}, list(ast_nodes(get_ast(file.read_text())))
    for name in operator_names():
        if not any(word in name for word in NO_FAULT):
            operator = get_operator(name)()
            places = [(start[0], node) for node in nodes for start, _ in operator.mutation_positions(node)]
            for occurrence, (line, node) in enumerate(places):
                function = ASTQuery(node).get_definition_name() or ""
                found.setdefault(line, []).append((operator, occurrence, function))
    return found


def tried(fault: dict[str, str], nearest: Nearest) -> dict[str, str]:
    """Return what tests say of a fault: noticed, by which, or survives; or that its line is gone."""
    if subprocess.run(["git", "apply", "-C1"], input=fault["change"], text=True).returncode:
        return {"result": "gone", "by": ""}
    begun, words, by = os.times().children_user, words_of(fault["file"], fault["function"]), ""
    for test in nearest.tests(fault["file"], words):
        with ProcessPoolExecutor(1, multiprocessing.get_context("fork")) as fork:
            try:
                by = fork.submit(first_failed, test, words).result()
            except BrokenProcessPool:
                by = f"{test}: the limit of time, or a crash"
        if by or os.times().children_user - begun > SECONDS:
            break
    subprocess.run(["git", "checkout", "--quiet", "."], check=True)
    return {"result": "noticed" if by else "survives", "by": by}


def first_failed(test: str, words: list[str]) -> str:
    """Return the test of a file that fails first, "" where none does. Those that name the function or its
    module run first, and the packages are imported anew."""
    for name in [name for name in sys.modules if name.partition(".")[0] in FOLDERS[:4]]:
        del sys.modules[name]
    resource.setrlimit(resource.RLIMIT_CPU, (LIMIT, LIMIT))
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    failed = list[str]()

    def order(items: list[pytest.Item]) -> None:
        texts = {item: f"{item.name} {inspect.getsource(item.obj)}" for item in items}
        items.sort(key=lambda item: -sum(has(texts[item], word) for word in words))

    hooks = SimpleNamespace(
        pytest_collection_modifyitems=order,
        pytest_runtest_logreport=lambda report: failed.extend([report.nodeid] * report.failed),
    )
    status = pytest.main(["-x", "-q", "-n0", "-p", "no:cacheprovider", test], plugins=[hooks])
    return "".join(failed[:1]) or "an import" * (status in (2, 3, 4))


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 20)
