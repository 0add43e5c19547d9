"""Ctrl-C: a command ends within two seconds, with status 130 and a line that says what it leaves behind.

Python heeds an interrupt between two of its own instructions, and a factorisation may last longer than that.
So a thread that the signal wakes ends the process where it has not ended by then. Worker processes do not
hear the interrupt: the process that started them ends them (`comparisons.sweep.executors`).
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

STATUS = 130  # 128 + SIGINT, as shells have it
PATIENCE = 1.2  # s, from the signal to the end of a process that does not heed it

NOTHING = "nothing was kept"
_left_behind, _folder = NOTHING, ""


def promise(verb: str, out: object, resumed: bool) -> None:
    """Note what an interrupt of this verb leaves behind, given its --out; resumed: whether it keeps its runs
    there."""
    global _left_behind, _folder
    _folder = ""
    if verb == "live":
        _left_behind = "the server has stopped; an open page keeps its last answers"
    elif out is None:
        _left_behind = NOTHING
    elif resumed:
        _left_behind = "the same command goes on"
    else:
        _left_behind, _folder = f"files written so far are in {out}", str(out)


def say() -> None:
    """Print what an interrupt leaves behind, on standard error."""
    empty = _folder and not any(Path(_folder).glob("[!.]*"))
    print(f"interrupted; {NOTHING if empty else _left_behind}", file=sys.stderr, flush=True)


@contextmanager
def heeded(last: bool = False) -> Iterator[None]:
    """Let Ctrl-C end a block in time, whatever it does; only the main thread can arrange that.

    last: the process ends with the block, and its status is known: a signal after it counts for nothing.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _once)
    heard, wake = os.pipe()
    os.set_blocking(wake, False)
    before = signal.set_wakeup_fd(wake, warn_on_full_buffer=False)
    over = threading.Event()
    threading.Thread(target=_end_in_time, args=(heard, over), daemon=True).start()
    try:
        yield
    finally:
        over.set()
        signal.set_wakeup_fd(before)
        os.close(wake)
        if signal.getsignal(signal.SIGINT) is _once:  # else there was one, and the process ends
            signal.signal(signal.SIGINT, signal.SIG_IGN if last else signal.default_int_handler)


def _once(number: int, frame: object) -> None:
    """Raise KeyboardInterrupt once, and ignore further signals, which would interrupt the clearing up."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    raise KeyboardInterrupt


def _end_in_time(heard: int, over: threading.Event) -> None:
    """End the process if the block is not over some time after an interrupt."""
    while woken_by := os.read(heard, 1):  # nothing once the other end is closed
        if woken_by[0] == signal.SIGINT and not over.wait(PATIENCE):
            if sys.stderr.isatty():
                sys.stderr.write("\r\x1b[K\x1b[?25h")  # the spinner's line, and the cursor it has hidden
            say()
            os._exit(STATUS)
    os.close(heard)
