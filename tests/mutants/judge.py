"""The tests that may notice a mutant, until one fails: those that name its module, its folder, then others.

A module with compiled functions is compiled anew into a cache that is thrown away: what other modules have
compiled of it would hide the mutant, or outlive it.

Usage, in a tree with one changed file: python tests/mutants/judge.py TEST_FILE...
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path


def changed() -> Path:
    """The mutated file; fails unless it is just one."""
    names = subprocess.run(
        ["git", "diff", "--name-only"], check=True, capture_output=True, text=True
    ).stdout.split()
    (name,) = names
    return Path(name)


def tests_for(module: Path, usual: list[str]) -> list[str]:
    """Files of tests, the nearest first, each once."""
    dotted = ".".join(module.with_suffix("").parts)
    package = ".".join(module.parent.parts)
    files = sorted(path for path in Path("tests").glob("*.py") if path.stem.partition("_")[0] == "test")
    texts = {str(path): path.read_text() for path in files}
    direct = [name for name, text in texts.items() if dotted in text or names_it(text, package, module.stem)]
    near = [name for name, text in texts.items() if package in text]
    return list(dict.fromkeys([*direct, *near, *usual]))


def names_it(text: str, package: str, stem: str) -> bool:
    """Whether a test takes a module from its package by name."""
    return any(
        line.startswith(f"from {package} import") and stem in line.replace(",", " ").split()
        for line in text.splitlines()
    )


def main() -> int:
    module = changed()
    with tempfile.TemporaryDirectory() as thrown_away:
        environment = dict(os.environ)
        if "njit" in module.read_text():
            environment["NUMBA_CACHE_DIR"] = thrown_away
        command = [sys.executable, "-m", "pytest", "-q", "-x", "-p", "no:cacheprovider"]
        return subprocess.run([*command, *tests_for(module, sys.argv[1:])], env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
