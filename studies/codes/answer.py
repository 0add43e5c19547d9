"""Answer of the study: codes with numbers in use and with ours, the front of error and cost, every row."""

from collections.abc import Iterable
from dataclasses import dataclass
from statistics import geometric_mean
from typing import Annotated, Any

import matplotlib
from matplotlib.figure import Figure

from sheetbench.answers.answer import Answer
from sheetbench.answers.figure_style import PLAIN, FigureStyle
from sheetbench.answers.files import digest
from sheetbench.answers.report import Picture
from sheetbench.answers.style import DARK
from sheetbench.answers.table import NUMBER, PERCENT, SECONDS, Column, Table, number, percent
from studies.codes.results import CASES, OURS, SCENES, CodeResults, Trial, every_result

LEFT_OUT = (
    "Not run, for want of a wheel: SOFA, ArcSim, Codim-IPC, ppf-contact-solver, OpenUSD's proposal; of "
    "MATLAB's and Octave's ode15s the lattice would have to be written again in their language."
)


@dataclass(frozen=True)
class LeastErrors:
    """Least errors of a code with the numbers in use and with ours, in one scene or as geometric mean over
    scenes."""

    code: Annotated[str, Column(prose=True)]
    scene: str
    in_use: Annotated[float, PERCENT(".1f", "best in use")]
    ours: Annotated[float, PERCENT(".1f")]

    @property
    def nearer(self) -> Annotated[float, NUMBER(".1f", "times as near")]:
        """Error with the best numbers in use over the error with ours."""
        return self.in_use / self.ours


@dataclass(frozen=True)
class Front:
    """A row on the front: no other has both less time and less error."""

    scene: str
    code: Annotated[str, Column(prose=True)]
    recipe: str
    error: Annotated[float, PERCENT(".2g")]
    seconds: Annotated[float, SECONDS(".3g", "time")]


@dataclass(frozen=True)
class SceneRow:
    """Error and time of a scene by recipe, as text."""

    scene: str
    recipes: dict[str, str]


@dataclass(frozen=True, repr=False)
class Codes(Answer):
    """Results of every file."""

    results: tuple[CodeResults, ...]

    file_name = "codes"

    def heading(self) -> tuple[str, str, str]:
        return "Codes", "error and time of other people's codes and of our models, on the reference set", ""

    def document(self) -> dict[str, Any]:
        return {"nearer": [{**vars(one), "nearer": one.nearer} for one in self.least_errors()]}

    def least_errors(self) -> list[LeastErrors]:
        """Return the rows of codes that have numbers of both kinds."""
        rows = []
        for code in self.results:
            pairs = code.in_use_and_ours()
            rows += [LeastErrors(code.title, scene, *pairs[scene]) for scene in SCENES if scene in pairs]
            if pairs:
                means = map(geometric_mean, zip(*pairs.values(), strict=True))
                rows.append(LeastErrors(code.title, f"mean of {len(pairs)} statics", *means))
        return rows

    def front(self, scene: str) -> list[Front]:
        """Return the rows of a scene that no other row beats in both time and error, the quickest first."""
        kept: list[Front] = []
        for title, row in sorted(self._answered(scene), key=lambda one: one[1].seconds or 0.0):
            assert row.error is not None and row.seconds is not None
            if not kept or row.error < kept[-1].error:
                kept.append(Front(scene, title, row.recipe, row.error, row.seconds))
        return kept

    def _answered(self, scene: str) -> list[tuple[str, Trial]]:
        pairs = [(code.title, row) for code in self.results for row in code.rows]
        return [(title, row) for title, row in pairs if row.scene == scene and row.error is not None]

    def tables(self) -> list[Table]:
        caption, fields = "Numbers in use and ours", ("code", "scene", "in_use", "ours", "nearer")
        front = [row for scene in SCENES for row in self.front(scene)]
        return [
            Table.of(LeastErrors, self.least_errors(), caption, "nearer", fields=fields, grouped=True),
            Table.of(Front, front, "The nearest at which cost", "front", grouped=True),
            *map(_of_code, self.results),
        ]

    def printed(self) -> list[Table]:
        return self.tables()[:2]

    def notes(self) -> tuple[str, ...]:
        about = (
            "Error: the largest difference from the set's converged shell at the probes, of the largest "
            "displacement; time: of a trial the processor's to rest, of our models and of programs in this "
            "process the median solve. Meshes have 8 squares along the shorter side, of curves 4, unless "
            f"others are named. Numbers of `calibrate SCENE --for CODE` are called {OURS}."
        )
        return about, LEFT_OUT

    def figures(self) -> tuple[Picture, ...]:
        return (Picture("codes", f"{__name__}:compose", (self,), f"rows {digest(str(self.results))}"),)


def _of_code(code: CodeResults) -> Table:
    """Return a table of scenes down, recipes across, below each suite the geometric mean."""
    cells = {(row.scene, row.recipe): row for row in code.rows}
    rows = []
    for suite in ("statics", "curves"):
        scenes = dict.fromkeys(row.scene for row in code.rows if CASES[row.scene].suite == suite)
        rows += [SceneRow(s, {name: _cell(cells.get((s, name))) for name in code.recipes}) for s in scenes]
        if len(scenes) > 1:
            means = {name: _mean(code.errors(name, suite).values()) for name in code.recipes}
            rows.append(SceneRow(f"geometric mean, {suite}", means))
    caption = f"{code.licence}; {code.date}, {code.machine}; `{code.command}`"
    return Table.of(SceneRow, rows, code.title, code.code, text=caption)


def _cell(row: Trial | None) -> str:
    if row is None:
        return "not run"
    spent = "" if row.seconds is None else f", {number(row.seconds, '.2g')} s"
    return (row.status if row.error is None else percent(row.error, ".3g")) + spent


def _mean(errors: Iterable[float | None]) -> str:
    numbers = [error for error in errors if error is not None]
    return f"{percent(geometric_mean(numbers), '.3g')} of {len(numbers)}" if numbers else "–"


def codes() -> Codes:
    """Return the results of all files."""
    return Codes(tuple(every_result()))


def compose(answer: Codes, style: FigureStyle = PLAIN) -> Figure:
    """Return error against time of every recipe on both scenes. Dots are our numbers, crosses numbers in use,
    lines models and programs by their size."""
    figure = Figure(figsize=(style.width, 3.6), layout="constrained")
    axes, colours = figure.subplots(1, 2, sharey=True), matplotlib.colormaps["tab20"]
    for axis, scene in zip(axes, SCENES, strict=True):
        for number_, code in enumerate(answer.results):
            rows = [row for row in code.rows if row.scene == scene and row.error is not None]
            is_ladder = not code.in_use_and_ours()
            for ours in (True, False):
                drawn = [row for row in rows if row.recipe.startswith(OURS) is ours]
                values = [row.seconds for row in drawn], [100.0 * (row.error or 0.0) for row in drawn]
                mark = "o" if ours else ".-" if is_ladder else "x"
                label = code.title if axis is axes[0] and ours is not is_ladder else None
                axis.plot(*values, mark, color=colours(number_), ms=4, lw=0.8, label=label)
        axis.set(
            xscale="log", yscale="log", title=scene, xlabel="time of a solve, or of a motion to rest [s]"
        )
    axes[0].set_ylabel("error at the probes [%]")
    for mark, label in (("o", "numbers of sheetbench"), ("x", "numbers in use")):
        axes[0].plot([], [], mark, color=DARK, ms=4, label=label)
    figure.legend(loc="outside lower center", ncols=3, frameon=False, fontsize=6.5)
    return figure
