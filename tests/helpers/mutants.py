"""Faults of a file or package that its tests do not notice, by cosmic-ray.

Usage: python tests/helpers/mutants.py FOLDER FILE_OR_PACKAGE [COUNT]   (COUNT faults, 20 unless given)

Lines are drawn from a fixed seed, and one fault of each. The faults are put into a clone of the last commit,
one at a time, and those tests run against each that enter its function (`entered.py`). FOLDER keeps the faults
and what came of them: the next command goes on there, and tries again those that survived; one that changes no
answer gets a "why" there, by hand. docs/development/robustness.md has what was found so.
"""

import difflib
import json
import random
import subprocess
import sys
from collections import Counter
from pathlib import Path

from cosmic_ray.ast import ast_nodes, get_ast
from cosmic_ray.mutating import mutate_code
from cosmic_ray.plugins import get_operator, operator_names
from entered import Entered

NO_FAULT = ("BitOr", "NoOp", "Variable")  # operators of types, and those that need more than a place


def main(folder: Path, place: str, count: int) -> None:
    """Draw the faults, try them, and print how many are noticed."""
    tree, kept = folder / "tree", folder / f"{place.strip('/').replace('/', '.')}.json"
    folder.mkdir(parents=True, exist_ok=True)
    if not tree.exists():
        subprocess.run(["git", "clone", "--quiet", ".", str(tree)], check=True)
    subprocess.run(["git", "-C", str(tree), "fetch", "--quiet", str(Path.cwd()), "HEAD"], check=True)
    subprocess.run(["git", "-C", str(tree), "checkout", "--quiet", "--force", "FETCH_HEAD"], check=True)
    faults = json.loads(kept.read_text()) if kept.exists() else _drawn(tree, place, count)
    entered = Entered(tree, folder / "entered")
    for fault in faults:
        if fault["result"] in ("", "survives"):
            fault |= _tried(tree, fault, entered)
            print(f"{fault['result']} {fault['by']}\n{fault['change']}", flush=True)
            kept.write_text(json.dumps(faults, indent=1, ensure_ascii=False))
    results = {fault["file"]: Counter[str]() for fault in faults}
    for fault in faults:
        results[fault["file"]]["no fault" if "why" in fault else fault["result"]] += 1
    for file, counts in [*sorted(results.items()), (place, sum(results.values(), Counter()))]:
        print(f"{file:<60}" + "".join(f"{n:>4} {result}" for result, n in sorted(counts.items())))


def _drawn(tree: Path, place: str, count: int) -> list[dict]:
    """Return faults of lines of the files, each line as likely as another."""
    chance, faults, known = random.Random(0), [], {}
    files = sorted((tree / place).rglob("*.py")) or [tree / place]
    lines = [(file, line) for file in files for line in range(1, file.read_text().count("\n") + 1)]
    for file, line in chance.sample(lines, len(lines)):
        text, name = file.read_text(), str(file.relative_to(tree))
        if file not in known:
            known[file] = _operators(text)
        if len(faults) < count and line in known[file]:
            changed = mutate_code(text, *chance.choice(known[file][line]))
            texts = text.splitlines(keepends=True), changed.splitlines(keepends=True)
            change = "".join(difflib.unified_diff(*texts, f"a/{name}", f"b/{name}"))
            faults.append({"file": name, "line": line, "change": change, "result": "", "by": ""})
    return faults


def _operators(text: str) -> dict[int, list]:
    """Return the operators that change each line, with their occurrences."""
    found, nodes = {}, list(ast_nodes(get_ast(text)))
    for name in operator_names():
        if not any(word in name for word in NO_FAULT):
            operator = get_operator(name)()
            starts = [start for node in nodes for start, _ in operator.mutation_positions(node)]
            for occurrence, (line, _) in enumerate(starts):
                found.setdefault(line, []).append((operator, occurrence))
    return found


def _tried(tree: Path, fault: dict, entered: Entered) -> dict[str, str]:
    """Return what the tests say of a fault: it is noticed, by which test, or survives; or its line is gone."""
    tests = entered.tests(fault["file"], fault["line"])
    put = subprocess.run(["git", "-C", str(tree), "apply"], input=fault["change"], text=True, capture_output=True)
    if put.returncode:
        return {"result": "gone", "by": ""}
    try:
        by = entered.failed(tests)
        return {"result": "noticed" if by else "survives", "by": by}
    finally:
        subprocess.run(["git", "-C", str(tree), "checkout", "--quiet", "."], check=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve(), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 20)
