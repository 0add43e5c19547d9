"""Executors of runs: processes of this machine, or a dask cluster.

A worker process starts fresh (spawn), keeps to one thread (BLAS, OpenMP, numba and rslab alike), so that as
many workers as cores do not fight for them, and ends when the process that started it does, killed or not.

Use only a scheduler you trust: it can run arbitrary code on both machines.
"""

from __future__ import annotations

import logging
import multiprocessing
import os
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import ExitStack, contextmanager
from functools import cached_property
from multiprocessing.connection import Connection, Pipe, wait
from multiprocessing.resource_tracker import ensure_running
from typing import Any

from sheetbench.errors import BadInput
from sheetbench.heap import keep_freed_memory
from sheetbench.process import ONE_THREAD

PATIENCE = 10.0  # s that a scheduler may take to answer, and to have a worker
Pool = Callable[[int], Executor]  # by how many runs it is to take at a time


class Processes(ProcessPoolExecutor):
    """Single-threaded processes of this machine, which do not hear Ctrl-C: it is for who started them."""

    def __init__(self, workers: int) -> None:
        theirs, self._ours = Pipe(duplex=False)
        start = multiprocessing.get_context("spawn")
        super().__init__(workers, mp_context=start, initializer=_join, initargs=(theirs,))

    def submit(self, *arguments: Any, **keywords: Any) -> Future[Any]:
        """As usual; a process that this starts inherits that the interrupt is held back."""
        with _interrupt_held_back():
            return super().submit(*arguments, **keywords)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Wait for the processes; without `wait` end them, whatever they are at."""
        if not wait:
            self._ours.close()
        super().shutdown(cancel_futures=cancel_futures or not wait)


@contextmanager
def _interrupt_held_back() -> Iterator[None]:
    """A block in which Ctrl-C waits, in this thread and in the processes that it starts."""
    if not hasattr(signal, "pthread_sigmask"):  # not on Windows
        yield
        return
    ensure_running()  # of multiprocessing's own process, whose start would let the interrupt through
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def single_threaded() -> Iterator[None]:
    """The environment that worker processes are to start with."""
    before = {name: os.environ[name] for name in ONE_THREAD if name in os.environ}
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        for name in ONE_THREAD:
            del os.environ[name]
        os.environ.update(before)


class ClusterLost(Exception):
    """A cluster without the workers that runs are to go to."""


class Cluster:
    """The workers of a dask cluster as a pool; with an address that worker alone."""

    def __init__(self, client: Any, worker: str | None = None) -> None:
        self._client, self._worker = client, worker

    def __call__(self, workers: int) -> Executor:
        """Return its executor."""
        chosen = {"workers": [self._worker]} if self._worker else {}
        return self._client.get_executor(pure=False, **chosen)  # type: ignore[no-any-return]

    @cached_property
    def one_worker(self) -> Cluster:
        """Return one worker, always the same, for timed runs."""
        return Cluster(self._client, min(self._threads()))

    def width(self) -> int:
        """Return how many runs go side by side now: its threads, one of a single worker. Raises ClusterLost
        where no worker, or not that one, is there within `PATIENCE`."""
        threads = self._threads()
        if self._worker is None:
            return sum(threads.values())
        if self._worker not in threads:
            raise ClusterLost(f"the worker of the timed runs, {self._worker}, is gone")
        return 1

    def _threads(self) -> dict[str, int]:
        try:
            self._client.wait_for_workers(1, timeout=PATIENCE)
            return dict(self._client.nthreads())
        except TimeoutError:
            raise ClusterLost("the cluster has no worker left") from None
        except (OSError, ValueError):
            raise ClusterLost("the connection to the cluster was lost") from None


def width(pool: Pool, workers: int | None) -> int:
    """Return how many runs go side by side now: `workers` at most, without it as many as this machine has
    processors or the cluster threads. Raises ClusterLost."""
    if isinstance(pool, Cluster):
        return min(pool.width(), workers or sys.maxsize)
    return workers or os.cpu_count() or 1


@contextmanager
def pool_of(scheduler: str | None) -> Iterator[Pool]:
    """Processes of this machine, or the dask cluster at an address like tcp://host:8786, which gives an
    untimed run whose worker dies to another. Raises BadInput without dask.distributed, and where no scheduler
    answers or has a worker within `PATIENCE`."""
    if scheduler is None:
        yield Processes
        return
    try:
        from distributed import Client
    except ImportError:
        raise BadInput("--scheduler: needs dask.distributed; pip install 'sheetbench[cluster]'") from None
    for name in ("distributed", "distributed.client"):  # its own warnings are repeated here
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with ExitStack() as stack:
        try:
            client = stack.enter_context(Client(scheduler, timeout=PATIENCE))
            client.wait_for_workers(1, timeout=PATIENCE)
        except (OSError, ValueError) as error:
            raise BadInput(
                f"--scheduler = '{scheduler}': no scheduler there with a worker: {error}"
            ) from None
        yield Cluster(client)


def _join(stopped: Connection) -> None:
    """End this worker as soon as its parent has ended or closed the other end of `stopped`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    keep_freed_memory()
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=([parent.sentinel, stopped],), daemon=True).start()


def _follow(ends: list[Any]) -> None:
    wait(ends)
    os._exit(1)
