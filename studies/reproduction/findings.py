"""What the printed errors, the inputs and the nearest sheets say of the published tables."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import degrees

import numpy as np

from comparisons.reproduction.findings import Finding
from comparisons.reproduction.published import COMPONENTS, published
from sheetbench.answers.table import number, percent, quantity
from sheetbench.scenes.habibi import PROBES, published_inputs
from studies.reproduction.chords import Chord, nearer
from studies.reproduction.inputs import Check
from studies.reproduction.nearest import LAYERS, MOST, NEAR, SQUARES, YOUNG, Fit
from studies.reproduction.printed_errors import Cell, means
from studies.reproduction.ratios import Ratio

RODS = {0: "", 1: " with the rod's ends up", -1: " with the rod's ends down"}
KINDS = {
    "sheet": "plate of the published thickness and Poisson's ratio",
    "lattice": "lattice of equal springs",
}
SYMBOLS = {"young": ("E", "Pa"), "k": ("k", "N/m"), "layer_distance": ("lz", "m"), "curvature": ("κ", "1/m")}


def millimetres(length: float, form: str = ".2f") -> str:
    """Return a length [m]."""
    return quantity(length, "m", form)


def of_errors(cells: Sequence[Cell]) -> Iterator[Finding]:
    """What the printed errors are relative to."""
    if not cells:
        return
    mean, quoted = means(list(cells)), published_inputs()["mean_error"]
    explained = [cell for cell in cells if cell.by_larger]
    cut = sum(cell.digits == "cut off" for cell in explained)
    changed = sum(cell.changes for cell in cells)
    yield Finding(
        "printed errors",
        f"{len(explained)} of {len(cells)} printed errors are the difference over the larger of the two "
        f"values, {cut} of them cut off instead of rounded. {changed} are therefore relative to the model "
        f"and not to the experiment; relative to the experiment throughout their mean is "
        f"{percent(mean['of_experiment'], '.2f')}.",
    )
    yield Finding(
        "printed errors",
        f"The printed errors have a mean of {percent(mean['printed'], '.2f')}; {percent(quoted)} is quoted.",
    )


def of_inputs(checks: Sequence[Check]) -> Iterator[Finding]:
    """Which published inputs do not follow from the others."""
    if not checks:
        return
    given = published_inputs()
    for check in checks:
        if check.what == "equations" and not check.agrees:
            yield Finding(
                "inputs",
                f"{check.printed:g} equations are printed; {check.follows} are {check.computed:g}.",
            )
    formulas = [check for check in checks if check.what == "k"]
    nearest = min(formulas, key=lambda check: abs(np.log(check.computed / given["k"])))
    yield Finding(
        "inputs",
        f"None of {len(formulas)} usual formulas gives k = {given['k']:g} N/m; the nearest, "
        f"{nearest.follows}, gives {nearest.computed:.0f} N/m.",
    )
    distance = next(check for check in checks if check.what == "layer distance").computed
    yield Finding(
        "inputs",
        "The distance of the layers is not published. With the published k a lattice bends like the "
        f"published sheet where it is {millimetres(distance, '.3g')}, {distance / given['thickness']:.1f} "
        "times the thickness.",
    )


def of_fits(fits: Sequence[Fit]) -> Iterator[Finding]:
    """How near the nearest sheets of each kind are."""
    for kind, of in dict.fromkeys((fit.kind, fit.tests) for fit in fits):
        alike = [fit for fit in fits if (fit.kind, fit.tests) == (kind, of)]
        best = min((fit for fit in alike if fit.by == SQUARES), key=lambda fit: fit.rms)
        test = f"Test {of[0]}" if len(of) == 1 else "Both tests together"
        rod = "" if "curvature" in best.sought else RODS[best.sense]
        none = "" if best.matches.sum() == best.entries else f"no {KINDS[kind]} that was tried has all of the"
        first = f"{none} published {best.source}'s entries. " if none else ""
        yield Finding(
            "nearest",
            f"{test}: {first}The nearest to the published {best.source} "
            f"({_values(best)}{rod}) "
            f"differs by {percent(best.rms)} of the largest displacement (root mean square), by "
            f"{percent(best.error)} at most, and has {int(best.matches.sum())} of {best.entries} entries "
            f"within {percent(NEAR)}.",
        )
        most = max((fit for fit in alike if fit.by == MOST), key=lambda fit: int(fit.matches.sum()))
        if most.matches.sum() > best.matches.sum():
            rest = " and k as published" if kind == "lattice" else ""
            yield Finding(
                "nearest",
                f"{test}: with {_values(most)}{rest}{RODS[most.sense]} a {kind} has "
                f"{int(most.matches.sum())} of {most.entries} entries within {percent(NEAR)}, but "
                f"not {_missed(most)}.",
            )


def of_senses(fits: Sequence[Fit]) -> Iterator[Finding]:
    """Which sense of the rod's curvature the tables are of."""
    if not fits:
        return
    table = published(2, "model")
    rise = [millimetres(table[j, 2] - table[i, 2]) for i, j in ((0, 1), (2, 3))]
    sentences = []
    for kind in KINDS:
        of_rod = [f for f in fits if f.tests == (2,) and f.kind == kind and "curvature" not in f.sought]
        up, down = (min(f.rms for f in of_rod if f.sense == sense) for sense in (1, -1))
        sentences.append(f"{kind} {percent(up)} with the ends up, {percent(down)} down")
    yield Finding(
        "sense of curvature",
        f"The published model has the side {rise[0]} above the middle half-way (P2 over P1) and {rise[1]} at "
        "the free edge (P4 over P3), as a rod whose ends are up would lift it. The least misfit with the "
        f"published curvature, root mean square of the largest displacement: {'; '.join(sentences)}.",
    )


def of_ratios(ratios: Sequence[Ratio]) -> Iterator[Finding]:
    """Which published ratios no sheet of a scan has."""
    for kind, test, sense in dict.fromkeys((r.kind, r.test, r.sense) for r in ratios):
        of = [r for r in ratios if (r.kind, r.test, r.sense) == (kind, test, sense)]
        never = [
            f"{r.name} is {number(r.published['model'], '.3g')} in the model and "
            f"{number(r.published['experiment'], '.3g')} in the experiment, {number(r.least, '.3g')} to "
            f"{number(r.most, '.3g')} there"
            for r in of
            if r.least is not None and r.most is not None and not any(map(r.met, r.published))
        ]
        if never:
            yield Finding(
                "ratios",
                f"Test {test}{RODS[sense]}: {len(never)} of {len(of)} published ratios are those of none of "
                f"the {_scanned(kind)}: {'; '.join(never)}.",
            )


def of_stretch(chords: Sequence[Chord], fits: Sequence[Fit]) -> Iterator[Finding]:
    """Which published distances stretch any sheet."""
    lines = [chord for chord in chords if chord.stretch > 0.0]
    for test, source in dict.fromkeys((chord.test, chord.source) for chord in lines):
        worst = max((c for c in lines if (c.test, c.source) == (test, source)), key=lambda c: c.stretch)
        longest = max(0.0, *(-closer / worst.flat for closer in _nearer(fits, worst)))
        held = "" if worst.start in PROBES else " where the edge is in its place"
        yield Finding(
            "stretch",
            f"Test {test}, published {source}: {worst.start} and {worst.end} are "
            f"{millimetres(worst.published)} apart, {millimetres(worst.flat)} on the flat sheet. Whatever "
            "the sheet is made of, the line between them is stretched by "
            f"{percent(worst.stretch)} at least{held}. In the nearest sheets and lattices the two are "
            f"farther apart by {percent(longest)} at most.",
        )


def of_shortening(chords: Sequence[Chord], fits: Sequence[Fit]) -> Iterator[Finding]:
    """How much a sheet must turn to bring points as near as published."""
    between = [chord for chord in chords if chord.start in PROBES]
    for source in dict.fromkeys(chord.source for chord in between):
        worst = max((c for c in between if c.source == source), key=lambda c: c.turning)
        yield Finding(
            "shortening",
            f"Test {worst.test}, published {source}: {worst.start} and {worst.end} are "
            f"{millimetres(worst.flat - worst.published, '.1f')} nearer to each other than on the flat "
            "sheet. Unless it is compressed, the line between them has directions that span "
            f"{degrees(worst.turning):.0f}° at least. In the nearest sheets and lattices they are so by "
            f"{millimetres(max(0.0, *_nearer(fits, worst)), '.1f')} at most.",
        )


def _nearer(fits: Sequence[Fit], chord: Chord) -> list[float]:
    """By how much [m] the chord's points are nearer to each other in each sheet of the least misfit; of an
    edge's points in those alone whose supports are not turned."""
    return [
        nearer(chord, _of_test(fit, chord.test))
        for fit in fits
        if chord.test in fit.tests
        and fit.by == SQUARES
        and (chord.start in PROBES or "tilt" not in fit.sought)
    ]


def _of_test(fit: Fit, test: int) -> np.ndarray:
    """The displacements (4, 3) [m] of one of its tests."""
    first = fit.tests.index(test) * len(PROBES)
    return fit.displacement[first : first + len(PROBES)]


def _values(fit: Fit) -> str:
    """What was found for what was sought."""
    texts = []
    for name, value in fit.sought.items():
        if name == "tilt":
            texts.append(f"supports turned by {number(degrees(value), '.2g')}°")
        else:
            symbol, unit = SYMBOLS[name]
            texts.append(f"{symbol} = {quantity(value, unit, '.3g')}")
    return ", ".join(texts)


def _missed(fit: Fit) -> str:
    """The published entries that a sheet has not, by test."""
    missing = fit.missed
    texts = []
    for i, test in enumerate(fit.tests):
        rows = range(i * len(PROBES), (i + 1) * len(PROBES))
        names = [
            f"{component}({probe})"
            for row, probe in zip(rows, PROBES, strict=True)
            for axis, component in enumerate(COMPONENTS)
            if missing[row, axis]
        ]
        if names:
            texts.append(", ".join(names) + (f" of test {test}" if len(fit.tests) > 1 else ""))
    return " and ".join(texts)


def _scanned(kind: str) -> str:
    """The sheets of a scan."""
    given = published_inputs()
    if kind == "sheet":
        low, high = (quantity(given["young"] * factor, "Pa", ".3g") for factor in (YOUNG[0], YOUNG[-1]))
        return f"plates of {low} to {high}"
    low, high = (millimetres(given["thickness"] * factor, ".3g") for factor in (LAYERS[0], LAYERS[-1]))
    return f"lattices of the published k with layers {low} to {high} apart"
