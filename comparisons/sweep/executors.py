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
import socket
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, Pipe, wait
from multiprocessing.resource_tracker import ensure_running
from typing import Any, Protocol, runtime_checkable
from urllib.parse import urlsplit

from sheetbench.errors import BadInput
from sheetbench.heap import keep_freed_memory
from sheetbench.process import ONE_THREAD

PATIENCE = 15.0  # s without anybody to carry out a run
ANSWER = 5.0  # s that a scheduler may take to answer
FAREWELL = 1.0  # s, where nobody waits for the answer
Pool = Callable[[int], Executor]


@runtime_checkable
class Watched(Protocol):
    """What an Executor may offer besides."""

    def watch(self) -> None:
        """Raise BadInput where nobody is left to carry anything out."""


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
        super().shutdown(cancel_futures=cancel_futures)


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
    before = {name: os.environ.get(name) for name in ONE_THREAD}
    os.environ.update(ONE_THREAD)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


@contextmanager
def pool_of(
    scheduler: str | None, patient: bool = False, say: Callable[[str], None] = lambda text: None
) -> Iterator[Pool]:
    """Processes of this machine, or the cluster of a scheduler's address (see `Cluster`)."""
    if scheduler is None:
        yield Processes
        return
    cluster = Cluster(scheduler, patient, say)
    try:
        yield cluster.connected
    finally:
        cluster.close()


class Cluster(Executor):
    """The dask cluster at an address like tcp://host:8786.

    A run whose worker dies is given to another by dask itself. Where there has been no worker, or no
    scheduler, for `PATIENCE` seconds, a campaign ends in BadInput, or if `patient` says so once and waits.
    Raises BadInput without dask.distributed or where nothing answers.
    """

    def __init__(
        self, address: str, patient: bool = False, say: Callable[[str], None] = lambda text: None
    ) -> None:
        try:
            import distributed
        except ImportError:
            raise BadInput("--scheduler: needs dask.distributed; pip install 'sheetbench[cluster]'") from None
        for name in ("distributed", "distributed.client"):  # its own warnings are repeated here
            logging.getLogger(name).setLevel(logging.CRITICAL)
        self.address, self._patient, self._say = address, patient, say
        self._connect: Callable[[], distributed.Client] = lambda: distributed.Client(address, timeout=10)
        try:
            place = urlsplit(address)
            if place.scheme == "tcp":  # dask would try for long, and noisily
                socket.create_connection((place.hostname or "", place.port or 8786), timeout=10).close()
            self._client = self._connect()
        except (OSError, ValueError) as error:
            raise BadInput(f"--scheduler = '{address}': no scheduler there: {error}") from None
        self._dask: Executor
        self._missing_since: float | None = None
        self._warned = False

    def connected(self, count: int) -> Executor:
        """Return the cluster, with however many workers, once it can be reached."""
        while self._client.status != "running":
            self.watch()
            if self._client.status == "closed":
                with suppress(OSError):
                    self._client = self._connect()
            time.sleep(0.2)
        self._dask = self._client.get_executor(pure=False)  # of this connection
        return self

    def submit(self, task: Callable[..., Any], /, *arguments: Any, **named: Any) -> Future[Any]:
        """Submit as any executor does."""
        return self._dask.submit(task, *arguments, **named)

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        """Wait for what is under way, or cancel it, without waiting for a scheduler that may not be there;
        the connection stays."""
        ending = threading.Thread(target=self._dask.shutdown, kwargs={"wait": wait}, daemon=True)
        ending.start()
        ending.join(None if wait else FAREWELL)

    def watch(self) -> None:
        """See who is there. Raises BadInput, or says that it waits, where nobody has been for long."""
        missing = self._what_is_missing()
        if missing is None:
            self._missing_since, self._warned = None, False
            return
        now = time.monotonic()
        if self._missing_since is None:
            self._missing_since = now
        if now - self._missing_since < PATIENCE or self._warned:
            return
        refusal = f"--scheduler = '{self.address}': no {missing} for {PATIENCE:g} s"
        if not self._patient:
            raise BadInput(
                f"{refusal}; finished runs are kept: the same command continues, with --wait it waits for one"
            )
        self._say(f"{refusal}; waiting")
        self._warned = True

    def close(self) -> None:
        """Leave the cluster, which keeps running."""
        with suppress(OSError):  # a time-out too: a scheduler that does not answer is not waited for
            self._client.close(timeout=FAREWELL)

    def _what_is_missing(self) -> str | None:
        scheduler: Any = self._client.scheduler
        if self._client.status != "running" or scheduler is None:
            return "scheduler"
        try:
            there = self._client.sync(scheduler.identity, callback_timeout=ANSWER)
        except OSError:
            return "answer of the scheduler"
        return None if there["workers"] else "worker"


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
