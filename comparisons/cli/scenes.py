"""`sheetbench scenes`: lists the catalogue."""

from __future__ import annotations

from comparisons.cli.options import Json, Out


def command(json: Json = False, out: Out = None) -> None:
    """List the scenes that come with sheetbench; --out copies their files, to start from."""
    from comparisons.cli import console
    from comparisons.report.files import folder, to_json, write_text
    from comparisons.report.table import Column, Table
    from sheetbench import scenes

    files = scenes.catalogue()
    loaded = {name: scenes.load(name) for name in files}
    if out is not None:
        for name, path in files.items():
            write_text(folder(out) / f"{name}.toml", path.read_text(encoding="utf-8"))
    if json:
        listed = [
            {"name": name, "title": scene.title, "file": str(files[name])} for name, scene in loaded.items()
        ]
        print(to_json({"scenes": listed}), end="")
        return
    rows = tuple((name, scene.title) for name, scene in loaded.items())
    console.show(Table("Scenes", (Column("name"), Column("what it is", prose=True)), rows))
    console.note("Run one with:  sheetbench compare NAME")
    if out is not None:
        console.note(f"{len(files)} files written to {out}")
