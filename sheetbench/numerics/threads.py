"""One BLAS thread while a lattice is solved.

The dense blocks here are small: a second BLAS thread gains nothing, and on a busy machine its spinning made
single solves of a 9×9×2 lattice take up to two seconds instead of a few milliseconds.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from threadpoolctl import ThreadpoolController


@cache
def _libraries() -> list[Any]:
    """Return the BLAS libraries of this process. `ThreadpoolController.limit` queries all their properties,
    which takes longer than factoring a small lattice's tangent."""
    return list(ThreadpoolController().select(user_api="blas").lib_controllers)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Limit BLAS to one thread within the block."""
    before = [(library, library.get_num_threads()) for library in _libraries()]
    several = [(library, threads) for library, threads in before if threads != 1]
    for library, _ in several:
        library.set_num_threads(1)
    try:
        yield
    finally:
        for library, threads in several:
            library.set_num_threads(threads)
