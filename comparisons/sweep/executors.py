"""Executors of runs: processes of this machine, or a dask cluster.

A worker process starts fresh (spawn), uses one thread (BLAS, OpenMP, numba and rslab), so that workers do not
compete for cores, and ends with its parent process, even if that is killed.

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

TIME_LIMIT = 10.0  # s, waiting time for a scheduler's answer and for its first worker
Pool = Callable[[int], Executor]  # makes an executor of a number of parallel runs


class Processes(ProcessPoolExecutor):
    """Single-threaded workers of this machine that ignore Ctrl-C; the parent process handles it."""

    def __init__(self, workers: int) -> None:
        child_end, self._parent_end = Pipe(duplex=False)
        start = multiprocessing.get_context("spawn")
        super().__init__(workers, mp_context=start, initializer=_join, initargs=(child_end,))

    def submit(self, *arguments: Any, **keywords: Any) -> Future[Any]:
        """Submit a call; a process started for it inherits the blocked interrupt."""
        with _interrupt_blocked():
            return super().submit(*arguments, **keywords)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Wait for the processes; without `wait` end them at once."""
        if not wait:
            self._parent_end.close()
        super().shutdown(cancel_futures=cancel_futures or not wait)


@contextmanager
def _interrupt_blocked() -> Iterator[None]:
    """Block Ctrl-C for a block in this thread, and in processes that the block starts."""
    if not hasattr(signal, "pthread_sigmask"):  # not on Windows
        yield
        return
    ensure_running()  # multiprocessing's resource tracker: its start would unblock the interrupt
    previous = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, previous)


@contextmanager
def single_threaded() -> Iterator[None]:
    """Set the environment of worker processes to one thread for a block."""
    previous = {name: os.environ[name] for name in ONE_THREAD if name in os.environ}
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        for name in ONE_THREAD:
            del os.environ[name]
        os.environ.update(previous)


class ClusterLost(Exception):
    """A cluster without a worker for the remaining runs."""


class Cluster:
    """The workers of a dask cluster as a pool, or the one worker of an address."""

    def __init__(self, client: Any, worker: str | None = None) -> None:
        self._client, self._worker = client, worker

    def __call__(self, workers: int) -> Executor:
        """Return the cluster's executor."""
        selection = {"workers": [self._worker]} if self._worker else {}
        return self._client.get_executor(pure=False, **selection)  # type: ignore[no-any-return]

    @cached_property
    def one_worker(self) -> Cluster:
        """The worker for all timed runs."""
        return Cluster(self._client, min(self._threads()))

    def width(self) -> int:
        """Return the present number of parallel runs: the cluster's threads, 1 for one worker. Raises
        ClusterLost if no worker, or not this one, appears within `TIME_LIMIT`."""
        threads = self._threads()
        if self._worker is None:
            return sum(threads.values())
        if self._worker not in threads:
            raise ClusterLost(f"the worker of the timed runs, {self._worker}, is gone")
        return 1

    def _threads(self) -> dict[str, int]:
        try:
            self._client.wait_for_workers(1, timeout=TIME_LIMIT)
            return dict(self._client.nthreads())
        except TimeoutError:
            raise ClusterLost("the cluster has no worker left") from None
        except (OSError, ValueError):
            raise ClusterLost("the connection to the cluster was lost") from None


def width(pool: Pool, workers: int | None) -> int:
    """Return the present number of parallel runs: at most `workers`, by default the machine's processors or
    the cluster's threads. Raises ClusterLost."""
    if isinstance(pool, Cluster):
        return min(pool.width(), workers or sys.maxsize)
    return workers or os.cpu_count() or 1


@contextmanager
def pool_of(scheduler: str | None) -> Iterator[Pool]:
    """Return processes of this machine, or the dask cluster at an address like tcp://host:8786.

    A cluster repeats an untimed run of a crashed worker on another one. Raises BadInput without
    dask.distributed, and if no scheduler with a worker answers within `TIME_LIMIT`.
    """
    if scheduler is None:
        yield Processes
        return
    try:
        from distributed import Client
    except ImportError:
        raise BadInput("--scheduler: needs dask.distributed; pip install 'sheetbench[cluster]'") from None
    # their warnings would repeat our messages
    for name in ("distributed", "distributed.client", "tornado.application"):
        logging.getLogger(name).setLevel(logging.CRITICAL)
    with ExitStack() as stack:
        try:
            client = stack.enter_context(Client(scheduler, timeout=TIME_LIMIT))
            client.wait_for_workers(1, timeout=TIME_LIMIT)
        except (OSError, ValueError) as error:
            raise BadInput(
                f"--scheduler = '{scheduler}': no scheduler there with a worker: {error}"
            ) from None
        yield Cluster(client)


def _join(stopped: Connection) -> None:
    """End this worker process once its parent has ended or closed the other end of the pipe `stopped`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    keep_freed_memory()
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=([parent.sentinel, stopped],), daemon=True).start()


def _follow(ends: list[Any]) -> None:
    wait(ends)
    os._exit(1)
