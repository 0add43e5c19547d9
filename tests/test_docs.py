"""Pages run as written; commands, options, scenes, links, targets, pictures and their numbers are there."""

import functools
import http.server
import json
import pkgutil
import re
import runpy
import shlex
import threading
from importlib.util import find_spec
from pathlib import Path

import pytest
from browser import browser, opened  # noqa: F401
from commands import run
from PIL import Image

import sheetbench as sb
from comparisons.cli.app import VERBS, verb_group
from sheetbench import scenes
from sheetbench.answers.report import drawn_from
from studies.codes.answer import codes
from studies.pages import kept

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
TEXT = README.read_text(encoding="utf-8")
MAKE = "".join((ROOT / place).read_text(encoding="utf-8") for place in ("Makefile", "studies/Makefile"))
BUILT = ("scene.md", "versions.md")  # by `make docs`, as the folders below
GENERATED = ("verbs/", "tables/", "examples/", *BUILT)
PLACES = (ROOT / "docs", ROOT / "docs" / "development")
PAGES = sorted(page for place in PLACES for page in place.glob("*.md") if page.name not in BUILT)
GIVEN_BY_THE_READER = {
    "uniaxial.csv",
    "ANSWERS.csv",
    "FILE",
    "SCENE",
    "machine.csv",
    "mujoco=.venv-mujoco/bin/python",
    "tcp://10.0.0.1:8786",
}
SERVERS = {"live"}


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
@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_commands_and_python_of_a_page_run_as_written(page, tmp_path, monkeypatch):
    """In one folder, in the order of the page; files of the repository are found by their paths in it."""
    for name in ("docs", "examples"):
        (tmp_path / name).symlink_to(ROOT / name)
    monkeypatch.chdir(tmp_path)
    for language, text in blocks(page, r"\{run\}|sh|python"):
        if language == "python":
            exec(compile(text, page.name, "exec"), {})
            continue
        for words in commands(text):
            if not set(words) & GIVEN_BY_THE_READER and words[0] not in SERVERS:
                plain = [] if {"--figure", "--animate"} & set(words) else ["--no-pictures"]
                assert run(*words, *plain) == 0, words


@pytest.mark.parametrize("page", [*PAGES, README], ids=lambda page: page.stem)
def test_commands_name_verbs_options_and_scenes_that_exist(page):
    known = verb_group().commands
    text = page.read_text(encoding="utf-8")
    fenced = [words for _, block in blocks(page, r"\{run\}|sh") for words in commands(block)]
    inline = [shlex.split(line.replace("\n", " ")) for line in re.findall(r"`sheetbench ([^`]+)`", text)]
    for verb, *words in fenced + inline:
        if verb.startswith("-"):
            continue
        assert verb in VERBS, verb
        if verb == "study":  # each has options of its own
            continue
        options = {name for option in known[verb].params for name in (*option.opts, *option.secondary_opts)}
        assert {word.partition("=")[0] for word in words if word.startswith("--")} <= options | {"--help"}
        if verb in ("compare", "simulate", "tradeoff", "modes") and words and words[0] != "SCENE":
            assert words[0] in scenes.catalogue() or words[0].endswith(".toml"), words


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
        pkgutil.resolve_name(name if "." in name or find_spec(name) else f"sheetbench.{name}")


def test_files_that_are_named_exist():
    places = list(PAGES)
    places += [ROOT / "CONTRIBUTING.md", README, ROOT / "Makefile", ROOT / "studies/Makefile"]
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


def test_python_of_the_readme_runs(capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # what the examples save
    namespace: dict[str, object] = {}
    for _, block in blocks(README, "python"):
        exec(compile(block, "README.md", "exec"), namespace)
    assert "%" in capsys.readouterr().out


def test_make_targets_exist():
    targets = re.findall(r"make ([\w-]+)", TEXT + (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8"))
    assert {"demo", "test", "check", "tests-of"} <= set(targets)
    for target in targets:
        assert re.search(rf"^{target}:", MAKE, re.M)


PICTURES = runpy.run_path(str(ROOT / "docs/pictures.py"))["answers"]()
QUICK = ("two-edges-clamped", "one-edge-clamped", "curved-edge", "curved-edge-down", "actuated-edge")


def described(picture):
    with Image.open(ROOT / "docs/images" / f"{picture}.png") as image:
        return image.text["Description"]


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[] if name in QUICK else pytest.mark.nightly) for name in PICTURES]
)
def test_a_picture_shows_what_a_solve_says_today(name):
    answer, _ = PICTURES[name]
    assert described(name) == answer().report().pictures[0].description, f"{name}.png: make pictures"


@pytest.mark.nightly
def test_the_map_of_stability_is_of_today():
    assert described("stability") == sb.stability("two-edges-clamped", workers=1).result()


def test_pictures_of_studies_show_the_rows_that_are_kept():
    assert described("codes") == codes().figures()[0].description
    assert described("master-curves") == drawn_from(kept("master-curves").tables)
    rows = [drawn_from([table]) for table in kept("reproduction").tables]
    for name in ("test-1", "test-2-up", "test-2-down"):
        assert described(f"reproduction/{name}") in rows


def test_numbers_in_the_pictures_are_those_of_the_text():
    numbers = r"error at the probes ([\d.]+) %, over the sheet ([\d.]+) %"
    shown = re.search(numbers, described("two-edges-clamped"))
    caption = re.search(r"lattice is ([\d.]+) % off the shell, and that", TEXT)
    row = re.search(r"^\| lumped \| .*\| ([\d.]+) \| ([\d.]+) \| [\d.]+ \| converged", TEXT, re.M)
    assert caption and row and row.groups() == shown.groups()
    assert float(caption[1]) == round(float(shown[1]), 1)
    scenes_drawn = [one for one in PICTURES if one in scenes.catalogue()]
    errors = sorted(float(re.search(r"([\d.]+) %", described(one))[1]) for one in scenes_drawn)
    said = re.search(r"are ([\d.]+) to ([\d.]+) % off on\D*half of them at most ([\d.]+) %", TEXT)
    assert [*map(float, said.groups())] == [errors[0], errors[-1], errors[len(errors) // 2]]


def test_the_page_of_the_catalogue_has_every_scene_with_a_picture():
    page = (ROOT / "docs" / "catalogue.md").read_text(encoding="utf-8")
    sections = {part.partition("\n")[0]: part for part in page.split("\n## ")[1:]}
    assert sections.keys() == scenes.catalogue().keys()
    for name, section in sections.items():
        assert scenes.load(name).title in section and "![" in section and f" {name} " in section


def test_every_picture_is_drawn_by_a_make_target_and_shown_somewhere():
    pages = TEXT + "".join(path.read_text(encoding="utf-8") for path in ROOT.glob("docs/*.md"))
    scripts = "\n".join(
        path.read_text(encoding="utf-8") for path in ROOT.glob("docs/*.py") if f"docs/{path.name}" in MAKE
    )
    for path in (ROOT / "docs/images").iterdir():
        if path.is_file():
            assert f"images/{path.name}" in pages, f"{path.name}: shown nowhere"
            assert f"images/{path.name}" in MAKE or path.stem in scripts, (
                f"{path.name}: no make target draws it"
            )


@pytest.mark.nightly
@pytest.mark.parametrize("size", [(1440, 900), (390, 844)])
def test_the_page_in_the_browser_steps_a_lattice_beside_the_shells_answer(size, browser, tmp_path):  # noqa: F811
    """It has its programs in little room, moves, settles at its own answer, and gives way to a finger."""
    if find_spec("ziglang") is None:
        pytest.skip("no ziglang in this environment")
    runpy.run_path(str(ROOT / "docs" / "try_page.py"))["build"](tmp_path)
    assert sum(path.stat().st_size for path in tmp_path.iterdir()) < 700_000
    serve = functools.partial(http.server.SimpleHTTPRequestHandler, directory=tmp_path)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), serve)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    address = f"http://127.0.0.1:{server.server_port}/index.html"
    look = {"width": size[0], "height": size[1]}
    with opened(browser, address, offline=False, viewport=look) as (page, watch):
        page.wait_for_function("window.measured && measured.time > 4", timeout=60_000)
        rest = page.evaluate("measured")
        assert rest["corner"] == pytest.approx(rest["known"], rel=0.02)
        assert page.evaluate("document.documentElement.scrollWidth") == size[0]
        box = page.locator("#sheet").bounding_box()
        x, y = box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]
        page.mouse.move(x, y)
        page.mouse.down()
        page.mouse.move(x, y - 0.3 * box["height"], steps=5)
        page.wait_for_function(f"measured.corner - {rest['corner']} > 2e-3", timeout=60_000)
        page.mouse.up()
        page.locator("#gravity").fill("0")
        page.wait_for_function("measured.known === 0 && Math.abs(measured.corner) < 2e-3", timeout=60_000)
        assert not watch.troubles
    server.shutdown()


def test_the_shells_stored_answers_are_the_shells():
    made = runpy.run_path(str(ROOT / "docs" / "try_page.py"))
    stored = json.loads((ROOT / "docs" / "try" / "answers.json").read_text(encoding="utf-8"))
    assert stored.keys() == {f"{name} {1e3 * h:g}" for name in made["SCENES"] for h in made["THICKNESSES"]}
    shell = sb.solve(made["scene_of"]("one-edge-clamped", 0.004), "shell", elements=8)
    found = list(shell.probes.values())[-1][2]
    assert stored["one-edge-clamped 4"]["1"] == pytest.approx(found, rel=1e-6)
