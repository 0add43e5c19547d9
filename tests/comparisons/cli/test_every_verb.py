"""What every verb does with --json, --out, a terminal of any width and Python, by one kept run of each."""

import json
import re
from collections import Counter
from collections.abc import Callable
from functools import wraps
from importlib import import_module
from inspect import Parameter, signature
from pathlib import Path
from typing import Any, get_args

import pytest
import typer
from commands import one_line, run
from typer.main import get_command
from verbs import SMALL, WITHOUT_ANSWER, few_runs, in_python, undraw, values_of, write_inputs

import fem_reference
import lumped
import sheetbench as sb
from comparisons.cli import console
from comparisons.cli.app import VERBS, verb_group
from comparisons.cli.arguments import kind_of
from comparisons.cli.options import Group
from comparisons.cli.study import module_of
from comparisons.cli.verb import as_verb, evaluated
from lumped.fitting.methods import MAKERS
from sheetbench import choices
from sheetbench.answers.report import Picture
from sheetbench.errors import BadInput
from sheetbench.scenes import EdgeLoad, catalogue
from studies import STUDIES

ANSWERED = [name for name in SMALL if name not in WITHOUT_ANSWER]
ONE = "one-edge-clamped"
RESUMED = ("compare motion", "simulate", "tradeoff", "stability", "crosscheck")
OTHER = {"two-edges-clamped": "one-edge-clamped", "one-edge-clamped": "two-edges-clamped"}
OTHER |= {"two-edges-settling": "one-edge-clamped"}
OF_NONE = ("calibrate", "calibrate code", "crosscheck")  # whose answer is of a sheet, or of several scenes


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    undraw(monkeypatch)
    few_runs(monkeypatch)
    write_inputs(tmp_path)


def test_every_verb_is_tried():
    assert {name.split()[0] for name in SMALL} == set(VERBS) - {"live"}  # a server


@pytest.mark.parametrize("name", SMALL)
def test_it_ends_well_and_without_a_traceback(kept, name):
    found = kept(name)
    assert found.status == 0, found.said
    assert "Traceback" not in found.printed + found.said


@pytest.mark.parametrize("name", ANSWERED)
def test_its_folder_holds_the_printed_document(kept, name):
    found = kept(name)
    (record,) = json.loads((found.folder / "manifest.json").read_text(encoding="utf-8"))["runs"].values()
    assert record["finished"] and all((found.folder / file).exists() for file in record["files"])
    texts = [json.loads(path.read_text(encoding="utf-8")) for path in found.folder.glob("*.json")]
    printed = found.document
    assert any(text == printed or {**printed, "warnings": []} == text for text in texts)


@pytest.mark.parametrize("name", RESUMED)
def test_the_same_command_goes_on_from_what_it_kept(kept, name, here, capsys):
    """With the same answer, and no solve of it again."""
    before = kept(name)
    rows = before.folder / "campaign.sqlite"
    written = rows.exists() and rows.stat().st_mtime_ns
    assert run(*SMALL[name].split(), "--json", "--quiet", "--out", str(before.folder)) == 0
    after = json.loads(capsys.readouterr().out)
    gone_on = ("resumed", "steps", "iterations", "notes")  # a motion goes on from its last checkpoint
    assert dict(values_of(after, CLOCK + gone_on)) == dict(values_of(before.document, CLOCK + gone_on))
    assert written == (rows.exists() and rows.stat().st_mtime_ns)


@pytest.mark.parametrize("name", [name for name in ANSWERED if name not in OF_NONE])
def test_a_folder_is_for_one_question(kept, name, here, capsys):
    """Asked of another scene it is refused with the way out, and nothing there is another."""
    words, folder = SMALL[name].split(), kept(name).folder
    if OTHER.keys().isdisjoint(words):
        return
    before = {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}
    assert run(*(OTHER.get(word, word) for word in words), "--out", str(folder)) == 2
    assert "--overwrite" in one_line(capsys)
    assert {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()} == before


@pytest.mark.parametrize("name", ANSWERED)
def test_what_is_no_folder_is_refused(name, here, capsys):
    Path("taken").write_text("")
    for out, said in (("", "--out = ''"), ("taken", "taken")):
        assert run(*SMALL[name].split(), "--out", out) == 2
        assert said in one_line(capsys)


BUCKLED = sb.load("one-edge-clamped").replace(
    name="buckled", gravity=None, loads=(EdgeLoad("x1", force_per_length=(-40.0, 0.0, 0.0)),)
)
MAPS = ("tradeoff", "crosscheck", "stability")  # of many solves, each with its status
DOWN = ("compare", "modes", "modes state-space", "identify", "tradeoff tolerance", "calibrate code")
DOWN += ("calibrate cell",)


@pytest.mark.sweep(2)
@pytest.mark.parametrize("name", [*DOWN, *MAPS])
def test_an_answer_that_is_none_is_a_document_too(name, here, capsys):
    """Of a sheet that buckles; with exit status 3."""
    BUCKLED.save("buckled.toml")
    words = ["buckled.toml" if word in OTHER else word for word in SMALL[name].split()]
    more = ("--about", "deformed") if name == "modes" else ()
    assert run(*words, *more, "--json") == (0 if name in MAPS else 3)
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert "unstable" in json.dumps(found) and "Traceback" not in said.err
    if name in ("calibrate code", "calibrate cell"):  # the coefficients nearest to the moduli stay
        assert found["limit_error"] is None and found["coefficients"]
    assert name in MAPS or "negative" in said.err or "not a stable one" in said.err
    assert name != "modes state-space" or "no linear form about the equilibrium" in said.err


OF_A_SCENE = [name for name, line in SMALL.items() if not OTHER.keys().isdisjoint(line.split())]


@pytest.mark.nightly
@pytest.mark.parametrize("name", OF_A_SCENE)
@pytest.mark.parametrize("scene", catalogue())
def test_every_verb_takes_every_scene_of_the_catalogue(scene, name, here, ends):
    """Or refuses it in a line."""
    ends(*(scene if word in OTHER else word for word in SMALL[name].split()), "--json")


def test_no_pictures_leaves_out_every_picture(here, monkeypatch):
    """Where the answer is written, for all verbs."""
    drawn = []
    monkeypatch.setattr(Picture, "write", lambda picture, folder: drawn.append(picture.name))
    for more, some in (("--no-pictures",), False), ((), True):
        assert run("check", "one-edge-clamped", "--quiet", "--out", "folder", *more) == 0
        assert bool(drawn) == some


@pytest.mark.parametrize("verb", VERBS)
def test_every_verb_can_be_quiet_and_without_pictures(verb, monkeypatch, capsys):
    def verbosity(quiet, all_notes):
        raise BadInput("a request to be quiet")

    monkeypatch.setattr(console, "verbosity", verbosity)  # the verb itself does not begin
    needed = []
    for one in verb_group().commands[verb].params:
        if one.required:
            needed += [one.opts[0]] if one.param_type_name == "option" else []
            needed.append("one-edge-clamped")
    assert run(verb, *needed, "--no-pictures", "--quiet") == 2
    assert one_line(capsys) == "sheetbench: a request to be quiet\n"


@pytest.mark.sweep(2)
@pytest.mark.parametrize("width", [50, 80, 160])
@pytest.mark.parametrize("verb", VERBS)
def test_a_help_page_cuts_nothing_off(monkeypatch, capsys, verb, width):
    monkeypatch.setenv("COLUMNS", str(width))
    monkeypatch.setattr("typer.rich_utils.MAX_WIDTH", width)  # as it reads the variable where it is imported
    assert run(verb, "--help") == 0
    page = capsys.readouterr().out
    assert "--help" in page and "…" not in page.replace("N,N,…", "")


def test_help_lists_sixteen_verbs_on_a_screen(monkeypatch, capsys):
    """Of 40 lines and 80 columns, a line each."""
    monkeypatch.setenv("COLUMNS", "80")
    monkeypatch.setattr("typer.rich_utils.MAX_WIDTH", 80)
    assert run("--help") == 0
    page = capsys.readouterr().out.splitlines()
    assert len(page) <= 40 and tuple(re.findall(r"^│ (\w+)  ", "\n".join(page), re.M)) == VERBS
    assert len(VERBS) == 16


# ---- on a terminal
WIDE = 400  # columns, where nothing has to give way
FIGURES: dict[str, Callable[[Any], list[float]]] = {
    "compare": lambda d: [u for one in d["solutions"] for u in one["probes"]["P4"]],
    "calibrate": lambda d: [d["springs"]["axial"], d["springs"]["vertical"], d["layer_distance"]],
    "identify": lambda d: [d["unknowns"]["young"]["value"], *d["unknowns"]["young"]["interval"]],
    "tradeoff": lambda d: [row["error"] for row in d["rows"]],
    "modes": lambda d: [f for one in d["solutions"] for f in one["frequencies_hz"]],
    "verify": lambda d: [row["computed"] for row in d["rows"] if abs(row["computed"]) > 1e-3],
    "tradeoff tolerance": lambda d: [d["predicted"]["error"]],
}  # the main figures of a document
SCALES = (1.0, 1e2, 1e3, 1e6, 1e-3, 1e-6)  # of shown units
WAYS = {"50": (50, "utf-8"), "100": (100, "utf-8"), "80, ASCII": (80, "ascii")}


def numbers(text):
    """The numbers of a text as they are printed."""
    return re.findall(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?", text.replace("−", "-"))


@pytest.mark.sweep(2)
@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", ANSWERED)
def test_no_number_is_cut_and_no_screen_spent_on_empty_lines(kept, name, way):
    """A comparison of three models at four probes, with its notes, fits into 40 lines of 100 columns."""
    texts = [kept(name).shown(*one) for one in ((WIDE, "utf-8"), WAYS[way])]
    whole, shown = (Counter(numbers(text)) for text in texts)
    assert not whole - shown and not set(shown) - set(whole)
    assert "\n\n\n" not in texts[1] and not texts[1].endswith("\n\n")
    assert not name.startswith("compare") or way != "100" or len(texts[1].splitlines()) <= 40


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", FIGURES)
def test_the_main_figures_are_shown(kept, name, way):
    printed = [(float(n), 0.51 * 10.0 ** _last_digit(n)) for n in numbers(kept(name).shown(*WAYS[way]))]
    for figure in FIGURES[name](kept(name).document):
        assert any(abs(scale * figure - n) <= digit for scale in SCALES for n, digit in printed), figure


def _last_digit(number):
    """The power of ten of a printed number's last digit."""
    mantissa, _, exponent = number.partition("e")
    return int(exponent or 0) - len(mantissa.partition(".")[2])


@pytest.mark.parametrize("name", ["check", "tradeoff tolerance"])
def test_a_command_to_copy_is_one_line(kept, name):
    ends = (kept(name).shown(columns).partition("Solve it with:")[2] for columns in (50, 400))
    narrow, wide = (end.split("\n")[1].strip() for end in ends)
    assert narrow.startswith(f"sheetbench compare {SMALL[name].split()[1]}") and narrow == wide


# ---- in Python
PYTHON = [name for name in ANSWERED if not name.startswith("study")]
CLOCK = ("seconds", "memory", "timings", "busy", "load_average", "spread", "compile", "reason", "probing")
CLOCK += ("started", "finished", "front", "warnings")  # the front is of errors and times


@pytest.mark.parametrize("name", PYTHON)
def test_the_same_call_from_python_gives_the_same_answer(kept, name, here):
    verb, *words = SMALL[name].split()
    answer = in_python(verb, words)
    there, here_ = (dict(values_of(document, CLOCK)) for document in (kept(name).document, answer))
    if name == "tradeoff tolerance":  # which lattices are tried goes by their time
        there, here_ = ({key: of[key] for key in (".scene", ".bar") if key in of} for of in (there, here_))
    assert there == here_


def test_an_option_has_one_name_and_one_default_in_command_and_function():
    of_terminal = {"json", "quiet", "verbose", "help", "progress", "lattice"}
    for verb in set(VERBS) - {"live", "study"}:
        known = signature(getattr(sb, verb)).parameters
        options = {one.name: one for one in verb_group().commands[verb].params}
        hidden = {name for name, one in options.items() if getattr(one, "hidden", False)}
        assert set(known) - of_terminal == set(options) - of_terminal - hidden
        for name in set(known) - of_terminal:
            usual = known[name].default
            assert usual is Parameter.empty or usual in (options[name].default, None, False), name


@pytest.mark.parametrize("verb", [*VERBS, *STUDIES])
def test_every_list_takes_commas_and_repetition(verb, tmp_path):
    """In Python lists; `--elements 8x4` too, and no help text has the same default twice."""
    module = import_module(f"comparisons.cli.{verb}") if verb in VERBS else module_of(verb)
    taken = {}

    @wraps(module.command)
    def command(*_, **values):
        groups = [vars(value) for value in values.values() if isinstance(value, Group)]
        taken.update({name: value for group in groups for name, value in group.items()} | values)

    command.no_effect = {}
    app = typer.Typer()
    app.command(context_settings=getattr(module, "CONTEXT", None))(as_verb(verb, command))
    main = get_command(app)
    options = {one.name: one for one in main.params if one.param_type_name == "option"}
    plain = [ONE for one in main.params if one.param_type_name == "argument" and one.required]
    plain += ["--out", str(tmp_path / "out")] if "out" in options else []

    needed = {one.opts[0]: "a=1" for one in options.values() if one.required}

    def given(*arguments):
        more = [word for flag, word in needed.items() if flag not in arguments for word in (flag, word)]
        main(args=[*plain, *more, *arguments], standalone_mode=False)
        return taken

    own = evaluated(module.command).parameters
    for name, option in options.items():
        assert not re.search(r"(?i)default: (\S+); \1 ", option.help or ""), name
        if option.multiple:
            flag = option.opts[0]
            usual = ("a=1", "b=2") if flag in needed else "ab"
            first, second, *_ = (name in own and kind_of(own[name]).choices) or usual
            assert given(flag, f"{first}, {second}")[name] == [first, second]
            assert given(flag, first, flag, second)[name] == [first, second]
            assert given(flag, "")[name] == [] and option.help.endswith("with commas, or the option again.")
    if "elements" in options and verb != "transfer":  # squares
        assert given("--elements", "8x4")["elements"] == "8x4"


def test_scenes_of_the_catalogue_are_copied(kept):
    assert {row["name"] for row in kept("check catalogue").document["scenes"]} == set(catalogue())
    copied = kept("check catalogue").folder / "one-edge-clamped.toml"
    assert sb.load(copied) == sb.load("one-edge-clamped")
    assert sb.load(kept("check").folder / "two-edges-clamped.toml") == sb.load("two-edges-clamped")


# ---- names of choices
def test_every_name_is_there_and_described():
    assert lumped.CALIBRATIONS is choices.CALIBRATIONS
    assert set(lumped.INTEGRATORS) == set(choices.INTEGRATORS)
    given, more = get_args(lumped.Inertia)
    assert {*get_args(given), *get_args(more)} == set(choices.MASS_DISTRIBUTIONS)
    assert list(fem_reference.MODELS) == list(choices.REFERENCES)
    assert set(MAKERS) == set(choices.CALIBRATIONS)
    for name, make in MAKERS.items():
        assert choices.CALIBRATIONS[name].fitted == ("targets" in signature(make).parameters)


def test_the_usual_choices_are_those_of_the_functions():
    assert signature(lumped.calibrate).parameters["method"].default == choices.CALIBRATION
    assert signature(lumped.simulate).parameters["integrator"].default == choices.INTEGRATOR == choices.AUTO
    assert signature(fem_reference.solve).parameters["model"].default == choices.REFERENCE


NAMES = {
    "calibration": choices.CALIBRATIONS,
    "reference": choices.REFERENCES,
    "masses": choices.MASS_DISTRIBUTIONS,
    "integrator": choices.INTEGRATORS,
}


@pytest.mark.parametrize("verb", ["compare", "calibrate", "identify", "modes", "simulate", "tradeoff"])
def test_help_names_every_choice(verb):
    known = [(one.help, NAMES[one.name]) for one in verb_group().commands[verb].params if one.name in NAMES]
    assert known and all(name in said for said, names in known for name in names)
