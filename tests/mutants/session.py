"""Faults put into the solvers one at a time, in a clone of the last commit, and the tests run against each.

The same faults are drawn from code that has not changed: each has a place by a digest of its name, and the
first of each package are taken. What was tried is kept line by line in FOLDER/tried.jsonl and not tried again
but for the survivors of an older commit, with ``--survivors``. A test that notices a fault is itself run once
on the code as it is: what fails there too proves nothing, and ends the session.

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
from contextlib import suppress
from itertools import zip_longest
from pathlib import Path
from typing import Any

from faults import Fault, faults
from nearest import Nearest, words_of
from reach import PACKAGES, Reach

JUDGE, RECORD = (Path(__file__).with_name(name).resolve() for name in ("judge.py", "record.py"))
KERNELS = "tests/kernels.py"
ENOUGH = 40.0  # seconds of processor time after which a fault has survived
COMPILING = 30.0  # seconds more where kernels are compiled anew
HUNG = 1800  # seconds on the clock
NO_END = "no end, or a crash"
FIRST, ALL = 6, 30  # files of tests that are read first, and at most
NEW = 3  # files that are read for the tests that came after the record
COMPILED = ("njit", "NamedTuple")  # of a file that sheetbench.kernels makes kernels' stamps of
ONE_THREAD = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")


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
        self._sound: dict[str, bool] = {}
        self._nearest, self._usual = Nearest(self.tree), usual
        self.run(KERNELS)  # or else they would be compiled for each fault, and thrown away with it
        whole, part = (self.folder / name for name in ("reach.jsonl", "reach-so-far.jsonl"))
        if not whole.exists():
            self.run(RECORD, str(part), "tests")
            part.rename(whole)
        self._reach = Reach(self.tree, whole)

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
        """One line of the book; the file is put back whatever happens."""
        path = self.tree / fault.module
        source, written = path.read_bytes(), path.stat().st_mtime
        words = words_of(fault.module, fault.function)
        nearest = self._nearest.tests(fault.module, words, self._usual)
        reaching = self._reach.tests(fault.module, fault.function)
        met = {name.partition("::")[0] for name in reaching}
        files = [name for name in nearest if name in met] or nearest
        # what came after the book is in files that are near
        files = list(dict.fromkeys([*files[:FIRST], *nearest[:NEW], *files[FIRST:ALL]]))
        skipped = [name for name in self._reach.seconds if name not in reaching] if reaching else []
        kernels = any(word in source.decode() for word in COMPILED)
        cache = self.cache
        try:
            path.write_bytes(fault.put_into(source))
            os.utime(path, (fault.digest, fault.digest))  # byte code goes by a file's time, to the second
            if kernels:  # this and its callers' are compiled anew
                cache = self.folder / "cache-of-the-fault"
                shutil.rmtree(cache, ignore_errors=True)
                shutil.copytree(self.cache, cache, copy_function=os.link)
            enough, first = ENOUGH + COMPILING * kernels, FIRST + NEW
            failed, seconds = self.judge(files[:first], words, cache, enough, skipped, learn=not kernels)
            if not failed and seconds < enough and files[first:]:
                left = enough - seconds
                failed, more = self.judge(files[first:], words, cache, left, skipped, learn=not kernels)
                seconds += more
        finally:
            path.write_bytes(source)
            os.utime(path, (written, written))
            if kernels:
                shutil.rmtree(cache, ignore_errors=True)
        if failed and failed != NO_END and not self.is_sound(failed):
            raise SystemExit(f"{failed} fails on the code as it is")
        code = source.decode().splitlines()[fault.line - 1].strip()
        row = {"fault": fault.name, "code": code, "commit": self.commit, "failed": failed, "seconds": seconds}
        with self.book.open("a") as book:
            book.write(json.dumps(row) + "\n")
        return row

    def is_sound(self, test: str) -> bool:
        """Whether a test passes on the code as it is."""
        if test not in self._sound:
            self._sound[test] = self.judge([test], [], self.cache, ENOUGH + COMPILING, [])[0] is None
        return self._sound[test]

    def judge(
        self,
        tests: list[str],
        words: list[str],
        cache: Path,
        most: float,
        skipped: list[str],
        learn: bool = False,
    ) -> tuple[str | None, float]:
        """The test that noticed and the seconds spent; a run without an end, or a verdict, has noticed."""
        asked, verdict, book = (self.folder / name for name in ("asked.json", "verdict.json", "took.json"))
        learnt = json.loads(book.read_text()) if book.exists() else {}
        took = {**self._reach.seconds, **learnt}
        asked.write_text(
            json.dumps({"files": tests, "words": words, "seconds": most, "took": took, "skipped": skipped})
        )
        verdict.unlink(missing_ok=True)
        run = subprocess.Popen(
            [sys.executable, str(JUDGE), str(asked), str(verdict)],
            cwd=self.tree,
            env=self.environment(cache),
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


def drawn(tree: Path, size: int) -> list[Fault]:
    """``size`` faults, as many of each package in turn."""
    queues = []
    for package in PACKAGES:
        found = [
            fault
            for path in sorted((tree / package).rglob("*.py"))
            for fault in faults(str(path.relative_to(tree)), path.read_bytes())
        ]
        queues.append(sorted(found, key=lambda fault: fault.digest))
    return [fault for row in zip_longest(*queues) for fault in row if fault is not None][:size]


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__)
    asked.add_argument("folder", type=Path)
    asked.add_argument("size", type=int)
    asked.add_argument("usual", nargs="*")
    asked.add_argument("--survivors", action="store_true")
    options = asked.parse_args()
    signal.signal(signal.SIGTERM, lambda *_: sys.exit("ended; to be gone on with"))
    session = Session(options.folder, options.usual)
    tried = session.tried()
    for number, fault in enumerate(drawn(session.tree, options.size), 1):
        row = tried.get(fault.name)
        again = options.survivors and row and row["failed"] is None and row["commit"] != session.commit
        if row is None or again:
            row = session.try_fault(fault)
            print(number, row["failed"] or "SURVIVED", row["seconds"], fault.name, sep="  ", flush=True)


if __name__ == "__main__":
    main()
