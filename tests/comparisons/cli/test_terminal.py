"""What people see on a terminal: every verb there as well as in a pipe."""

import io
import json
import re
from collections import Counter
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import terminals
from commands import run
from rich.console import Console
from terminals import CONTROL, Terminal
from verbs import SMALL, write_inputs

from comparisons.cli import characters, console
from comparisons.cli.app import VERBS, verb_group
from comparisons.runs.campaign import Progress


@pytest.mark.parametrize(
    ("encoding", "text", "printed"),
    [
        ("ascii", "ν = 0.48, κ₀ −1.5e−3 ± 2 %, 9 × 9", "nu = 0.48, kappa0 -1.5e-3 +- 2 %, 9 x 9"),
        ("ascii", "ρ² m⁻¹ Σ ½ é ω̇ │─┼ …", "rho^2 m^-1 Sigma 1/2 e omega |-+ ..."),
        ("latin-1", "µ ± ² × é −", "µ ± ² × é -"),
        ("utf-8", "ν ω̇ ❤", "ν ω̇ ❤"),
        ("ascii", "❤", "?"),
    ],
)
def test_what_an_encoding_lacks_is_spelled(encoding, text, printed):
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    characters.adapt(stream)
    stream.write(text)
    stream.flush()
    assert stream.buffer.getvalue().decode(encoding) == printed == characters.spelled(text, encoding)


@pytest.mark.parametrize("width", [50, 80, 160])
def test_a_campaigns_bar_stands_before_its_first_run_is_done(monkeypatch, width):
    screen = io.StringIO()
    monkeypatch.setattr(console, "err", Console(file=screen, force_terminal=True, width=width))
    with console.campaign_progress() as progress:
        progress(Progress(1, 3, "shell [2]", "converged", None))
        progress(Progress(3, 3, "shell [4]", "converged", 0.0))
    assert "starting" in screen.getvalue() and "3/3" in screen.getvalue() and "shell [4]" in screen.getvalue()


WIDE = 400  # columns, where nothing has to give way
WAYS: dict[str, tuple[int, dict[str, str], str]] = {
    "50": (50, {}, "utf-8"),
    "160, no colour": (160, {"NO_COLOR": "1"}, "utf-8"),
    "80, ASCII": (80, {"NO_COLOR": "1"}, "ascii"),
}
FIGURES: dict[str, Callable[[Any], list[float]]] = {
    "compare": lambda d: [u for one in d["solutions"] for u in one["probes"]["P4"]],
    "calibrate": lambda d: [d["springs"]["axial"], d["springs"]["vertical"], d["layer_distance"]],
    "identify": lambda d: [d["unknowns"]["young"]["value"], *d["unknowns"]["young"]["interval"]],
    "tradeoff": lambda d: [row["error"] for row in d["rows"]],
    "modes": lambda d: [f for one in d["solutions"] for f in one["frequencies_hz"]],
    "verify": lambda d: [row["computed"] for row in d["rows"] if abs(row["computed"]) > 1e-3],
    "advise": lambda d: [d["predicted"]["error"]],
}  # the main figures of a document
SCALES = (1.0, 1e2, 1e3, 1e6, 1e-3, 1e-6)  # of shown units

Screens = dict[tuple[str, str], tuple[int, str, str]]


@pytest.fixture(scope="module")
def screens(tmp_path_factory):
    """(verb, way) → exit status, standard output and standard error, of every verb in every way."""
    folder = tmp_path_factory.mktemp("terminal")
    write_inputs(folder)
    cases = []
    for verb, arguments in SMALL.items():
        if verb in FIGURES:  # first, so that no way pays for the compiling
            cases.append([[verb, "json"], [*arguments, "--json"], 80, {}, "utf-8"])
        ways = {"wide": (WIDE, {}, "utf-8"), **WAYS}
        for way, (columns, environment, encoding) in ways.items():
            fresh = [f"new-{len(cases)}.toml" if part == "new.toml" else part for part in arguments]
            cases.append([[verb, way], fresh, columns, environment, encoding])
    asked, answered = folder / "cases.json", folder / "screens.json"
    asked.write_text(json.dumps(cases), encoding="utf-8")
    driver = Path(terminals.__file__).with_name("terminal_driver.py")
    code = f"import os, runpy, sys; os.chdir({str(folder)!r}); sys.path.insert(0, {str(driver.parent)!r}); "
    code += f"runpy.run_path({str(driver)!r}, run_name='__main__')"
    terminal = Terminal(code, str(asked), str(answered))
    assert terminal.end() == 0, terminal.shown
    found = json.loads(answered.read_text(encoding="utf-8"))
    return {tuple(name): (status, CONTROL.sub("", out), err) for name, status, out, err in found}


@pytest.mark.parametrize("verb", ["check", "advise"])
def test_a_command_to_copy_is_one_line(screens, verb):
    command = screens[verb, "50"][1].partition("Solve it with:")[2].strip()
    assert command.startswith(f"sheetbench compare {SMALL[verb][1]}") and "\n" not in command


def numbers(text):
    """The numbers of a text as they are printed, but for powers and halves, which are one sign elsewhere."""
    plain = text.replace("−", "-").replace("1/2", "½")
    return re.findall(r"(?<!\^)-?\d+(?:\.\d+)?(?:e[-+]?\d+)?", plain)


def test_every_verb_is_tried():
    assert set(SMALL) == set(VERBS) - {"live"}  # which ends by Ctrl-C alone: test_live.py


@pytest.mark.parametrize("width", [50, 80, 160])
@pytest.mark.parametrize("verb", VERBS)
def test_a_help_page_cuts_nothing_off(monkeypatch, capsys, verb, width):
    monkeypatch.setenv("COLUMNS", str(width))
    monkeypatch.setattr("typer.rich_utils.MAX_WIDTH", width)  # as it reads the variable where it is imported
    assert run(verb, "--help") == 0
    page = capsys.readouterr().out
    assert "--help" in page and "…" not in page.replace("N,N,…", "")


@pytest.mark.parametrize("verb", VERBS)
def test_a_help_page_keeps_its_brackets(verb):
    command = verb_group().commands[verb]
    for text in (command.help, *(getattr(option, "help", None) for option in command.params)):
        assert not re.search(r"(?<!\\)\[[a-z/@#]", text or "", re.IGNORECASE)  # it would be rich's markup


@pytest.mark.parametrize("way", ["wide", *WAYS])
@pytest.mark.parametrize("verb", SMALL)
def test_a_verb_on_a_terminal_ends_well(screens, verb, way):
    status, out, err = screens[verb, way]
    assert status == 0, f"{out}\n{err}"
    assert "Traceback" not in out + err
    if way in WAYS and "NO_COLOR" in WAYS[way][1]:
        assert "\x1b[3" not in err  # no colours


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("verb", SMALL)
def test_no_number_is_cut(screens, verb, way):
    whole, shown = (Counter(numbers(screens[verb, one][1])) for one in ("wide", way))
    if verb not in ("new", "advise"):  # a file's name, times that decide what is tried
        assert not whole - shown and not set(shown) - set(whole)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("verb", FIGURES)
def test_the_main_figures_are_shown(screens, verb, way):
    figures = FIGURES[verb](json.loads(screens[verb, "json"][1]))
    printed = [(float(n), 0.51 * 10.0 ** _last_digit(n)) for n in numbers(screens[verb, way][1])]
    for figure in figures:
        assert any(abs(scale * figure - n) <= digit for scale in SCALES for n, digit in printed), figure


def _last_digit(number):
    """The power of ten of a printed number's last digit."""
    mantissa, _, exponent = number.partition("e")
    return int(exponent or 0) - len(mantissa.partition(".")[2])
