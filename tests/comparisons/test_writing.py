"""Files of results are whole or absent, have one writer, and say in a line where they cannot be written."""

import errno
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from commands import one_line, run

from comparisons.sweep.folder import Folder
from sheetbench.answers.files import folder
from sheetbench.answers.report import Report
from sheetbench.files import replacing, require_file
from sheetbench.scenes import BadInput, load


def test_a_file_is_whole_or_as_it_was(tmp_path):
    path = tmp_path / "file.txt"
    path.write_text("before")
    with pytest.raises(ZeroDivisionError), replacing(path) as partial:
        partial.write_text("half")
        raise ZeroDivisionError
    assert path.read_text() == "before"
    with replacing(path) as partial:
        partial.write_text("after")
    assert path.read_text() == "after"
    assert [found.name for found in tmp_path.iterdir()] == ["file.txt"]


def test_a_link_planted_where_a_file_is_prepared_is_not_followed(tmp_path):
    victim = tmp_path / "victim"
    victim.write_text("mine")
    (tmp_path / f".file.{os.getpid()}.partial.txt").symlink_to(victim)
    with replacing(tmp_path / "file.txt") as partial:
        partial.write_text("ours")
    assert victim.read_text() == "mine" and (tmp_path / "file.txt").read_text() == "ours"


OTHERS = {
    "link": lambda path: path.symlink_to(path.with_name("victim")),
    "folder": Path.mkdir,
    "pipe": os.mkfifo,
}


@pytest.mark.parametrize("kind", OTHERS)
@pytest.mark.parametrize("verb", ["report", "new"])
def test_verbs_that_write_one_file_replace_no_other_kind(tmp_path, capsys, verb, kind):
    studies, path = (
        tmp_path / "studies",
        tmp_path / "pages" / f"page.{'html' if verb == 'report' else 'toml'}",
    )
    Folder(studies, "modes", ["sheetbench", "modes"]).report(Report("modes", "t", {}))
    path.parent.mkdir()
    OTHERS[kind](path)
    before = path.lstat()[:7]  # without the times, of which reading a link changes one
    words = (str(studies), "--out", str(path)) if verb == "report" else (str(path), "--overwrite")
    assert run(verb, *words) == 2
    assert f"{path}: cannot be written, a " in one_line(capsys)
    assert path.lstat()[:7] == before and [*path.parent.iterdir()] == [path]


def test_what_killed_writers_left_is_cleared_and_what_living_ones_write_is_not(tmp_path):
    dead = subprocess.Popen([sys.executable, "-c", ""])
    dead.wait()
    names = (f".file.{os.getppid()}.partial.txt", f".other.{dead.pid}.partial.txt", ".file.partial.txt")
    left, *others = (tmp_path / name for name in (f".file.{dead.pid}.partial.txt", *names))
    for path in (left, *others):
        path.write_text("half")
    with replacing(tmp_path / "file.txt") as partial:
        partial.write_text("whole")
    assert not left.exists() and all(path.exists() for path in others)


@pytest.mark.parametrize(
    ("number", "said"),
    [
        (errno.ENOSPC, "no space left on device: free some"),
        (errno.EROFS, "read-only file system: choose another folder"),
        (errno.EACCES, "permission denied: make it writable"),
    ],
)
def test_what_stands_in_the_way_is_said_with_the_remedy(tmp_path, number, said):
    path = tmp_path / "file.txt"
    with pytest.raises(BadInput, match=f"{path}: cannot be written, {said}"), replacing(path):
        raise OSError(number, os.strerror(number))
    assert not list(tmp_path.iterdir())


def test_a_folder_that_cannot_be_had_is_refused(tmp_path, monkeypatch):
    (tmp_path / "link").symlink_to(tmp_path / "nothing")
    (tmp_path / "file").touch()
    root = "the root of the file system; name a folder in it"
    device = "a device, pipe or socket is there: choose another name"
    for ask, place, said in (
        (folder, tmp_path / "link", "a broken link is there"),
        (folder, tmp_path / "file" / "under", "Not a directory"),
        (require_file, Path(os.devnull), device),
        *((folder, place, root) for place in ("/", "//", "/usr/..")),
    ):
        with pytest.raises(BadInput, match=said):
            ask(place)
    monkeypatch.setattr(os, "access", lambda path, mode: False)
    with pytest.raises(BadInput, match="cannot be written to; make it writable"):
        folder(tmp_path)


def test_overwriting_removes_runs_that_stream_to_folders_in_a_folder(tmp_path):
    out, victim = tmp_path / "out", tmp_path / "victim"
    victim.mkdir()
    (victim / "mine.csv").touch()
    runs = Folder(out, "compare", ["sheetbench", "compare"]).reserve("runs/")
    (runs / "shell-1").mkdir(parents=True)
    (runs / "shell-1" / "steps.csv").touch()
    (runs / "link").symlink_to(victim)
    again = Folder(out, "compare", ["sheetbench", "compare"], overwrite=True)
    assert not again.reserve("runs/").exists() and (victim / "mine.csv").exists()


def test_a_file_that_no_run_wrote_is_replaced_only_on_request(tmp_path):
    def write(text, **settings):
        Folder(tmp_path, "check", ["sheetbench", "check"], **settings).write(
            "check.md", lambda path: path.write_text(text)
        )

    mine = tmp_path / "check.md"
    mine.write_text("mine")
    with pytest.raises(BadInput, match="no run wrote it; move it, or --overwrite"):
        write("ours")
    assert mine.read_text() == "mine"
    write("ours", overwrite=True)
    write("again")
    assert mine.read_text() == "again"


def test_a_new_scene_is_whole_or_not_there(tmp_path, capsys):
    (tmp_path / "scene.schema.json").mkdir()
    assert run("new", str(tmp_path / "s.toml")) == 2
    assert "scene.schema.json: cannot be written" in one_line(capsys)
    assert not (tmp_path / "s.toml").exists()


def test_names_that_are_no_utf_8_are_names_too(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    name = os.fsdecode(b"q\xff")
    load("one-edge-clamped").save(f"{name}.toml")
    for words in (("check", f"{name}.toml", "--out", name), ("calibrate", f"{name}.toml", "--export", "a")):
        monkeypatch.setattr(sys, "argv", ["sheetbench", *words])
        assert run(*words, "--no-pictures") == run(*words, "--no-pictures") == 0
        manifest = json.loads((Path(words[-1]) / "manifest.json").read_text(encoding="utf-8"))
        assert manifest["command"] == ["sheetbench", *words]
