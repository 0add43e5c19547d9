"""Faults put into the packages one at a time, in a clone of the last commit, and the tests run against each.

The same faults are drawn from code that has not changed: each has a place by a digest of its name, and the
first of each package are taken. What was tried is kept line by line in FOLDER/tried.jsonl and not tried again
but for the survivors of an older commit, with ``--survivors``, where equivalent.toml does not say why no test
can tell. A test that notices a fault is itself run once on the code as it is: what fails there too proves
nothing, and ends the session.

Which tests run which function is recorded first, by one run of the tests (record.py), and kept as
FOLDER/reach.jsonl: a fault is tried on those that run it, and on tests that came later.

Usage: python tests/mutants/session.py FOLDER SIZE TEST_FILE...   (the files are the usual ones: make check's)
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
from itertools import zip_longest
from pathlib import Path
from typing import Any, NamedTuple

from faults import Fault, faults
from nearest import Nearest, words_of
from reach import PACKAGES, Reach

JUDGE, RECORD = (Path(__file__).with_name(name).resolve() for name in ("judge.py", "record.py"))
EQUIVALENT = Path(__file__).with_name("equivalent.toml")
KERNELS = "tests/kernels.py"
AS_PYTHON = (
    20.0  # seconds that kernels are tried for as they stand, before they are compiled: some take minutes
)
ENOUGH = 40.0  # seconds of processor time after which a fault has survived
COMPILING = 30.0  # seconds more where kernels are compiled anew
HUNG = 1800  # seconds on the clock
NO_END = "no end, or a crash"
FIRST, ALL = 6, 30  # files of tests that are read first, and at most
NEW = 3  # files that are read for the tests that came after the record
COMPILED = ("njit", "NamedTuple")  # of a file that sheetbench.kernels makes kernels' stamps of
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


class Asked(NamedTuple):
    """What of the tests: words of promising ones, and those that do not run the fault."""

    words: list[str]
    skipped: list[str]


class Session:
    """A folder: the clone ``tree``, its kernels' cache, what was tried."""

    def __init__(self, folder: Path, usual: list[str]):
        self.folder = folder.resolve()
        self.tree, self.cache, self.book = (self.folder / name for name in ("tree", "cache", "tried.jsonl"))
        self.folder.mkdir(parents=True, exist_ok=True)
        if not self.tree.exists():
            subprocess.run(["git", "clone", "--quiet", ".", str(self.tree)], check=True)
        self.git("fetch", "--quiet", str(Path.cwd()), "HEAD")
        self.git("checkout", "--quiet", "--force", "--detach", "FETCH_HEAD")  # also of a killed run's fault
        self.commit = self.git("rev-parse", "--short", "HEAD").strip()
        self._sound: dict[tuple[str, bool], bool] = {}
        self._nearest, self._usual = Nearest(self.tree), usual
        self.run(KERNELS)  # or else they would be compiled for each fault, and thrown away with it
        whole, part = (self.folder / name for name in ("reach.jsonl", "reach-so-far.jsonl"))
        if not whole.exists():
            self.run(RECORD, str(part), "tests")
            part.rename(whole)
        self._reach = Reach(self.tree, whole, self._nearest.imports)

    def run(self, *program: str | Path) -> None:
        """A program in the tree as it is."""
        words = [sys.executable, *map(str, program)]
        subprocess.run(words, cwd=self.tree, env=self.environment(self.cache), stdout=subprocess.DEVNULL)

    def environment(self, cache: Path) -> dict[str, str]:
        """Of what runs in the tree."""
        places = {"PYTHONPATH": str(self.tree), "NUMBA_CACHE_DIR": str(cache)}
        return {**os.environ, **ONE_THREAD, **places}

    def git(self, *words: str) -> str:
        return subprocess.run(
            ["git", "-C", str(self.tree), *words], check=True, capture_output=True, text=True
        ).stdout

    def tried(self) -> dict[str, dict[str, Any]]:
        """By the faults' names; the last word counts."""
        lines = self.book.read_text().splitlines() if self.book.exists() else []
        return {row["fault"]: row for row in map(json.loads, lines)}

    def try_fault(self, fault: Fault) -> dict[str, Any]:
        """One line of the book."""
        source = (self.tree / fault.module).read_text()
        words = words_of(fault.module, fault.function)
        nearest = self._nearest.tests(fault.module, words, self._usual)
        reaching = self._reach.tests(fault.module, fault.function)
        met = {name.partition("::")[0] for name in reaching}
        files = [name for name in nearest if name in met] or nearest
        # what came after the record is in files that are near
        first, others = list(dict.fromkeys([*files[:FIRST], *nearest[:NEW]])), files[FIRST:ALL]
        skipped = [name for name in self._reach.seconds if name not in reaching] if reaching else []
        kernels = any(word in source for word in COMPILED)
        failed, seconds = None, 0.0
        if kernels:
            unfit = [test for (test, compiled), sound in self._sound.items() if not (sound or compiled)]
            with self.faulty(fault):
                asked = Asked(words, skipped + unfit)
                failed, seconds = self.judge(first, asked, AS_PYTHON, compiled=False)
            if failed == NO_END or (failed and not self.is_sound(failed, compiled=False)):
                failed = None
        if not failed:
            asked = Asked(words, skipped)
            with self.faulty(fault), self.cache_of_the_fault(kernels) as cache:
                enough = ENOUGH + COMPILING * kernels
                failed, more = self.judge(first, asked, enough, cache, learn=not kernels)
                if not failed and others and more < enough:
                    failed, yet = self.judge(others, asked, enough - more, cache, learn=not kernels)
                    more += yet
            seconds += more
            if failed and failed != NO_END and not self.is_sound(failed):
                raise SystemExit(f"{failed} fails on the code as it is")
        code = source.splitlines()[fault.line - 1].strip()
        row = {"fault": fault.name, "code": code, "commit": self.commit, "failed": failed, "seconds": seconds}
        with self.book.open("a") as book:
            book.write(json.dumps(row) + "\n")
        return row

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

    def is_sound(self, test: str, compiled: bool = True) -> bool:
        """Whether a test passes on the code as it is."""
        if (test, compiled) not in self._sound:
            failed, _ = self.judge([test], Asked([], []), ENOUGH + COMPILING, compiled=compiled)
            self._sound[test, compiled] = failed is None
        return self._sound[test, compiled]

    def judge(
        self,
        files: list[str],
        asked: Asked,
        most: float,
        cache: Path | None = None,
        compiled: bool = True,
        learn: bool = False,
    ) -> tuple[str | None, float]:
        """The test that noticed and the seconds spent; a run without an end, or a verdict, has noticed."""
        question, verdict, book = (self.folder / name for name in ("asked.json", "verdict.json", "took.json"))
        learnt = json.loads(book.read_text()) if book.exists() else {}
        took = {**self._reach.seconds, **learnt}
        about = {"files": files, **asked._asdict(), "seconds": most, "took": took}
        question.write_text(json.dumps(about))
        verdict.unlink(missing_ok=True)
        run = subprocess.Popen(
            [sys.executable, str(JUDGE), str(question), str(verdict)],
            cwd=self.tree,
            env=self.environment(cache or self.cache) | ({} if compiled else {"NUMBA_DISABLE_JIT": "1"}),
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
        if not verdict.exists():
            return NO_END, most
        found = json.loads(verdict.read_text())
        if learn:
            book.write_text(json.dumps({**learnt, **found["took"]}))
        return found["failed"], found["seconds"]


def drawn(tree: Path, size: int, seed: int, without: tuple[str, ...]) -> list[Fault]:
    """``size`` faults, as many of each package in turn, none of files whose names begin so."""
    queues = []
    for package in PACKAGES:
        found = [
            fault
            for path in sorted((tree / package).rglob("*.py"))
            if not (name := str(path.relative_to(tree))).startswith(without)
            for fault in faults(name, path.read_bytes())
        ]
        queues.append(sorted(found, key=lambda fault: fault.digest(seed)))
    return [fault for row in zip_longest(*queues) for fault in row if fault is not None][:size]


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("folder", type=Path)
    asked.add_argument("size", type=int)
    asked.add_argument("usual", nargs="*")
    asked.add_argument("--survivors", action="store_true")
    asked.add_argument("--seed", type=int, default=1, help="of the draw")
    asked.add_argument("--without", action="append", default=[], help="files whose names begin so; repeated")
    options = asked.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended; to be gone on with"))
    session = Session(options.folder, options.usual)
    tried, reasons = session.tried(), tomllib.loads(EQUIVALENT.read_text())["equivalent"]
    chosen = drawn(session.tree, options.size, options.seed, tuple(options.without))
    for number, fault in enumerate(chosen, 1):
        row = tried.get(fault.name)
        survived = row and row["failed"] is None and row["commit"] != session.commit
        again = options.survivors and survived and fault.name not in reasons
        if row is None or again:
            row = session.try_fault(fault)
            print(number, row["failed"] or "SURVIVED", row["seconds"], fault.name, sep="  ", flush=True)


if __name__ == "__main__":
    main()
