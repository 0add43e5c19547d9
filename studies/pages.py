"""Stored results, `results/NAME.json`, from which the documentation's build makes pages.

A file has the words of a report, every table with its rows in SI units, and in `made` the date, version and
machine of the measurement: `keep` writes it, `kept` returns the report again, whose `to_markdown()` is the
page.

    python -m studies.pages FOLDER    keeps the answer that a study or a verb has written with --out FOLDER
"""

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
    """Write a report's tables and texts to the stored results, and return the file. name: of the results, the
    report's own by default; made: date and machine, today and this machine by default."""
    machine = f"sheetbench {version()}, Python {platform.python_version()}, {platform.machine()}"
    words = {
        "made": made or f"{machine}, {datetime.now(UTC).date()}",
        **{k: getattr(report, k) for k in WORDS},
    }
    tables = ",\n".join(map(_text, report.tables))
    path = RESULTS / f"{name or report.name}.json"
    head = json.dumps(plain(words), ensure_ascii=False, indent=1).removesuffix("\n}")
    write_text(path, f'{head},\n "tables": [\n{tables}\n ]\n}}\n')
    return path


def _text(table: Table) -> str:
    """Return a table as JSON, one line per row."""
    words = table.words() | {"rows": [[_plain(value) for value in row] for row in table.rows]}
    columns = plain(words["columns"])
    words["columns"] = [{k: v for k, v in c.items() if v != DEFAULTS.get(k, False)} for c in columns]
    rows = ",\n".join(f"   {json.dumps(plain(row), ensure_ascii=False)}" for row in words.pop("rows"))
    return f'  {json.dumps(words, ensure_ascii=False).removesuffix("}")}, "rows": [\n{rows}\n  ]}}'


def _plain(value: Any) -> Any:
    return value.si if isinstance(value, TableUnit) else value


def kept(name: str) -> Report:
    """Return the stored report of a name; its last note has the date, version and machine."""
    document = json.loads((RESULTS / f"{name}.json").read_text(encoding="utf-8"))
    words: dict[str, Any] = {k: tuple(document[k]) if k in LISTS else document[k] for k in WORDS}
    words["notes"] += (f"{document['made']}.",)
    return Report(name=name, document={}, tables=tuple(map(_table, document["tables"])), **words)


def _table(words: dict[str, Any]) -> Table:
    """Return a table from its words and rows."""
    unit_columns = [column.pop("units", False) for column in words["columns"]]
    columns = tuple(Column(**column) for column in words["columns"])
    rows = (
        tuple(unit(value) if is_unit else value for is_unit, value in zip(unit_columns, row, strict=True))
        for row in words["rows"]
    )
    return Table(words["caption"], columns, tuple(rows), words["name"], words["grouped"], words["text"])


def keep_run(folder: Path) -> Path:
    """Store the answer that a run has written into a folder, and return the file. Raises ValueError for a
    folder without an answer."""
    (run,) = runs.read(folder).studies
    words = run.words
    report_words: dict[str, Any] = {k: tuple(words[k]) if k in LISTS else words[k] for k in WORDS}
    name = words["document"].removesuffix(".json")
    return keep(Report(name=name, document={}, tables=tuple(tables(run)), **report_words))


if __name__ == "__main__":
    print(keep_run(Path(sys.argv[1])))
