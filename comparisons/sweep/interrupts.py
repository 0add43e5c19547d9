"""Detection of Ctrl-C behind another exception.

A compiled function checks its arguments in Python code before it starts. An interrupt at that moment makes
the interpreter raise a `SystemError`, "returned a result with an exception set", with the interrupt as cause.
"""


def is_behind(error: BaseException | None) -> bool:
    """Return whether an error is an interrupt or was caused by one."""
    while error is not None and not isinstance(error, KeyboardInterrupt):
        error = error.__cause__ or error.__context__
    return error is not None
