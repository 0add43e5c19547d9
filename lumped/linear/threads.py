"""One BLAS thread while a lattice is solved.

The dense blocks here are small: a second BLAS thread gains nothing, and on a busy machine its spinning made
single solves of a 9×9×2 lattice take up to two seconds instead of a few milliseconds.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

from threadpoolctl import ThreadpoolController


@cache
def _controller() -> ThreadpoolController:
    return ThreadpoolController()


def one_blas_thread() -> AbstractContextManager:
    """A context in which BLAS works on one thread."""
    return _controller().limit(limits=1, user_api="blas")
