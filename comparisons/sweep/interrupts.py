"""Interrupts that reach us as something else.

A compiled function looks at its arguments in Python's own code before it starts. An interrupt that falls into
that moment is not seen by the function, and the interpreter says of it, in a `SystemError` whose cause is
the interrupt, that it "returned a result with an exception set".
"""

from __future__ import annotations


def is_behind(error: BaseException | None) -> bool:
    """Return whether an error was an interrupt, or came of one."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None
