"""The trial: faults put into the packages one at a time, in a clone of the last commit, and the tests run
against each.

The same faults are drawn from code that has not changed: each has a place by a digest of its name and the
draw's seed, and the first of each package are taken. tried.jsonl beside this file has a line a trial: draw,
fault, commit, the test that failed or null, seconds of processor time and the files of tests that were run.
What stands there is not tried again but for survivors, with ``--survivors TEXT``, on the nearest tests or on
``--tests``, where equivalent.toml does not say why no test can tell. A test that notices a fault is itself
run once on the code as it is: what fails there too proves nothing, and is left out.

Faults of files with compiled kernels are tried as Python (NUMBA_DISABLE_JIT), but for files with intrinsics;
those, and files whose tuples kernels take, are compiled, in a copy of the clone's cache of kernels.

Usage: python tests/mutants/session.py FOLDER   (the clone, its kernels, the tests' times)
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import signal
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

from faults import Fault, faults
from nearest import Nearest, words_of

from sheetbench.kernels import COMPILED

HERE = Path(__file__).resolve().parent
TRIED, EQUIVALENT, JUDGE = HERE / "tried.jsonl", HERE / "equivalent.toml", HERE / "judge.py"
KERNELS = "tests/helpers/kernels.py"
NOT_PYTHON = ("lumped.springs.memory", "link_tiles")  # whose intrinsics only the compiler knows
ENOUGH = 25.0  # seconds of processor time after which a fault has survived
COMPILING = 50.0  # seconds more where kernels are compiled anew
LONGEST = {True: 60.0, False: 15.0}  # seconds more for a test that is begun: compiled or as Python
HUNG = 1800  # seconds on the clock
NO_END = "no end, or a crash: "
NEAREST = (4, 9, 20)  # files of tests: the nearest, more, and the last that are tried
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


class Draw(NamedTuple):
    """``shares``: faults of each package; of files with compiled kernels, or of the others."""

    seed: int
    shares: dict[str, int]
    kernels: bool


DRAWS = {
    "others": Draw(3, {"lumped": 35, "fem_reference": 25, "comparisons": 40}, kernels=False),
    "kernels": Draw(3, {"lumped": 11, "fem_reference": 5, "sheetbench/numerics": 4}, kernels=True),
}


class Session:
    """A folder: the clone ``tree``, its kernels' cache, what tests take."""

    def __init__(self, folder: Path, commit: str):
        self.folder = folder.resolve()
        self.tree, self.cache = self.folder / "tree", self.folder / "cache"
        self.folder.mkdir(parents=True, exist_ok=True)
        if not self.tree.exists():
            subprocess.run(["git", "clone", "--quiet", ".", str(self.tree)], check=True)
        self.git("fetch", "--quiet", str(Path.cwd()), "HEAD")
        self.git("checkout", "--quiet", "--force", "--detach", commit)  # also of a killed run's fault
        self.commit = self.git("rev-parse", "--short", "HEAD").strip()
        self._sound: dict[tuple[str, bool], bool] = {}
        self._nearest = Nearest(self.tree)
        # or else they would be compiled for each fault, and thrown away with it
        environment = self.environment(self.cache)
        subprocess.run([sys.executable, KERNELS], cwd=self.tree, env=environment, stdout=subprocess.DEVNULL)

    def environment(self, cache: Path) -> dict[str, str]:
        """Of what runs in the tree."""
        places = {"PYTHONPATH": str(self.tree), "NUMBA_CACHE_DIR": str(cache), "MPLBACKEND": "agg"}
        return {**os.environ, **ONE_THREAD, **places}

    def git(self, *words: str) -> str:
        return subprocess.run(
            ["git", "-C", str(self.tree), *words], check=True, capture_output=True, text=True
        ).stdout

    def try_fault(self, fault: Fault, draw: str, chosen: list[str]) -> dict[str, Any]:
        """One line of the book; on the files of tests that are chosen, or the nearest."""
        nearest = self._nearest.tests(fault.module, words_of(fault.module, fault.function))
        files = chosen or nearest[: NEAREST[-1]]
        parts = [files[start:end] for start, end in zip((0, *NEAREST), NEAREST, strict=False)]
        groups = [part for part in parts if part]
        source = (self.tree / fault.module).read_text()
        kernels = DRAWS[draw].kernels
        compiled = "njit" not in source or any(name in source for name in NOT_PYTHON)
        most = ENOUGH + COMPILING * (kernels and compiled)
        with self.cache_of_the_fault(kernels and compiled) as cache:
            failed, seconds, run = self.first_to_notice(fault, groups, most, cache, compiled)
        code = source.splitlines()[fault.line - 1].strip()
        row = {"draw": draw, "fault": fault.name, "code": code, "commit": self.commit, "failed": failed}
        row |= {"seconds": round(seconds, 1), "files": [name for name in files if name in run]}
        with TRIED.open("a") as book:
            book.write(json.dumps(row, ensure_ascii=False) + "\n")
        return row

    def first_to_notice(
        self, fault: Fault, groups: list[list[str]], most: float, cache: Path, compiled: bool
    ) -> tuple[str | None, float, set[str]]:
        """The test that noticed, the seconds spent, the files run; what fails anyway is passed over."""
        spent, run = 0.0, set[str]()
        for files in groups:
            failed: str | None = ""
            while failed is not None and spent < most:
                unfit = [test for (test, way), sound in self._sound.items() if way == compiled and not sound]
                words = words_of(fault.module, fault.function)
                with self.faulty(fault):
                    failed, seconds = self.verdict(files, words, unfit, most - spent, cache, compiled)
                spent, run = spent + seconds, run | set(files)
                if failed and not compiled and failed.startswith(NO_END):
                    self._sound[failed.removeprefix(NO_END), compiled] = False  # or too slow as Python
                elif failed and self.is_sound(failed.removeprefix(NO_END), compiled):
                    return failed, spent, run
        return None, spent, run

    @contextmanager
    def faulty(self, fault: Fault) -> Iterator[None]:
        """The tree with the fault; the file is put back whatever happens."""
        path = self.tree / fault.module
        source, written = path.read_bytes(), path.stat().st_mtime
        try:
            path.write_bytes(fault.put_into(source))
            os.utime(path, 2 * (fault.digest(),))  # byte code goes by a file's time, to the second
            yield
        finally:
            path.write_bytes(source)
            os.utime(path, (written, written))

    @contextmanager
    def cache_of_the_fault(self, kernels: bool) -> Iterator[Path]:
        """Of kernels that are compiled, with the faulty one and its callers, anew; or else the tree's."""
        cache = self.folder / "cache-of-the-fault" if kernels else self.cache
        if kernels:
            shutil.rmtree(cache, ignore_errors=True)
            shutil.copytree(self.cache, cache, copy_function=os.link)
        try:
            yield cache
        finally:
            if kernels:
                shutil.rmtree(cache, ignore_errors=True)

    def is_sound(self, test: str, compiled: bool) -> bool:
        """Whether a test passes on the code as it is."""
        if (test, compiled) not in self._sound:
            failed, _ = self.verdict([test], [], [], ENOUGH + COMPILING, self.cache, compiled)
            self._sound[test, compiled] = failed is None
        return self._sound[test, compiled]

    def verdict(
        self, files: list[str], words: list[str], skipped: list[str], most: float, cache: Path, compiled: bool
    ) -> tuple[str | None, float]:
        """The test that noticed and the seconds spent; one that does not end or crashes has noticed."""
        question, verdict, book = (self.folder / name for name in ("asked.json", "verdict.json", "took.json"))
        took = json.loads(book.read_text()) if book.exists() else {}
        about = {
            "files": files,
            "words": words,
            "skipped": skipped,
            "seconds": most,
            "longest": LONGEST[compiled],
        }
        question.write_text(json.dumps({**about, "took": took if compiled else {}}))
        verdict.write_text(json.dumps({"running": files[0]}))  # of what ends before a test is begun
        run = subprocess.Popen(
            [sys.executable, str(JUDGE), str(question), str(verdict)],
            cwd=self.tree,
            env=self.environment(cache) | ({} if compiled else {"NUMBA_DISABLE_JIT": "1"}),
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        with suppress(subprocess.TimeoutExpired):
            try:
                run.wait(HUNG)
            finally:
                if run.poll() is None:
                    os.killpg(run.pid, signal.SIGKILL)
                    run.wait()
        found = json.loads(verdict.read_text())
        if "running" in found:
            return NO_END + found["running"], most
        if compiled and cache == self.cache:
            book.write_text(json.dumps({**took, **found["took"]}))
        return found["failed"], found["seconds"]


def drawn(tree: Path, draw: Draw) -> list[Fault]:
    """The draw's faults, the packages mixed."""
    places = {}
    for package, share in draw.shares.items():
        found = [
            fault
            for path in sorted((tree / package).rglob("*.py"))
            if (package != "comparisons" and COMPILED.search(path.read_text()) is not None) == draw.kernels
            for fault in faults(str(path.relative_to(tree)), path.read_bytes())
        ]
        first = sorted(found, key=lambda fault: fault.digest(draw.seed))[:share]
        places |= {((i + 0.5) / share, package): fault for i, fault in enumerate(first)}
    return [places[place] for place in sorted(places)]


def trials() -> dict[str, list[dict[str, Any]]]:
    """By the faults' names, the lines of each in their order."""
    found: dict[str, list[dict[str, Any]]] = {}
    for row in map(json.loads, TRIED.read_text().splitlines()):
        found.setdefault(row["fault"], []).append(row)
    return found


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("folder", type=Path)
    asked.add_argument("--commit", default="FETCH_HEAD", metavar="HASH", help="the last unless given")
    asked.add_argument("--survivors", default="", metavar="TEXT", help="try again those whose names have it")
    asked.add_argument("--tests", nargs="+", default=[], metavar="FILE", help="instead of the nearest")
    options = asked.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended; to be gone on with"))
    session = Session(options.folder, options.commit)
    if missing := [name for name in options.tests if not (session.tree / name.partition("::")[0]).exists()]:
        raise SystemExit(f"no such tests: {', '.join(missing)}")
    tried, reasons = trials(), tomllib.loads(EQUIVALENT.read_text())["equivalent"]
    chosen = [(name, fault) for name, draw in DRAWS.items() for fault in drawn(session.tree, draw)]
    asked_for = [(name, fault) for name, fault in chosen if fault.name not in tried]
    if options.survivors:
        survived = {name: rows[-1]["draw"] for name, rows in tried.items() if rows[-1]["failed"] is None}
        wanted = {name for name in survived.keys() - reasons.keys() if options.survivors in name}
        modules = sorted({name.partition(" ")[0] for name in wanted})
        there = [fault for name in modules for fault in faults(name, (session.tree / name).read_bytes())]
        asked_for = [(survived[fault.name], fault) for fault in there if fault.name in wanted]
    for number, (name, fault) in enumerate(asked_for, 1):
        row = session.try_fault(fault, name, options.tests)
        print(
            f"{number} of {len(asked_for)}",
            row["failed"] or "SURVIVED",
            row["seconds"],
            fault.name,
            sep="  ",
            flush=True,
        )


if __name__ == "__main__":
    main()
