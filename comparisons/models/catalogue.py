"""The scenes that come with the package, and the language of scenes as a JSON Schema."""

from functools import partial
from typing import Any

from comparisons.models.keys_page import markdown
from sheetbench.answers.answer import Answer
from sheetbench.answers.files import write_text
from sheetbench.answers.report import Write
from sheetbench.answers.table import Column, Table
from sheetbench.scenes import Scene, catalogue, load
from sheetbench.scenes.language.schema import for_editors


class Catalogue(Answer):
    """The catalogue as `sheetbench check` lists it; with `--out` the scenes' files are copied too."""

    file_name = "scenes"

    def __init__(self) -> None:
        self.titles = {name: load(name).title for name in catalogue()}

    def heading(self) -> tuple[str, str, str]:
        return "Catalogue", "", ""

    def document(self) -> dict[str, Any]:
        files = catalogue()
        return {"scenes": [{"name": n, "title": t, "file": str(files[n])} for n, t in self.titles.items()]}

    def tables(self) -> tuple[Table, ...]:
        columns = ("name", Column("what it is", prose=True))
        return (Table.listed("Scenes that come with sheetbench", columns, self.titles.items()),)

    def notes(self) -> tuple[str, ...]:
        return ("Run one with:  sheetbench compare NAME",)

    def files(self) -> dict[str, Write]:
        return {file: write for name in catalogue() for file, write in scene_file(name).items()}


def scene_file(name: str) -> dict[str, Write]:
    """Return the file of a catalogue scene with its writer, nothing for other names."""
    path = catalogue().get(name)
    if path is None:
        return {}
    return {f"{name}.toml": partial(write_text, text=path.read_text(encoding="utf-8"))}


class Schema(Answer):
    """The JSON Schema of a scene, for editors that complete and check TOML files, and a page of every key."""

    file_name = "schema"

    def heading(self) -> tuple[str, str, str]:
        return "Scenes as a JSON Schema", "", ""

    def document(self) -> dict[str, Any]:
        return dict(for_editors(Scene))

    def tables(self) -> tuple[Table, ...]:
        return ()

    def files(self) -> dict[str, Write]:
        return {"scene.md": partial(write_text, text=markdown())}
