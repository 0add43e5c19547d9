"""The SQLite file of a campaign: one row a finished run, written at once and never changed.

Runs that failed or were lost may be forgotten, to be done again.

Table `runs`: key (hash of arguments and code, see `campaign.Run`), task and arguments (JSON),
status, row (JSON, the run's answer), message, started and finished (UTC, ISO 8601), seconds, and a digest
of all these. A row is committed, and synchronised to disk, before the next run's result is looked at: killing
the process loses only runs that had not finished. A file that is damaged, locked or cannot be written is
refused, and left as it is.
"""

from __future__ import annotations

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
_MEND = "make it readable and writable, with room on the disk and no other program at it, or move it away"


@dataclass(frozen=True)
class Finished:
    """A finished run: its key, how it ended, its answer (plain JSON data), when (UTC) and in how long [s].

    status: the solver's where the run is a solve, else `done`; `refused` where its input was refused (it
    raised BadInput), `failed` where it raised anything else, a fault whose "traceback" is all the row holds;
    `lost` where it took its process down with it or had not enough memory.
    """

    key: str
    status: str
    row: dict[str, Any]
    message: str
    started: str
    finished: str
    seconds: float


class Store:
    """The finished runs of a folder's campaigns. passing: whether the folder is removed at the end."""

    passing = False

    def __init__(self, path: Path) -> None:
        """Open or make the file. Raises BadInput for one that is not a campaign's, damaged or read-only."""
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
            raise BadInput(f"{self.path}: is of another program or version; {_MOVE}")

    def add(self, task: str, arguments: dict[str, Any], run: Finished) -> None:
        """Keep a finished run. Raises BadInput where the file cannot be written."""
        inputs, outputs = (json.dumps(plain(part), allow_nan=False) for part in (arguments, run.row))
        values = (
            *(run.key, task, inputs, run.status, outputs, run.message),
            *(run.started, run.finished, float(run.seconds)),
        )
        places = ", ".join("?" for _ in COLUMNS)
        with self._database_errors(), self._database:
            self._database.execute(f"insert into runs values ({places})", (*values, _digest(values)))

    def get(self, key: str) -> Finished | None:
        """Return the finished run of a key, if there is one. Raises BadInput for a row that was changed
        since."""
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
        """What SQLite complains of, as a BadInput that names the file."""
        try:
            yield
        except sqlite3.Error as error:
            raise BadInput(f"{self.path}: {error}; {_MEND}") from None


def _digest(values: Sequence[Any]) -> str:
    return hashlib.sha256(json.dumps(values).encode()).hexdigest()[:16]
