"""Campaigns: many runs, each carried out once, kept as soon as it is done, resumed after any interruption.

A run is a task's name and JSON arguments. What it finds is kept in the folder's `campaign.sqlite` under a
hash of name, arguments, version and source; repeated by the same code, it is read and not run. Nothing of
a finished run is ever changed. A run that raises is a row with its status, and so is one that takes its
process down.

Timed runs never share cores with each other or with other runs of the campaign: they go one at a time, on one
worker of a cluster, after the untimed ones, which go as many at a time as there are workers.
"""

from __future__ import annotations

import hashlib
import json
import traceback
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import FIRST_COMPLETED, CancelledError, Executor, Future, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import closing, contextmanager
from dataclasses import dataclass
from datetime import UTC, datetime
from importlib import import_module
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, TypedDict

from comparisons.pictures.work import duration
from comparisons.sweep import interrupts
from comparisons.sweep.executors import Cluster, ClusterLost, Pool, Processes, single_threaded, width
from comparisons.sweep.store import FILE, Finished, Store
from sheetbench.answers.files import plain
from sheetbench.errors import BadInput
from sheetbench.files import only_writer
from sheetbench.sources import source, version

GOING = "going on"
WATCHED = 5.0  # s between looks at a pool, whose workers may come and go


@dataclass(frozen=True)
class Run:
    """The function that `task` names, as "module:function", called with `arguments`.

    The arguments are plain JSON data, and so is the dictionary that the function returns; its "status" and
    "message", if any, become those of the run. label: what people read while it runs.
    """

    task: str
    arguments: dict[str, Any]
    label: str = ""
    timed: bool = False

    @property
    def key(self) -> str:
        """The hash under which the run is kept."""
        inputs = {
            "task": self.task,
            "arguments": plain(self.arguments),
            "version": version(),
            "source": source(),
        }
        return hashlib.sha256(json.dumps(inputs, sort_keys=True, allow_nan=False).encode()).hexdigest()


@dataclass(frozen=True)
class Progress:
    """How far a campaign is: runs done (kept from before included) of all, the last one, seconds left.

    status: of the run that has just ended, or `GOING` where it has just begun. seconds_left: the mean
    duration of the runs of this session times the runs left, over those that run side by side; None before
    the first has finished. going: the runs that are under way.
    """

    done: int
    total: int
    label: str
    status: str
    seconds_left: float | None
    going: tuple[str, ...] = ()

    @property
    def at_once(self) -> bool:
        """Whether it is told where there is no terminal: of every run that has ended."""
        return self.status != GOING

    def __str__(self) -> str:
        more = f", and {len(self.going) - 1} more" if len(self.going) > 1 else ""
        parts = [f"{self.label}: {self.status}"] if self.at_once else []
        parts += [f"going on: {self.going[0]}{more}"] if self.going else []
        parts += [] if self.seconds_left is None else [f"{duration(self.seconds_left)} left"]
        return f"{self.done}/{self.total} {', '.join(parts)}"


@contextmanager
def campaign(folder: Path | str | None) -> Iterator[Store]:
    """The store of a folder's campaigns, open; without a folder one that passes. Raises BadInput where it
    cannot be, see `Store`, and where another process has it open."""
    with TemporaryDirectory() as passing:
        path = Path(passing if folder is None else folder)
        path.mkdir(parents=True, exist_ok=True)
        with only_writer(path), closing(Store(path / FILE)) as store:
            store.passing = folder is None
            yield store


class CampaignKeywords(TypedDict, total=False):
    """How runs are carried out, as every function that carries out many takes it.

    workers: of untimed runs side by side, at most (`executors.width`); pool: makes their processes, or a
    cluster's; retry: run again what failed or was lost before; progress: called as every run begins and ends.
    """

    workers: int | None
    pool: Pool
    retry: bool
    progress: Callable[[Progress], None]


def carry_out(
    runs: Iterable[Run],
    store: Store,
    *,
    workers: int | None = 1,
    pool: Pool = Processes,
    retry: bool = False,
    progress: Callable[[Progress], None] = lambda progress: None,
) -> list[Finished]:
    """Return every run's outcome, in the order of `runs`; those that the store has are not run again (see
    `CampaignKeywords`). Raises BadInput where a cluster is lost."""
    queue = list(runs)
    for run in queue if retry else ():
        store.forget(run.key)
    missing = {run.key: run for run in queue if store.get(run.key) is None}
    session = _Session(store, len({run.key for run in queue}), len(missing), progress)
    for timed in (False, True):
        waiting = deque(run for run in missing.values() if run.timed is timed)
        if waiting:
            with single_threaded():
                one = pool.one_worker if timed and isinstance(pool, Cluster) else pool
                session.carry_out(waiting, one, 1 if timed else workers)
    stored = [store.get(run.key) for run in queue]
    return [outcome for outcome in stored if outcome is not None]


class _Session:
    """The runs of one call that are still to be done."""

    def __init__(self, store: Store, total: int, missing: int, progress: Callable[[Progress], None]) -> None:
        self.store, self.total, self.missing, self.progress = store, total, missing, progress
        self.seconds: list[float] = []
        self.width = 1  # runs side by side
        self.going: dict[str, str] = {}  # labels of the runs under way, by their keys

    def carry_out(self, waiting: deque[Run], pool: Pool, workers: int | None) -> None:
        """All waiting runs, `workers` at a time. Those under way when a process died go again, one at a time:
        the one that dies alone is the one to blame. Raises BadInput where the cluster is lost."""
        try:
            suspects = self._stream(waiting, pool, workers)
            while waiting or suspects:
                for run in suspects:
                    if self._stream(deque([run]), pool, 1):
                        self._keep(run, _lost(run))
                suspects = self._stream(waiting, pool, workers)
        except ClusterLost as lost:
            done = f"{self.total - self.missing + len(self.seconds)} of {self.total} runs are"
            kept = f"{done} done; with --out DIR they are" if self.store.passing else done
            raise BadInput(f"{lost}; {kept} kept, and the same command goes on") from None

    def _stream(self, waiting: deque[Run], pool: Pool, workers: int | None) -> list[Run]:
        """Runs until none waits or the pool is gone; the runs under way if the pool broke."""
        under_way: dict[Future[Finished], Run] = {}
        self.going.clear()
        self.width = width(pool, workers)
        with _ended(pool(self.width)) as executor:
            while waiting or under_way:
                self.width = width(pool, workers)
                while waiting and len(under_way) < self.width:
                    run = waiting.popleft()
                    under_way[_submit(executor, run)] = run
                    self.going[run.key] = run.label
                    self._tell(run, GOING)
                done, _ = wait(under_way, WATCHED, FIRST_COMPLETED)
                broken = []
                for future in done:
                    run = under_way.pop(future)
                    error = None if future.cancelled() else future.exception()
                    if future.cancelled() or isinstance(error, CancelledError):
                        raise ClusterLost("the connection to the cluster was lost")
                    if isinstance(error, BrokenProcessPool):
                        broken.append(run)
                    else:
                        self._keep(run, _lost(run, error) if error else future.result())
                if broken:
                    return [*broken, *under_way.values()]
        return []

    def _keep(self, run: Run, outcome: Finished) -> None:
        self.store.add(run.task, run.arguments, outcome)
        self.seconds.append(outcome.seconds)
        self.going.pop(run.key, None)
        self._tell(run, outcome.status)

    def _tell(self, run: Run, status: str) -> None:
        left = self.missing - len(self.seconds)
        seconds = sum(self.seconds) / len(self.seconds) * left / self.width if self.seconds else None
        going = tuple(self.going.values())
        self.progress(Progress(self.total - left, self.total, run.label, status, seconds, going))


@contextmanager
def _ended(executor: Executor) -> Iterator[Executor]:
    """The executor, which is waited for at the end, but not after a fault or Ctrl-C."""
    try:
        yield executor
    except BaseException:
        executor.shutdown(wait=False)
        raise
    executor.shutdown()


def _submit(executor: Executor, run: Run) -> Future[Finished]:
    try:
        return executor.submit(execute, run.key, run.task, run.arguments)
    except BrokenProcessPool as error:
        future: Future[Finished] = Future()
        future.set_exception(error)
        return future


def function(task: str) -> Callable[..., dict[str, Any]]:
    """Return what a task is carried out by."""
    module, _, name = task.partition(":")
    carried_out: Callable[..., dict[str, Any]] = getattr(import_module(module), name)
    return carried_out


def execute(key: str, task: str, arguments: dict[str, Any]) -> Finished:
    """Carry out one run here and now; whatever it raises is its outcome."""
    started, clock = _now(), perf_counter()
    try:
        if Run(task, arguments).key != key:
            raise RuntimeError(
                "the code changed since this run was queued, or the worker has another version of it"
            )
        row = function(task)(**arguments)
        status, message = str(row.get("status", "done")), str(row.get("message", ""))
    except BadInput as error:
        row, status, message = {}, "refused", str(error)
    except Exception as error:  # a fault is a row of the study, not the end of it
        if interrupts.is_behind(error):
            raise KeyboardInterrupt from error
        row = {"traceback": traceback.format_exc()}
        status, message = "failed", f"{type(error).__name__}: {error}"
        if isinstance(error, MemoryError):
            row, status, message = {}, "lost", f"not enough memory: {error}"
    return Finished(key, status, plain(row), message, started, _now(), perf_counter() - clock)


def _lost(run: Run, error: BaseException | None = None) -> Finished:
    reason = "" if error is None else f": {error}"
    return Finished(run.key, "lost", {}, f"the process that ran it died{reason}", _now(), _now(), 0.0)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
