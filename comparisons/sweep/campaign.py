"""Campaigns: many runs, each carried out once, stored on completion, resumable after any interruption.

A run is a task's name and JSON arguments. Its result is stored in the folder's `campaign.sqlite` under a hash
of name, arguments, version and source; a repeated run with unchanged code is read from the store. Finished
runs are never changed. A run that raises an error or crashes its process is a row with its status.

Timed runs never share cores with other runs of the campaign: they run one at a time, on one worker of a
cluster, after the untimed runs, which run in parallel on all workers.
"""

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

GOING = "running"
CHECK_INTERVAL = 5.0  # s between checks of a pool, whose workers may come and go


@dataclass(frozen=True)
class Run:
    """A call of the function `task`, "module:function", with `arguments`. Arguments and the returned
    dictionary are plain JSON data; "status" and "message" of the dictionary become the run's. label: text for
    progress."""

    task: str
    arguments: dict[str, Any]
    label: str = ""
    timed: bool = False

    @property
    def key(self) -> str:
        """The hash that identifies the run in the store."""
        inputs = {
            "task": self.task,
            "arguments": plain(self.arguments),
            "version": version(),
            "source": source(),
        }
        return hashlib.sha256(json.dumps(inputs, sort_keys=True, allow_nan=False).encode()).hexdigest()


@dataclass(frozen=True)
class Progress:
    """Progress of a campaign: finished runs (stored ones included) of all, the latest run, remaining time.

    status: of the run that has just ended, or `GOING` if it has just started; seconds_left: mean duration of
    this session's runs times the remaining runs over the parallel ones, unknown before the first has
    finished; going: labels of the current runs.
    """

    done: int
    total: int
    label: str
    status: str
    seconds_left: float | None
    going: tuple[str, ...] = ()

    @property
    def at_once(self) -> bool:
        """Whether progress is printed without a terminal too: for every finished run."""
        return self.status != GOING

    def __str__(self) -> str:
        more = f", and {len(self.going) - 1} more" if len(self.going) > 1 else ""
        parts = [f"{self.label}: {self.status}"] if self.at_once else []
        parts += [f"running: {self.going[0]}{more}"] if self.going else []
        parts += [] if self.seconds_left is None else [f"{duration(self.seconds_left)} left"]
        return f"{self.done}/{self.total} done; {'; '.join(parts)}"


@contextmanager
def campaign(folder: Path | str | None) -> Iterator[Store]:
    """Open the store of a folder's campaigns, without a folder a temporary one. Raises BadInput for an
    unusable store (`Store`), and if another process has it open."""
    with TemporaryDirectory() as temporary:
        path = Path(temporary if folder is None else folder)
        path.mkdir(parents=True, exist_ok=True)
        with only_writer(path), closing(Store(path / FILE)) as store:
            store.passing = folder is None
            yield store


class CampaignKeywords(TypedDict, total=False):
    """Keywords of functions that carry out many runs. workers: largest number of parallel untimed runs
    (`executors.width`); pool: makes their processes, or is a cluster; retry: repeat failed and lost runs;
    progress: called at the start and end of every run."""

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
    """Return every run's outcome, in the order of `runs`; stored runs are skipped. Keywords are explained in
    `CampaignKeywords`. Raises BadInput if a cluster is lost."""
    queue = list(runs)
    for run in queue if retry else ():
        store.forget(run.key)
    missing = {run.key: run for run in queue if store.get(run.key) is None}
    session = _Session(store, len({run.key for run in queue}), len(missing), progress)
    for timed in (False, True):
        waiting = deque(run for run in missing.values() if run.timed is timed)
        if waiting:
            with single_threaded():
                workers_of = pool.one_worker if timed and isinstance(pool, Cluster) else pool
                session.carry_out(waiting, workers_of, 1 if timed else workers)
    stored = [store.get(run.key) for run in queue]
    return [outcome for outcome in stored if outcome is not None]


class _Session:
    """The missing runs of one call of `carry_out`."""

    def __init__(self, store: Store, total: int, missing: int, progress: Callable[[Progress], None]) -> None:
        self.store, self.total, self.missing, self.progress = store, total, missing, progress
        self.seconds: list[float] = []
        self.width = 1  # parallel runs
        self.going: dict[str, str] = {}  # labels of the current runs, by key

    def carry_out(self, waiting: deque[Run], pool: Pool, workers: int | None) -> None:
        """Carry out all waiting runs, `workers` at a time. The runs that were current when a process crashed
        are repeated one at a time: a run that crashes its process alone is stored as lost. Raises BadInput if
        the cluster is lost."""
        try:
            suspects = self._stream(waiting, pool, workers)
            while waiting or suspects:
                for run in suspects:
                    if self._stream(deque([run]), pool, 1):
                        self._keep(run, _lost_run(run))
                suspects = self._stream(waiting, pool, workers)
        except ClusterLost as error:
            done = f"{self.total - self.missing + len(self.seconds)} of {self.total} runs are"
            stored = f"{done} done; with --out DIR they are" if self.store.passing else done
            raise BadInput(f"{error}; {stored} kept: run the same command again to resume") from None

    def _stream(self, waiting: deque[Run], pool: Pool, workers: int | None) -> list[Run]:
        """Carry out waiting runs until none is left; if the pool breaks, return its current runs."""
        current: dict[Future[Finished], Run] = {}
        self.going.clear()
        self.width = width(pool, workers)
        with _shut_down(pool(self.width)) as executor:
            while waiting or current:
                self.width = width(pool, workers)
                while waiting and len(current) < self.width:
                    run = waiting.popleft()
                    current[_submit(executor, run)] = run
                    self.going[run.key] = run.label
                    self._report(run, GOING)
                done, _ = wait(current, CHECK_INTERVAL, FIRST_COMPLETED)
                broken = []
                for future in done:
                    run = current.pop(future)
                    error = None if future.cancelled() else future.exception()
                    if future.cancelled() or isinstance(error, CancelledError):
                        raise ClusterLost("the connection to the cluster was lost")
                    if isinstance(error, BrokenProcessPool):
                        broken.append(run)
                    else:
                        self._keep(run, _lost_run(run, error) if error else future.result())
                if broken:
                    return [*broken, *current.values()]
        return []

    def _keep(self, run: Run, outcome: Finished) -> None:
        self.store.add(run.task, run.arguments, outcome)
        self.seconds.append(outcome.seconds)
        self.going.pop(run.key, None)
        self._report(run, outcome.status)

    def _report(self, run: Run, status: str) -> None:
        left = self.missing - len(self.seconds)
        seconds = sum(self.seconds) / len(self.seconds) * left / self.width if self.seconds else None
        going = tuple(self.going.values())
        self.progress(Progress(self.total - left, self.total, run.label, status, seconds, going))


@contextmanager
def _shut_down(executor: Executor) -> Iterator[Executor]:
    """Wait for the executor at the end of the block, except after an error or Ctrl-C."""
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
    """Return the function of a task."""
    module, _, name = task.partition(":")
    out: Callable[..., dict[str, Any]] = getattr(import_module(module), name)
    return out


def execute(key: str, task: str, arguments: dict[str, Any]) -> Finished:
    """Carry out one run in this process; an exception becomes its outcome."""
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
    except Exception as error:  # a fault becomes a row; the campaign goes on
        if interrupts.is_behind(error):
            raise KeyboardInterrupt from error
        row = {"traceback": traceback.format_exc()}
        status, message = "failed", f"{type(error).__name__}: {error}"
        if isinstance(error, MemoryError):
            row, status, message = {}, "lost", f"not enough memory: {error}"
    return Finished(key, status, plain(row), message, started, _now(), perf_counter() - clock)


def _lost_run(run: Run, error: BaseException | None = None) -> Finished:
    reason = "" if error is None else f": {error}"
    return Finished(run.key, "lost", {}, f"its worker process crashed{reason}", _now(), _now(), 0.0)


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")
