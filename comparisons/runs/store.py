"""The SQLite file of a campaign: one row a finished run, written at once and never changed.

Runs that failed or were lost may be forgotten, to be done again.

Table `runs`: key (hash of what was asked of which code, see `campaign.Run`), task and arguments (JSON),
status, row (JSON, what the run found), message, started and finished (UTC, ISO 8601), seconds. A row is
committed, and synchronised to disk, before the next run's result is looked at: killing the process loses only
runs that had not finished.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from comparisons.report.files import plain
from sheetbench.scenes.errors import BadInput

FILE = "campaign.sqlite"
_TABLE = """
create table if not exists runs (
    key text primary key, task text not null, arguments text not null, status text not null,
    row text not null, message text not null, started text not null, finished text not null,
    seconds real not null
)
"""


@dataclass(frozen=True)
class Finished:
    """A finished run: its key, how it ended, what it found (plain JSON data), when (UTC) and in how long [s].

    status: the solver's where the run is a solve, else `done`; `refused` where its input was refused (it
    raised BadInput), `failed` where it raised anything else, a fault whose "traceback" is all the row holds;
    `lost` where it took its process down with it.
    """

    key: str
    status: str
    row: dict[str, Any]
    message: str
    started: str
    finished: str
    seconds: float


class Store:
    """The finished runs of a folder's campaigns."""

    def __init__(self, path: Path) -> None:
        """Open or make the file. Raises BadInput for a file that is not one of these."""
        self.path = path
        self._database = sqlite3.connect(path)
        try:
            self._database.execute("pragma synchronous = full")
            self._database.execute(_TABLE)
        except sqlite3.DatabaseError as error:
            self._database.close()
            raise BadInput(f"{path}: not a campaign's file: {error}") from None

    def add(self, task: str, arguments: dict[str, Any], run: Finished) -> None:
        """Keep a finished run."""
        asked, found = (json.dumps(plain(part), allow_nan=False) for part in (arguments, run.row))
        with self._database:
            self._database.execute(
                "insert into runs values (?, ?, ?, ?, ?, ?, ?, ?, ?)",
                (
                    run.key,
                    task,
                    asked,
                    run.status,
                    found,
                    run.message,
                    run.started,
                    run.finished,
                    run.seconds,
                ),
            )

    def get(self, key: str) -> Finished | None:
        """The finished run of a key, if there is one."""
        columns = "key, status, row, message, started, finished, seconds"
        found = self._database.execute(f"select {columns} from runs where key = ?", (key,)).fetchone()
        if found is None:
            return None
        key, status, row, *rest = found
        return Finished(key, status, json.loads(row), *rest)

    def forget(self, key: str) -> None:
        """Take out a run that found nothing, so that it can be done again."""
        with self._database:
            self._database.execute("delete from runs where key = ? and status in ('failed', 'lost')", (key,))

    def keys(self) -> Iterator[str]:
        """Keys of all finished runs."""
        return (key for (key,) in self._database.execute("select key from runs order by finished"))

    def close(self) -> None:
        """Close the file."""
        self._database.close()
