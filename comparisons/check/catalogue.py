"""The scenes that come with the package, as a list and as files to start from."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import Annotated, Any

from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import catalogue, load


@dataclass(frozen=True)
class Entry:
    """A scene of the catalogue."""

    name: str
    title: Annotated[str, Column("what it is", prose=True)]
    file: str


class Catalogue(Answer):
    """The list that `sheetbench scenes` shows; the scenes' own files go along into a folder."""

    file_name = "scenes"

    def __init__(self) -> None:
        self.entries = [Entry(name, load(name).title, str(path)) for name, path in catalogue().items()]

    def heading(self) -> tuple[str, str, str]:
        return "Catalogue", "", ""

    def document(self) -> dict[str, Any]:
        return {"scenes": [vars(entry) for entry in self.entries]}

    def tables(self) -> tuple[Table, ...]:
        return (Table.of(Entry, self.entries, "Scenes that come with sheetbench", without=("file",)),)

    def notes(self) -> tuple[str, ...]:
        return ("Run one with:  sheetbench compare NAME",)

    def files(self) -> dict[str, Write]:
        texts = {name: path.read_text(encoding="utf-8") for name, path in catalogue().items()}
        return {f"{name}.toml": partial(write_text, text=text) for name, text in texts.items()}
