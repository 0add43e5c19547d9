"""The scenes that come with the package, as a list and as files to start from."""

from __future__ import annotations

from functools import partial

from sheetbench.answers.files import write_text
from sheetbench.answers.report import Report
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import catalogue, load


def report() -> Report:
    """What `sheetbench scenes` shows; the scenes' own files go along into a folder."""
    files = catalogue()
    titles = {name: load(name).title for name in files}
    texts = {f"{name}.toml": path.read_text(encoding="utf-8") for name, path in files.items()}
    columns = (Column("name"), Column("what it is", prose=True))
    return Report(
        name="scenes",
        title="Catalogue",
        document={
            "scenes": [{"name": n, "title": titles[n], "file": str(path)} for n, path in files.items()]
        },
        tables=(Table("Scenes that come with sheetbench", columns, tuple(titles.items())),),
        notes=("Run one with:  sheetbench compare NAME",),
        attachments={name: partial(write_text, text=text) for name, text in texts.items()},
    )
