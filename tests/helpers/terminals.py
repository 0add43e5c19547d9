"""A program on a terminal: its screen, keys pressed, its end."""

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
from contextlib import suppress

from campaigns import wait_for

CONTROL = re.compile(r"\x1b\[[0-?]*[ -/]*[@-~]|\r")
COMMAND = "from comparisons.cli import main; main()"


def resize(file: int, columns: int) -> None:
    """Make a terminal so many columns wide."""
    fcntl.ioctl(file, termios.TIOCSWINSZ, struct.pack("HHHH", 50, columns, 0, 0))


class Terminal:
    """Python code that runs on a terminal of its own; `shown` is what it has shown, without the colours."""

    def __init__(self, code: str, *arguments: str, columns: int = 80) -> None:
        self.process, self._terminal = pty.fork()
        if not self.process:
            os.environ["TERM"] = "xterm"
            for name in ("COLUMNS", "LINES", "NO_COLOR", "FORCE_COLOR"):
                os.environ.pop(name, None)
            os.execv(sys.executable, [sys.executable, "-c", code, *arguments])
        resize(self._terminal, columns)
        self._bytes = b""

    @property
    def raw(self) -> str:
        return self._bytes.decode("utf-8", "replace")

    @property
    def shown(self) -> str:
        return CONTROL.sub("", self.raw)

    def read(self) -> bool:
        """Wait for more to be shown; whether there was more. The limit only ends a test that hangs."""
        ready, _, _ = select.select([self._terminal], [], [], 600.0)
        assert ready, f"nothing more is shown after {self.shown}"
        try:
            more = os.read(self._terminal, 65536)
        except OSError:  # nobody has the terminal open any more
            more = b""
        self._bytes += more
        return bool(more)

    def wait_for(self, text: str) -> None:
        """Read until a text is shown."""
        while text not in self.shown:
            assert self.read(), f"it ended without {text!r}: {self.shown}"

    def press(self, keys: bytes) -> None:
        """Press keys; Ctrl-C is b"\\x03"."""
        os.write(self._terminal, keys)

    def end(self) -> int:
        """Read to the end; the exit status. None of its processes is left then."""
        while self.read():
            pass
        os.close(self._terminal)
        _, status = os.waitpid(self.process, 0)
        try:  # those it has ended may take a moment on a busy machine
            wait_for(lambda: not self._alive(), 120.0)
        finally:
            with suppress(ProcessLookupError):
                os.killpg(self.process, signal.SIGKILL)
        return os.waitstatus_to_exitcode(status)

    def _alive(self) -> bool:
        """Return whether any of its processes runs; an ended one may be a zombie for a while."""
        listed = subprocess.run(["ps", "-A", "-o", "pgid=,stat="], capture_output=True, text=True, check=True)
        rows = (line.split() for line in listed.stdout.splitlines())
        return any(int(group) == self.process and not state.startswith("Z") for group, state in rows)
