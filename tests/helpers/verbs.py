"""A small command line of every verb but `live`, its files, and one stored run, laid out at any width."""

import io
import json
import math
from collections.abc import Callable, Iterable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from dataclasses import dataclass
from functools import cached_property
from inspect import signature
from pathlib import Path
from typing import Any

import pytest
from campaigns import FEW, Serial
from commands import run
from matplotlib.figure import Figure
from rich.console import Console

import sheetbench
from comparisons.cli import app, console
from comparisons.cli.app import verb_group
from comparisons.cli.output import Output, OutputOptions
from comparisons.codes import coefficients, setup
from comparisons.pictures import offscreen
from comparisons.stability import extremes
from comparisons.sweep import executors
from comparisons.sweep.campaign import carry_out
from sheetbench.answers.answer import Answer
from sheetbench.answers.figure_style import PLAIN
from sheetbench.answers.files import to_json

MEASURED = "x,y,ux,uy,uz\n0.188,0.188,-0.0004,-0.0004,-0.0135\n0.094,0.094,0,0,-0.00245\n0.1,0.15,,,-0.0075\n"
ANSWERS = "case,probe,ux,uy,uz\n" + "".join(f"thick,P{n},0,0,{-5e-4 * n}\n" for n in (1, 2, 3, 4))
TENSILE = "stretch,force\n" + "".join(
    f"{1 + 0.1 * n},{0.9 * (1 + 0.1 * n - (1 + 0.1 * n) ** -2)}\n" for n in range(16)
)
SEED, SETTLING, ONE = "two-edges-clamped", "two-edges-settling", "one-edge-clamped"
SMALL = {  # the verb, or the verb and what of it
    "new": "new new.toml --clamped x0",
    "check": f"check {SEED}",
    "check catalogue": "check",
    "check schema": "check --schema",
    "compare": f"compare {SEED} --lumped 3 --elements 2",
    "compare motion": f"compare {SETTLING} --lumped 3 --elements 2 --duration 0.004 --no-uncertainty",
    "simulate": f"simulate {SETTLING} --lumped 3 --duration 0.02 --every 0.004",
    "sweep": f"sweep {SEED} --vary sheet.thickness=2mm,3mm --lumped 3 --elements 2 --workers 1",
    "tradeoff": f"tradeoff {SEED} --lumped 3 --plate= --shell 2 --solid= --elements 4 --repeats 1",
    "tradeoff tolerance": f"tradeoff {ONE} --tolerance 0.2",
    "stability": f"stability {SEED} --lumped 3 --elements 2 --vary slenderness --vary time-step --workers 1",
    "crosscheck": f"crosscheck {SEED} --lumped 3,5 --plate= --shell 2,3 --solid= --judges= --workers 1",
    "calibrate": f"calibrate {SEED} --grid 3",
    "calibrate code": f"calibrate {ONE} --for newton",
    "calibrate cell": f"calibrate {SEED} --cell equilateral",
    "identify": f"identify {SEED} --measured measured.csv --lumped 3",
    "identify tensile": "identify --tensile tensile.csv --area 20mm2",
    "modes": f"modes {SEED} --lumped 3 --elements 2 --count 3",
    "modes state-space": f"modes {ONE} --lumped 3 --state-space 3",
    "score": "score answers.csv --case thick",
    "score set": "score --suite modes",
    "verify": "verify --case patch",
    "report": "report stability",
    "study": "study reproduction --part tables --elements 2",
}
WITHOUT_ANSWER = ("new", "report")  # they write a file alone


def write_inputs(folder: Path) -> None:
    """Write what `identify` and `score` read."""
    for name, text in (("measured", MEASURED), ("answers", ANSWERS), ("tensile", TENSILE)):
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")


def in_python(verb: str, words: Iterable[str]) -> Any:
    """Return the document of the verb's function, called with the words of the command line as parsed for the
    terminal."""
    function, command = getattr(sheetbench, verb), verb_group((verb,)).commands[verb]
    parameters = command.make_context(verb, list(words)).params
    known = signature(function).parameters
    taken = {key: value for key, value in parameters.items() if key in known and value != ()}
    return json.loads(to_json(function(**taken).document()))


def values_of(document: Any, left_out: tuple[str, ...], name: str = "") -> Iterator[tuple[str, Any]]:
    """Yield every number and text of a document with the path to it, except below keys with one of these
    words."""
    if isinstance(document, dict):
        for key, value in document.items():
            if not any(word in key for word in left_out):
                yield from values_of(value, left_out, f"{name}.{key}")
    elif isinstance(document, list):
        for i, value in enumerate(document):
            yield from values_of(value, left_out, f"{name}.{i}")
    elif not (isinstance(document, float) and math.isnan(document)):
        yield name, document


def undraw(patch: pytest.MonkeyPatch) -> None:
    """Make pictures empty files."""

    def touch(self: Figure, place: Path | str, *_: Any, **__: Any) -> None:
        Path(place).touch()

    patch.setattr(Figure, "savefig", touch)
    patch.setattr(offscreen, "unavailable_reason", lambda: "not drawn")


def run_here(patch: pytest.MonkeyPatch) -> None:
    """Run campaigns in this process: no worker has to start."""
    patch.setattr(executors, "Processes", Serial)
    patch.setitem(carry_out.__kwdefaults__, "pool", Serial)


def few_runs(patch: pytest.MonkeyPatch) -> None:
    """Run campaigns here, maps with two runs along each axis, limits of codes' meshes on coarse ones."""
    run_here(patch)
    patch.setattr(setup, "limit_errors", lambda scene: coefficients.limit_errors(scene, 2))
    for name, values in FEW.items():
        patch.setattr(extremes, name, values)


@dataclass
class StoredRun:
    """A run of a small command line with --json and --out: its exit status, what it printed, its folder and
    its answer."""

    status: int
    printed: str
    said: str
    folder: Path
    answer: Answer | None

    @cached_property
    def document(self) -> Any:
        return json.loads(self.printed)

    def shown(self, columns: int, encoding: str = "utf-8") -> str:
        """Return the answer as shown on a terminal of so many columns."""
        assert self.answer is not None
        stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding, errors=app.PLAIN)
        with pytest.MonkeyPatch.context() as patch:
            screen = Console(file=stream, force_terminal=True, width=columns, color_system=None)
            patch.setattr(console, "out", screen)
            Output(OutputOptions("any"), {}, None, (PLAIN,))._print(self.answer.report())
        stream.flush()
        return stream.buffer.getvalue().decode(encoding)  # type: ignore[attr-defined]


def keep(name: str, base: Path) -> StoredRun:
    """Run a small command line in a folder that has the inputs; its files go to the folder of its name."""
    words, folder = SMALL[name].split(), base / name
    answers: list[Answer] = []
    show: Callable[..., Any] = Output.show

    def shown(self: Output, answer: Answer, instead: str | None = None) -> Answer:
        answers.append(answer)
        return show(self, answer, instead)  # type: ignore[no-any-return]

    plain = () if name in WITHOUT_ANSWER else ("--json", "--out", str(folder))
    with (
        pytest.MonkeyPatch.context() as patch,
        redirect_stdout(io.StringIO()) as out,
        redirect_stderr(io.StringIO()) as err,
    ):
        patch.chdir(base)
        undraw(patch)
        few_runs(patch)
        patch.setattr(Output, "show", shown)
        status = run(*words, *plain)
    return StoredRun(status, out.getvalue(), err.getvalue(), folder, answers[0] if answers else None)
