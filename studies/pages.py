"""Results as they are kept, `results/NAME.json`, and the pages that the documentation's build makes of them.

A file has the words of a report, every table with its rows in SI units, and in `made` when and with what it
was measured: `keep` writes it, `kept` returns the report again, whose `to_markdown()` is the page.

    python -m studies.pages FOLDER    keeps what a study or a verb has written with --out FOLDER
"""

from __future__ import annotations

import json
import platform
import sys
from dataclasses import asdict
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from comparisons.pages import studies as runs
from comparisons.pages.studies import tables
from sheetbench.answers.files import plain, write_text
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table, TableUnit, unit
from sheetbench.sources import version

RESULTS = Path(__file__).with_name("results")
LISTS, WORDS = ("notes", "complaints"), ("title", "subtitle", "lead", "notes", "complaints")
DEFAULTS = plain(asdict(Column()))


def keep(report: Report, name: str = "", made: str = "") -> Path:
    """Write a report's tables and words to the kept results of that name, the report's own unless given;
    where they are. made: when and with what, today and this machine unless given."""
    here = f"sheetbench {version()}, Python {platform.python_version()}, {platform.machine()}"
    words = {"made": made or f"{here}, {datetime.now(UTC).date()}", **{k: getattr(report, k) for k in WORDS}}
    tables = ",\n".join(map(_text, report.tables))
    path = RESULTS / f"{name or report.name}.json"
    head = json.dumps(plain(words), ensure_ascii=False, indent=1).removesuffix("\n}")
    write_text(path, f'{head},\n "tables": [\n{tables}\n ]\n}}\n')
    return path


def _text(table: Table) -> str:
    """Return a table as JSON, a row a line."""
    words = table.words() | {"rows": [[_plain(value) for value in row] for row in table.rows]}
    columns = plain(words["columns"])
    words["columns"] = [{k: v for k, v in c.items() if v != DEFAULTS.get(k, False)} for c in columns]
    rows = ",\n".join(f"   {json.dumps(plain(row), ensure_ascii=False)}" for row in words.pop("rows"))
    return f'  {json.dumps(words, ensure_ascii=False).removesuffix("}")}, "rows": [\n{rows}\n  ]}}'


def _plain(value: Any) -> Any:
    return value.si if isinstance(value, TableUnit) else value


def kept(name: str) -> Report:
    """Return the report that was kept under a name; its last note says when it was made."""
    document = json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))
    words: dict[str, Any] = {k: tuple(document[k]) if k in LISTS else document[k] for k in WORDS}
    words["notes"] += (f"{document['made']}.",)
    return Report(name=name, document={}, tables=tuple(map(_table, document["tables"])), **words)


def _table(words: dict[str, Any]) -> Table:
    """Return a table of its words and rows."""
    of_units = [column.pop("units", False) for column in words["columns"]]
    columns = tuple(Column(**column) for column in words["columns"])
    rows = (
        tuple(unit(value) if is_unit else value for is_unit, value in zip(of_units, row, strict=True))
        for row in words["rows"]
    )
    return Table(words["caption"], columns, tuple(rows), words["name"], words["grouped"], words["text"])


def keep_run(folder: Path) -> Path:
    """Keep the answer that a run has written into a folder; where it is. Raises ValueError unless there is
    one."""
    (run,) = runs.read(folder).studies
    words = run.words
    known: dict[str, Any] = {k: tuple(words[k]) if k in LISTS else words[k] for k in WORDS}
    name = words["document"].removesuffix(".json")
    return keep(Report(name=name, document={}, tables=tuple(tables(run)), **known))


if __name__ == "__main__":
    print(keep_run(Path(sys.argv[1])))
