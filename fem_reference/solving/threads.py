"""One BLAS thread while a reference is solved.

The dense blocks of an element are small: more threads gain nothing there, and wait for each other wherever
another process has a core.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache

from threadpoolctl import ThreadpoolController


@cache
def _libraries() -> ThreadpoolController:
    return ThreadpoolController()


def one_blas_thread() -> AbstractContextManager:
    """A context in which BLAS works on one thread."""
    return _libraries().limit(limits=1, user_api="blas")
