"""The README and what it leads to: Python runs, pictures exist and are small."""

import re
from pathlib import Path

from PIL import Image

from comparisons.comparison.comparison import compare
from sheetbench import scenes

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language, text=TEXT):
    """The fenced blocks of a language. There must be some: a test that collects nothing proves nothing."""
    found = re.findall(rf"^```{language}\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
    assert found, f"no {language} block"
    return found


def make_files():
    return "".join(
        path.read_text(encoding="utf-8") for path in (ROOT / "Makefile", ROOT / "studies" / "Makefile")
    )


def test_python_runs(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # what the examples save
    namespace: dict[str, object] = {}
    for block in blocks("python"):
        exec(compile(block, "README.md", "exec"), namespace)
    assert "%" in capsys.readouterr().out


def test_make_targets_exist():
    makefile = make_files()
    targets = re.findall(r"make ([\w-]+)", TEXT + (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    assert {"demo", "test", "check", "tests-of"} <= set(targets)
    for target in targets:
        assert re.search(rf"^{target}:", makefile, re.MULTILINE)


def test_pictures_exist_and_are_small():
    pictures = re.findall(r"!\[[^\]]*\]\(([^)]+)\)", TEXT)
    assert pictures
    for picture in pictures:
        most = 1_000_000 if picture.endswith(".gif") else 300_000  # what moves is a few dozen pictures
        assert (ROOT / picture).stat().st_size < most


def test_numbers_in_the_pictures_are_those_of_the_text_and_of_a_solve():
    for name in ("two-edges-clamped", "one-edge-clamped", "curved-edge", "curved-edge-down", "actuated-edge"):
        with Image.open(ROOT / "docs/images" / f"{name}.png") as image:
            kept = image.info["Description"]
        assert kept == compare(name, uncertainty=False).figures()[0].description, f"{name}.png: make pictures"
    with Image.open(ROOT / "docs/images/two-edges-clamped.png") as image:
        shown = float(re.search(r"error at the probes ([\d.]+) %", image.info["Description"])[1])
    caption = re.search(r"lattice is ([\d.]+) % off the converged shell", TEXT)
    row = re.search(r"^\| lumped \| .*\| ([\d.]+) \| [\d.]+ \| converged", TEXT, re.MULTILINE)
    assert caption and row
    assert float(row[1]) == shown and float(caption[1]) == round(shown, 1)


def test_the_page_of_the_catalogue_has_every_scene_with_a_picture():
    page = (ROOT / "docs" / "catalogue.md").read_text(encoding="utf-8")
    sections = {part.partition("\n")[0]: part for part in page.split("\n## ")[1:]}
    assert sections.keys() == scenes.catalogue().keys()
    for name, section in sections.items():
        assert scenes.load(name).title in section and "![" in section and f" {name} " in section


def test_every_picture_is_drawn_by_a_make_target_and_shown_somewhere():
    pages = "\n".join(
        path.read_text(encoding="utf-8") for path in (*ROOT.glob("docs/*.md"), ROOT / "README.md")
    )
    makefile = make_files()
    scripts = "\n".join(
        path.read_text(encoding="utf-8") for path in ROOT.glob("docs/*.py") if f"docs/{path.name}" in makefile
    )
    for path in (ROOT / "docs/images").iterdir():
        if path.is_file():
            assert f"images/{path.name}" in pages, f"{path.name}: shown nowhere"
            assert f"images/{path.name}" in makefile or path.stem in scripts, (
                f"{path.name}: no make target draws it"
            )
