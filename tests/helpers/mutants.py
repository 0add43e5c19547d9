"""Faults of a file that its nearest tests do not notice, by cosmic-ray.

Usage: python tests/helpers/mutants.py FOLDER FILE [COUNT]   (COUNT faults at random, 20 unless given)

Faults are put into a clone of the last commit, one at a time. NUMBA_DISABLE_JIT=1 before the command runs
kernels as Python. docs/quality.md has what was found so.
"""

import os
import sqlite3
import subprocess
import sys
from pathlib import Path

from nearest import Nearest, words_of

FILES = 6  # of tests, the nearest
SECONDS = 120.0  # after which a run of the tests counts as failed


def main(folder: Path, file: str, count: int) -> None:
    """Make the faults, run the tests against each, and print those that survive."""
    tree, session = folder.resolve() / "tree", folder.resolve() / "session.sqlite"
    folder.mkdir(parents=True, exist_ok=True)
    if not tree.exists():
        subprocess.run(["git", "clone", "--quiet", ".", str(tree)], check=True)
    subprocess.run(["git", "-C", str(tree), "fetch", "--quiet", str(Path.cwd()), "HEAD"], check=True)
    subprocess.run(["git", "-C", str(tree), "checkout", "--quiet", "--force", "FETCH_HEAD"], check=True)
    tests = " ".join(Nearest(tree).tests(file, words_of(file, ""))[:FILES])
    command = f"{sys.executable} -m pytest -x -q -n0 -p no:cacheprovider {tests}"
    settings = (
        f'module-path = "{file}"\ntimeout = {SECONDS}\nexcluded-modules = []\ntest-command = "{command}"\n'
    )
    (tree / "faults.toml").write_text(
        f'[cosmic-ray]\n{settings}[cosmic-ray.distributor]\nname = "local"\n', encoding="utf-8"
    )
    session.unlink(missing_ok=True)
    _cosmic_ray(tree, "cosmic-ray", "init", "faults.toml", str(session))
    _cosmic_ray(tree, "cosmic-ray", "baseline", "faults.toml")  # raises where the tests fail anyway
    with sqlite3.connect(session) as store:
        drawn = "SELECT job_id FROM work_items ORDER BY random() LIMIT ?"
        store.execute(f"CREATE TEMP TABLE drawn AS {drawn}", (count,))
        for table in ("mutation_specs", "work_items"):
            store.execute(f"DELETE FROM {table} WHERE job_id NOT IN (SELECT job_id FROM drawn)")
    _cosmic_ray(tree, "cosmic-ray", "exec", "faults.toml", str(session))
    _cosmic_ray(tree, "cr-report", "--surviving-only", "--show-diff", str(session))


def _cosmic_ray(tree: Path, program: str, *arguments: str) -> None:
    environment = {**os.environ, "PYTHONPATH": str(tree)}
    subprocess.run(
        [Path(sys.executable).with_name(program), *arguments], cwd=tree, env=environment, check=True
    )


if __name__ == "__main__":
    main(Path(sys.argv[1]), sys.argv[2], int(sys.argv[3]) if len(sys.argv) > 3 else 20)
