"""The documentation: the tutorial runs as written; commands, scenes and links name what exists."""

import pkgutil
import re
import shlex
import shutil
import sys
from pathlib import Path

import pytest
from commands import run

from comparisons.cli.app import VERBS
from sheetbench import scenes

ROOT = Path(__file__).parent.parent
PAGES = sorted(page for page in (ROOT / "docs").glob("*.md") if page.name != "scene.md")  # the build's
GENERATED = ("verbs/", "tables/", "examples/", "scene.md")  # by `make docs`


def blocks(page, languages):
    """The fenced blocks of a page: language and text."""
    return re.findall(rf"^```({languages})\n(.*?)^```", page.read_text(encoding="utf-8"), re.M | re.S)


def commands(block):
    """The words of every sheetbench command in a block."""
    return [
        shlex.split(line, comments=True)[1:] for line in block.splitlines() if line.startswith("sheetbench ")
    ]


@pytest.mark.nightly
@pytest.mark.usefixtures("in_process")
def test_tutorial_runs_as_written(tmp_path, monkeypatch, capsys):
    shutil.copy(ROOT / "examples/other-codes/read_lattice.py", tmp_path)
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(tmp_path))
    for language, text in blocks(ROOT / "docs/tutorial.md", "sh|python"):
        if language == "python":
            exec(compile(text, "tutorial.md", "exec"), {})
            continue
        for words in commands(text):
            assert run(*words) == 0, words
    sys.modules.pop("read_lattice", None)
    off = re.search(r"off by ([\d.]+) %", capsys.readouterr().out)
    assert off and float(off[1]) < 10.0  # of a coarse grid; without its area springs it is 40 % off
    for name in ("mine.pdf", "trade/tradeoff.pdf", "trade/manifest.json"):
        assert (tmp_path / name).stat().st_size > 0


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_name_verbs_and_scenes_that_exist(page):
    for _, text in blocks(page, "sh"):
        for verb, *arguments in commands(text):
            assert verb in VERBS
            if verb in ("compare", "simulate", "tradeoff", "advise", "modes"):
                assert arguments[0] in scenes.catalogue() or arguments[0].endswith(".toml")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_somewhere(page):
    for link in re.findall(r"\]\(([^)#]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
        if "://" not in link and not link.startswith(GENERATED):
            assert (page.parent / link).exists(), link


def test_scenes_of_the_documentation_load(tmp_path):
    path = tmp_path / "scene.toml"
    (text,) = [t for _, t in blocks(ROOT / "docs/first-steps.md", "toml") if "[sheet]" in t]
    path.write_text(text, encoding="utf-8")
    scenes.require_static(scenes.load(path))


@pytest.mark.parametrize("page", sorted((ROOT / "docs/api").glob("*.md")), ids=lambda page: page.stem)
def test_the_reference_of_the_python_interface_names_what_exists(page):
    text = page.read_text(encoding="utf-8")
    for name in re.findall(r"auto(?:module|class|function):: (\S+)$", text, re.M):
        pkgutil.resolve_name(name if "." in name or name in sys.modules else f"sheetbench.{name}")


def test_files_that_are_named_exist():
    places = [page for page in PAGES if page.name != "quality.md"]  # a record of what was
    places += [ROOT / "CONTRIBUTING.md", ROOT / "README.md", ROOT / "Makefile", ROOT / "studies/Makefile"]
    places += (ROOT / ".ci").iterdir()
    rooms = "tests|benchmarks|studies|comparisons|lumped|fem_reference|sheetbench"
    path = rf"(?<![\w/{{])(?:{rooms})/[\w/.-]+\.(?:py|toml|json|csv|txt)\b"
    named = {
        (page.name, name) for page in places for name in re.findall(path, page.read_text(encoding="utf-8"))
    }
    forms = re.compile("CODE|NAME")  # to be filled in
    real = sorted((page, name) for page, name in named if not forms.search(name))
    assert len(real) > 30
    assert [x for x in real if not any((root / x[1]).exists() for root in (ROOT, ROOT / "tests"))] == []
