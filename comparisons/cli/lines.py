"""Progress where standard error is no terminal: a line now and then, none for short work."""

from __future__ import annotations

import threading
from collections.abc import Callable
from time import monotonic
from types import TracebackType
from typing import Self

QUIET = 2.0  # s, at first
BETWEEN = 10.0  # s, from line to line
POLL = 0.25  # s


class Lines:
    """What is being done is printed once it has gone on for a while; what is expected to take long, at once.

    A thread looks at the clock, for what takes long says nothing meanwhile.
    """

    def __init__(self, write: Callable[[str], None], clock: Callable[[], float] = monotonic) -> None:
        self._write, self._clock = write, clock
        self._now, self._printed = "", ""
        self._due = clock() + QUIET
        self._lock, self._over = threading.Lock(), threading.Event()
        self._looking = threading.Thread(target=self._look_on, daemon=True)

    def __enter__(self) -> Self:
        self._looking.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._over.set()
        self._looking.join()

    def say(self, what: object) -> None:
        """Set what is being done from now on; what says that it is to be printed at once is."""
        with self._lock:
            self._now = str(what)
            if getattr(what, "at_once", False):
                self._print(self._now)

    def look(self) -> None:
        """Print what is being done, if it is time and it has not been printed."""
        with self._lock:
            if self._clock() >= self._due and self._now not in ("", self._printed):
                self._print(self._now)

    def _print(self, text: str) -> None:
        self._write(text)
        self._printed, self._due = text, self._clock() + BETWEEN

    def _look_on(self) -> None:
        while not self._over.wait(POLL):
            self.look()
