"""What every verb with --out does with it: one document, a folder that tells of itself, and what is refused.

Its terminal: test_terminal.py; its options in pairs: tests/test_matrix*.py; --quiet: test_quiet.py.
"""

import json
from pathlib import Path

import pytest
from commands import one_line, run
from verbs import SMALL, write_inputs

from comparisons.cli.app import verb_group
from sheetbench.answers.report import Picture

OUT = [  # the --out of `report` is a page
    verb
    for verb in SMALL
    if verb != "report" and any("--out" in one.opts for one in verb_group().commands[verb].params)
]
OTHER = {"two-edges-clamped": "one-edge-clamped", "one-edge-clamped": "two-edges-clamped"}
OTHER |= {"two-edges-settling": "one-edge-clamped"}
OF_NONE = {"calibrate", "crosscheck"}  # whose answer is of a sheet, or of several scenes


@pytest.fixture(autouse=True)
def here(tmp_path, monkeypatch, undrawn, few):
    monkeypatch.chdir(tmp_path)
    write_inputs(tmp_path)


def asked(verb):
    """Its command line without a folder."""
    line = SMALL[verb]
    return line[: line.index("--out")] if "--out" in line else line


@pytest.mark.parametrize("verb", OUT)
def test_its_folder_holds_the_printed_document_and_is_for_one_question(verb, tmp_path, capsys):
    """Asked again it answers again, from what a campaign or a run has kept; asked of another scene it is
    refused with the way out."""
    folder = tmp_path / "out"
    for _ in range(2):
        assert run(*asked(verb), "--json", "--out", str(folder)) == 0
        printed = capsys.readouterr()
        document = json.loads(printed.out)
        assert "Traceback" not in printed.err
    record = json.loads((folder / "manifest.json").read_text(encoding="utf-8"))["runs"][verb]
    assert record["finished"] and all((folder / name).exists() for name in record["files"])
    kept = [path.read_text(encoding="utf-8") for path in folder.glob("*.json")]
    assert document in [json.loads(text) for text in kept]
    scene = next((word for word in asked(verb) if word in OTHER), None)
    if scene is not None and verb not in OF_NONE:
        before = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
        again = [OTHER[scene] if word == scene else word for word in asked(verb)]
        assert run(*again, "--out", str(folder)) == 2
        assert "--overwrite" in one_line(capsys)
        assert {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before


@pytest.mark.parametrize("verb", OUT)
def test_what_is_no_folder_is_refused(verb, capsys):
    Path("taken").write_text("")
    for out, said in (("", "--out = ''"), ("taken", "taken")):
        assert run(*asked(verb), "--out", out) == 2
        assert said in one_line(capsys)


@pytest.mark.parametrize("verb", OUT)
def test_no_pictures_leaves_out_every_picture(verb, tmp_path, monkeypatch):
    """Of verbs, too, whose pictures have no style of their own."""
    drawn = []
    monkeypatch.setattr(Picture, "write", lambda picture, folder: drawn.append(picture.name))
    assert run(*asked(verb), "--quiet", "--no-pictures", "--out", str(tmp_path / "out")) == 0
    assert drawn == []
