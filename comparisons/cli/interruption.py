"""Handling of Ctrl-C: a command ends within two seconds, with status 130 and a line on the files it leaves.

Python handles an interrupt between its own instructions, and a factorisation may delay this for long.
Therefore the signal wakes a thread, which ends the process if necessary. Worker processes ignore the
interrupt; their parent process ends them (`comparisons.sweep.executors`).
"""

from __future__ import annotations

import os
import signal
import sys
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

STATUS = 130  # 128 + SIGINT, as in shells
TIME_LIMIT = 1.2  # s from the signal to the forced end of the process

NOTHING = "nothing was kept"
_left_behind, _folder = NOTHING, ""


def set_interrupt_notice(verb: str, out: object, resumed: bool) -> None:
    """Set the line for an interrupt of a verb; resumed: whether the verb can resume from its --out."""
    global _left_behind, _folder
    _folder = ""
    if verb == "live":
        _left_behind = "the server has stopped; an open page keeps its last answers"
    elif out is None:
        _left_behind = NOTHING
    elif resumed:
        _left_behind = "run the same command again to resume"
    else:
        _left_behind, _folder = f"files written so far are in {out}", str(out)


def report() -> None:
    """Print the line for an interrupt on standard error."""
    empty = _folder and not any(Path(_folder).glob("[!.]*"))
    print(f"interrupted; {NOTHING if empty else _left_behind}", file=sys.stderr, flush=True)


@contextmanager
def end_after_interrupt(last: bool = False) -> Iterator[None]:
    """End a block within TIME_LIMIT after Ctrl-C; has an effect in the main thread alone. last: whether the
    process ends with the block; later signals are then ignored."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, _first_interrupt)
    read_end, write_end = os.pipe()
    os.set_blocking(write_end, False)
    previous = signal.set_wakeup_fd(write_end, warn_on_full_buffer=False)
    done = threading.Event()
    threading.Thread(target=_end_in_time, args=(read_end, done), daemon=True).start()
    try:
        yield
    finally:
        done.set()
        signal.set_wakeup_fd(previous)
        os.close(write_end)
        if signal.getsignal(signal.SIGINT) is _first_interrupt:  # no interrupt has occurred
            signal.signal(signal.SIGINT, signal.SIG_IGN if last else signal.default_int_handler)


def _first_interrupt(number: int, frame: object) -> None:
    """Raise KeyboardInterrupt once, and ignore further signals, which would interrupt the clean-up."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    raise KeyboardInterrupt


def _end_in_time(read_end: int, done: threading.Event) -> None:
    """End the process if the block is not done within TIME_LIMIT after an interrupt."""
    while received := os.read(read_end, 1):  # empty when the other end is closed
        if received[0] == signal.SIGINT and not done.wait(TIME_LIMIT):
            if sys.stderr.isatty():
                sys.stderr.write("\r\x1b[K\x1b[?25h")  # clear the spinner's line, show its hidden cursor
            report()
            os._exit(STATUS)
    os.close(read_end)
