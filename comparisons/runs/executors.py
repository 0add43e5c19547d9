"""Where runs are carried out: processes of this machine, or a dask cluster. Both are standard Executors.

A worker process starts fresh (spawn), keeps to one thread (BLAS, OpenMP, numba and rslab alike), so that as
many workers as cores do not fight for them, and ends when the process that started it does, killed or not.
"""

from __future__ import annotations

import multiprocessing
import os
import socket
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing.connection import wait
from urllib.parse import urlsplit

from sheetbench.scenes.errors import BadInput

ONE_THREAD = dict.fromkeys(
    (
        "OMP_NUM_THREADS",
        "OPENBLAS_NUM_THREADS",
        "MKL_NUM_THREADS",
        "NUMBA_NUM_THREADS",
        "RAYON_NUM_THREADS",
    ),
    "1",
)
Pool = Callable[[int], Executor]


def processes(workers: int) -> Executor:
    """A pool of that many single-threaded processes."""
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"), initializer=_join)


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
def pool_of(scheduler: str | None) -> Iterator[Pool]:
    """Processes of this machine, or the cluster of a scheduler's address."""
    if scheduler is None:
        yield processes
        return
    with cluster(scheduler) as pool:
        yield pool


@contextmanager
def cluster(address: str) -> Iterator[Pool]:
    """The dask cluster at an address like tcp://host:8786, for as long as the context lasts.

    A run whose worker dies is given to another by dask itself. Raises BadInput without dask.distributed or
    where nothing answers.
    """
    try:
        from distributed import Client
    except ImportError:
        raise BadInput("--scheduler: needs dask.distributed; pip install 'sheetbench[cluster]'") from None
    try:
        place = urlsplit(address)
        if place.scheme == "tcp":  # dask would try for long, and noisily
            socket.create_connection((place.hostname or "", place.port or 8786), timeout=10).close()
        client = Client(address, timeout=10)
    except (OSError, ValueError) as error:
        raise BadInput(f"--scheduler = '{address}': no scheduler there: {error}") from None

    def connected(workers: int) -> Executor:
        executor: Executor = client.get_executor(pure=False)
        return executor

    with client:
        yield connected


def _join() -> None:
    """End this worker as soon as its parent has ended."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=(parent.sentinel,), daemon=True).start()


def _follow(sentinel: int) -> None:
    wait([sentinel])
    os._exit(1)
