"""Faults of a file that its nearest tests do not notice, by cosmic-ray.

Usage: python tests/helpers/mutants.py FOLDER FILE [COUNT]   (COUNT faults at random, 20 unless given)

Faults are put into a clone of the last commit, one at a time. Each is tried on the nearest files of tests,
the quickest first, as many as run within SECONDS together. NUMBA_DISABLE_JIT=1 before the command runs
kernels as Python. docs/development/robustness.md has what was found so.
"""

import os
import sqlite3
import subprocess
import sys
from pathlib import Path
from resource import RUSAGE_CHILDREN, getrusage

from nearest import Nearest, words_of

FILES = 8  # of tests, the nearest, that are tried for how long they take
SECONDS = 40.0  # of CPU that the files chosen take together without a fault
LONGER = 10.0  # times as long a run of the tests counts as failed, on a machine that may be busy
SAME = "%BinaryOperator_BitOr%"  # operators that make no fault: of types


def main(folder: Path, file: str, count: int) -> None:
    """Make the faults, run the tests against each, and print those that survive."""
    tree, session = folder.resolve() / "tree", folder.resolve() / "session.sqlite"
    folder.mkdir(parents=True, exist_ok=True)
    if not tree.exists():
        subprocess.run(["git", "clone", "--quiet", ".", str(tree)], check=True)
    subprocess.run(["git", "-C", str(tree), "fetch", "--quiet", str(Path.cwd()), "HEAD"], check=True)
    subprocess.run(["git", "-C", str(tree), "checkout", "--quiet", "--force", "FETCH_HEAD"], check=True)
    chosen, seconds = _quick(tree, Nearest(tree).tests(file, words_of(file, ""))[:FILES])
    print(f"tried on, {seconds:.0f} s of CPU: {' '.join(chosen)}", flush=True)
    settings = [
        f'module-path = "{file}"',
        f"timeout = {LONGER * seconds + 10.0}",
        "excluded-modules = []",
        f'test-command = "{" ".join(_pytest(*chosen))}"',
    ]
    lines = ["[cosmic-ray]", *settings, "[cosmic-ray.distributor]", 'name = "local"', ""]
    (tree / "faults.toml").write_text("\n".join(lines), encoding="utf-8")
    session.unlink(missing_ok=True)
    _run(tree, "cosmic_ray.cli:main", "init", "faults.toml", str(session))
    with sqlite3.connect(session) as store:
        sound = f"SELECT job_id FROM mutation_specs WHERE operator_name NOT LIKE '{SAME}'"
        store.execute(f"CREATE TEMP TABLE drawn AS {sound} ORDER BY random() LIMIT ?", (count,))
        for table in ("mutation_specs", "work_items"):
            store.execute(f"DELETE FROM {table} WHERE job_id NOT IN (SELECT job_id FROM drawn)")
    _run(tree, "cosmic_ray.cli:main", "exec", "faults.toml", str(session))
    _run(tree, "cosmic_ray.tools.report:report", "--surviving-only", "--show-diff", str(session))


def _quick(tree: Path, tests: list[str]) -> tuple[list[str], float]:
    """The nearest files of tests that run within SECONDS together, the quickest first, and how long they
    take; at least one. Raises where one fails without a fault."""
    taken: dict[str, float] = {}
    for test in tests:
        for again in (False, True):  # the first time kernels may be compiled
            begun = _cpu()
            subprocess.run(_pytest(test), cwd=tree, env=_environment(tree), check=True, capture_output=True)
            seconds = _cpu() - begun
            if seconds < SECONDS / FILES or again:
                break
        if not taken or sum(taken.values()) + seconds <= SECONDS:
            taken[test] = seconds
    return sorted(taken, key=taken.__getitem__), sum(taken.values())


def _cpu() -> float:
    used = getrusage(RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _pytest(*tests: str) -> list[str]:
    return [sys.executable, "-m", "pytest", "-x", "-q", "-n0", "-p", "no:cacheprovider", *tests]


def _run(tree: Path, program: str, *arguments: str) -> None:
    module, _, name = program.partition(":")
    call = f"import sys; from {module} import {name}; sys.exit({name}())"
    subprocess.run([sys.executable, "-c", call, *arguments], cwd=tree, env=_environment(tree), check=True)


def _environment(tree: Path) -> dict[str, str]:
    beside = os.environ.get("PYTHONPATH", "").split(os.pathsep)[1:]  # the first is this tree's
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(tree), *beside])}


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 20)
