"""Room for one question: a newer one takes the place of the one that waits, which nobody answers."""

from __future__ import annotations

import asyncio
from typing import Generic, TypeVar

T = TypeVar("T")


class Newest(Generic[T]):
    """What is put last is what is got next."""

    def __init__(self) -> None:
        self._waiting: T | None = None
        self._there = asyncio.Event()

    def put(self, value: T) -> None:
        """Leave a value, in place of one that was not got yet."""
        self._waiting = value
        self._there.set()

    async def comes_within(self, seconds: float) -> bool:
        """Return whether there is a value to be got by then."""
        try:
            await asyncio.wait_for(self._there.wait(), seconds)
        except TimeoutError:
            return False
        return True

    async def get(self) -> T:
        """Return the newest value, as soon as there is one; it is gone then."""
        await self._there.wait()
        self._there.clear()
        found, self._waiting = self._waiting, None
        assert found is not None
        return found
