"""The SQLite file of a campaign: one row per finished run, written immediately and never changed.

Failed and lost runs may be removed, to be repeated. The table `runs` has key (hash of arguments and code, see
`campaign.Run`), task and arguments (JSON), status, row (JSON, the run's answer), message, started and
finished (UTC, ISO 8601), seconds, and a digest of all other columns. A row is committed and synchronised to
disk before the next run's result is read, so killing the process loses unfinished runs alone. A file that is
damaged, locked or not writable is refused and left unchanged.
"""

import hashlib
import json
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sheetbench.answers.files import plain
from sheetbench.errors import BadInput
from sheetbench.files import require_file

FILE = "campaign.sqlite"
_TEXTS = ("task", "arguments", "status", "row", "message", "started", "finished")
COLUMNS = {
    "key": "text primary key",
    **dict.fromkeys(_TEXTS, "text not null"),
    "seconds": "real not null",
    "digest": "text not null",
}
_MOVE = "move it away to start over"
_REMEDY = "make it readable and writable, with room on the disk and no other program's lock, or move it away"


@dataclass(frozen=True)
class Finished:
    """A finished run: its key, status, answer (plain JSON data), times (UTC) and duration [s]. status: the
    solver's for a solve, else `done`; `refused` after a BadInput; `failed` after any other exception, with
    its "traceback" as the only entry of the row; `lost` if its process crashed or had not enough memory."""

    key: str
    status: str
    row: dict[str, Any]
    message: str
    started: str
    finished: str
    seconds: float


class Store:
    """The finished runs of a folder's campaigns; passing: whether the folder is temporary."""

    passing = False

    def __init__(self, path: Path) -> None:
        """Open or create the file. Raises BadInput for a damaged, read-only or foreign file."""
        self.path = path
        require_file(path)  # SQLite would follow a link
        with self._database_errors():
            self._database = sqlite3.connect(path)
        try:
            self._prepare()
        except BaseException:
            self._database.close()
            raise

    def _prepare(self) -> None:
        columns = ", ".join(f"{name} {kind}" for name, kind in COLUMNS.items())
        with self._database_errors():
            self._database.execute("pragma synchronous = full")
            (health,) = self._database.execute("pragma quick_check(1)").fetchone()
            if health == "ok":
                with self._database:
                    self._database.execute(f"create table if not exists runs ({columns})")
            present = [name for _, name, *_ in self._database.execute("pragma table_info(runs)")]
        if health != "ok":
            raise BadInput(f"{self.path}: is damaged ({' '.join(health.split())}); {_MOVE}")
        if present != list(COLUMNS):
            raise BadInput(f"{self.path}: belongs to another program or version; {_MOVE}")

    def add(self, task: str, arguments: dict[str, Any], run: Finished) -> None:
        """Store a finished run. Raises BadInput if the file cannot be written."""
        inputs, outputs = (json.dumps(plain(part), allow_nan=False) for part in (arguments, run.row))
        values = (
            *(run.key, task, inputs, run.status, outputs, run.message),
            *(run.started, run.finished, float(run.seconds)),
        )
        places = ", ".join("?" for _ in COLUMNS)
        with self._database_errors(), self._database:
            self._database.execute(f"insert into runs values ({places})", (*values, _digest(values)))

    def get(self, key: str) -> Finished | None:
        """Return the finished run of a key, None without one. Raises BadInput for a damaged row."""
        with self._database_errors():
            record = self._database.execute("select * from runs where key = ?", (key,)).fetchone()
        if record is None:
            return None
        *values, digest = record
        if _digest(values) != digest:
            raise BadInput(f"{self.path}: the row of a run of '{values[1]}' is damaged; {_MOVE}")
        key, _, _, status, row, *rest = values
        return Finished(key, status, json.loads(row), *rest)

    def forget(self, key: str) -> None:
        """Remove a run without an answer, so that it can be repeated."""
        with self._database_errors(), self._database:
            self._database.execute("delete from runs where key = ? and status in ('failed', 'lost')", (key,))

    def close(self) -> None:
        """Close the file."""
        self._database.close()

    @contextmanager
    def _database_errors(self) -> Iterator[None]:
        """Convert errors of SQLite to a BadInput that names the file."""
        try:
            yield
        except sqlite3.Error as error:
            raise BadInput(f"{self.path}: {error}; {_REMEDY}") from None


def _digest(values: Sequence[Any]) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()[:16]
