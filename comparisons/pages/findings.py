"""What a study found, in sentences with units: a few of our own from its document, then what it says
itself."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable, Mapping
from math import pi
from typing import Any

from comparisons.pages.asked import short
from comparisons.pages.studies import Study
from sheetbench.answers.table import number

Document = Mapping[str, Any]
TOLERANCES = (0.05, 0.01, 0.001)


def findings(study: Study) -> list[str]:
    """Sentences on a study's answer."""
    say = SAID.get(study.verb)
    own = study.of_document(say) if say else None
    told = study.document.get("findings")
    rows = told if isinstance(told, list) and study.verb != "reproduce" else []
    listed = [str(one["finding"]) for one in rows if isinstance(one, dict) and one.get("finding")]
    return [*(own or []), *listed]


def notes(study: Study) -> list[str]:
    """What the run says of its own tables."""
    return _joined(study.words.get("notes") or texts(study.document.get("notes")))


def complaints(study: Study) -> list[str]:
    """What went wrong, and what is doubtful about the scene."""
    found = [*study.words.get("complaints", ()), *texts(study.document.get("warnings"))]
    return list(dict.fromkeys(found))


def texts(value: Any) -> list[str]:
    """The texts of a document's list; none where it is something else."""
    return [str(one) for one in value] if isinstance(value, list) else []


def _joined(notes: Iterable[str]) -> list[str]:
    """The notes on one line each; one that ends in a colon with what follows it."""
    found: list[str] = []
    for note in (" ".join(note.split()) for note in notes):
        if found and found[-1].endswith(":"):
            found[-1] += f" {note}"
        else:
            found.append(note)
    return found


def _milliseconds(seconds: float) -> str:
    return f"{number(1e3 * seconds, '.3g')} ms" if seconds < 1 else f"{number(seconds, '.3g')} s"


def _percent(share: float) -> str:
    """Two digits at least, and never an exponent."""
    percent = 100 * share
    return f"{number(percent, '.0f' if abs(percent) >= 99.5 else '.2g')} %"


def _compare(document: Document) -> list[str]:
    solutions = {one["model"]: one for one in document["solutions"]}
    said = []
    for error in document.get("errors", ()):
        model, truth = solutions[error["of"]], solutions[error["against"]]
        largest = max(abs(u) for moved in truth["probes"].values() for u in moved)
        if error["error"] is None:
            continue
        said.append(
            f"{model['label']} is off by {_percent(error['error'])} of the largest displacement, "
            f"{number(1e3 * largest, '.3g')} mm, from {truth['label']}; it was solved in "
            f"{_milliseconds(model['solve_seconds'])}, the reference in "
            f"{_milliseconds(truth['solve_seconds'])}."
        )
    return said


def _modes(document: Document) -> list[str]:
    pairs = [pair for pair in document.get("pairs", ()) if pair["relative"] is not None]
    worst = max(pairs, key=lambda pair: abs(pair["relative"]), default=None)
    said = (
        []
        if worst is None
        else [
            f"Frequencies of {len(pairs)} pairs of modes of one shape differ by "
            f"{_percent(abs(worst['relative']))} at most, in mode {worst['number']}."
        ]
    )
    return said + [
        f"{one['label']}: the lowest frequency is {number(one['frequencies_hz'][0], '.4g')} Hz."
        for one in document["solutions"]
        if one["frequencies_hz"]
    ]


def _simulate(document: Document) -> list[str]:
    ends = {probe: u[-1] for probe, u in document["probes"].items() if u}
    far, moved = max(ends.items(), key=lambda item: max(map(abs, item[1])))
    return [
        f"{document['label']}, {document['integrator']}: {document['steps']} steps to "
        f"{number(document['time'][-1], '.4g')} s in {_milliseconds(document['solve_seconds'])}.",
        f"{far} ends farthest out, at {', '.join(number(1e3 * u, '.3f') for u in moved)} mm.",
    ]


def _calibrate(document: Document) -> list[str]:
    springs = document["springs"]
    shown = ", ".join(
        f"{name.replace('_', ' ')} {number(value, '.4g')}"
        for name, value in springs.items()
        if isinstance(value, int | float) and name in ("axial", "diagonal", "vertical", "cross")
    )
    worst = max(document["moduli"], key=lambda one: abs(one["miss"] or 0.0))
    said = [f"Spring constants of {document['method']}: {shown} N/m."] if shown else []
    met = f"{worst['name']} is missed most, by {_percent(abs(worst['miss'] or 0.0))}"
    return [*said, "Every modulus is met." if abs(worst["miss"] or 0.0) < 1e-9 else f"{met}."]


def _tradeoff(document: Document) -> list[str]:
    """The cheapest row within every tolerance that one meets, then the nearest of all."""
    moving = "lowest_period" in document
    rows = [row for row in document["rows"] if row.get("error") is not None]
    if not rows:
        return [f"None of {len(document['rows'])} runs has an error to show."]

    def seconds(row: Mapping[str, Any]) -> float:
        return float(row["seconds_per_second"] if moving else row["solve_seconds"]["median"])

    def named(row: Mapping[str, Any]) -> str:
        of = f"{row['integrator']} with steps of {_milliseconds(row['step'])}" if moving else row["label"]
        cost = f"{_milliseconds(seconds(row))}{' a simulated second' if moving else ''}"
        return f"{of}, {_percent(row['error'])} off in {cost}"

    said, least = [], None
    for tolerance in TOLERANCES:
        within = [row for row in rows if row["error"] <= tolerance]
        cheapest = min(within, key=seconds, default=None)
        if cheapest is not None and cheapest is not least:
            said.append(f"Cheapest within {_percent(tolerance)}: {named(cheapest)}.")
            least = cheapest
    nearest = min(rows, key=lambda row: float(row["error"]))
    return said if nearest is least else [*said, f"Nearest to the reference: {named(nearest)}."]


def _linearise(document: Document) -> list[str]:
    poles = [complex(re, im) for re, im in document["poles"]]
    said = [f"{len(poles)} poles of {document['unknowns']} unknowns, {document['label']}."]
    swinging = [pole for pole in poles if pole.imag > 0.0]
    if swinging:
        lowest = min(swinging, key=abs)
        said.insert(
            0,
            f"The lowest mode swings at {number(abs(lowest) / (2 * pi), '.4g')} Hz with "
            f"{_percent(-lowest.real / abs(lowest))} of critical damping.",
        )
    return said


def _identify(document: Document) -> list[str]:
    said = []
    for name, found in document["unknowns"].items():
        interval = [number(one, ".4g") for one in found["interval"] or () if one is not None]
        within = f", 95 % within {' to '.join(interval)}" if len(interval) == 2 else ""
        said.append(f"{name.replace('_', ' ')} = {number(found['value'], '.4g')}{within} (SI units).")
    return said


def _stability(document: Document) -> list[str]:
    counted = Counter(str(row["status"]) for row in document["rows"])
    parts = ", ".join(f"{count} {status}" for status, count in counted.most_common())
    return [f"{len(document['rows'])} runs: {parts}."]


def _advise(document: Document) -> list[str]:
    chosen, predicted = document.get("choice"), document.get("predicted") or {}
    if not chosen:
        return [str(document.get("message") or "No model tried meets the tolerance.")]
    return [
        f"Within {_percent(document['tolerance'])}, {chosen['model']} "
        f"({', '.join(f'{k} {short(v)}' for k, v in chosen['settings'].items())}) is cheapest: predicted "
        f"{_percent(predicted['error'])} off in {_milliseconds(predicted['solve_seconds'])}."
    ]


def _verify(document: Document) -> list[str]:
    rows = document["rows"]
    failed = [row for row in rows if not row["passed"]]
    names = "; ".join(f"{row['case']}, {row['quantity']}" for row in failed[:5])
    return [f"{len(rows) - len(failed)} of {len(rows)} rows pass." + (f" Not: {names}." if failed else "")]


def _reproduce(document: Document) -> list[str]:
    return [f"{one['about'].capitalize()}: {one['finding']}" for one in document["findings"]]


def _score(document: Document) -> list[str]:
    worst = max(document["cases"], key=lambda case: case["error"])
    said = [
        f"A score of {_percent(document['score'])}; the worst case is {worst['case']}, "
        f"{_percent(worst['error'])} off."
    ]
    models = [one["model"] for one in document["standing"]]
    if len(models) > 1:
        said.append(f"Of {len(models)} models on these cases it is number {models.index('answers') + 1}.")
    return said


def _crosscheck(document: Document) -> list[str]:
    pairs = document["pairs"]
    apart = [pair for pair in pairs if pair["apart"]]
    said = [f"{len(pairs) - len(apart)} of {len(pairs)} pairs of models agree within their error bars."]
    if apart:
        worst = max(apart, key=lambda pair: pair["difference"])
        said.append(
            f"Farthest apart are {worst['a']} and {worst['b']} on {worst['scene']}, by "
            f"{_percent(worst['difference'])}."
        )
    return said if pairs else []


SAID: dict[str, Callable[[Document], list[str]]] = {
    "compare": _compare,
    "modes": _modes,
    "simulate": _simulate,
    "calibrate": _calibrate,
    "tradeoff": _tradeoff,
    "linearise": _linearise,
    "identify": _identify,
    "stability": _stability,
    "advise": _advise,
    "verify": _verify,
    "reproduce": _reproduce,
    "score": _score,
    "crosscheck": _crosscheck,
}
