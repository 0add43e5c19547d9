"""What every run must keep to: its exit status, its words, its numbers, its folder."""

import contextlib
import io
import json
import math
import os
import sys
import traceback
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.cli import main

DONE, BAD_INPUT, NOT_CONVERGED = 0, 2, 3
LONGEST = 400  # characters of a refusal with its paths


@dataclass(frozen=True)
class Outcome:
    status: object
    out: str
    err: str


def outcome(arguments: Sequence[str], folder: Path) -> Outcome:
    """A command carried out in this process, in a folder of its own; terminal and pipe as for a program."""
    out, err = io.StringIO(), io.StringIO()
    before, status = Path.cwd(), 0
    os.chdir(folder)
    try:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err), warnings.catch_warnings():
            warnings.simplefilter("default")
            try:
                main(list(arguments))
            except SystemExit as leaving:
                status = leaving.code or 0
            except BaseException:
                traceback.print_exc(file=sys.stderr)
                status = 1
    finally:
        os.chdir(before)
    return Outcome(status, out.getvalue(), err.getvalue())


def held(found: Outcome, about: object) -> None:
    """The documented statuses, no traceback; a refusal in one line at the end; no raw control characters."""
    said = f"{about!r} → {found.status}\n{found.out[-2000:]}\n{found.err[-6000:]}"
    assert found.status in (DONE, BAD_INPUT, NOT_CONVERGED), said
    assert "Traceback" not in found.out + found.err, said
    if found.status == BAD_INPUT:
        last = found.err.rstrip("\n").rpartition("\n")[2]
        assert last.strip() and len(last) <= LONGEST, said
        assert not found.out, said
    for text in (found.out, found.err):
        assert not any((c < " " and c not in "\n\t\r") or "\x7f" <= c < "\xa0" for c in text), said


def document(found: Outcome) -> Any:
    """The JSON document of a run that has one; every number in it is finite."""

    def refuse(word: str) -> None:
        raise AssertionError(f"{word} in {found.out[:2000]}")

    return json.loads(found.out, parse_constant=refuse)


def in_balance(answer: dict[str, Any], summed: bool = True) -> None:
    """What is called converged is in balance, by its own word and, summed, by that of reactions and loads.

    The sum is taken from the document alone: weight of the sheet, its payloads and chains, points, edges;
    where a pressure follows the sheet its own word must do.
    """
    scene = answer["scene"]
    for solution in answer["solutions"]:
        if solution["status"] != "converged":
            continue
        about = json.dumps({"scene": scene, "solution": solution})
        assert solution["balance"] is None or solution["balance"]["holds"], about
        assert solution["probes"] and None not in np.ravel(list(solution["probes"].values())).tolist(), about
        if not summed or any(load["kind"] == "pressure" for load in scene["load"]):
            continue
        carried = [np.array(force, float) for force in solution["reactions"].values()]
        loads = applied(scene)
        left = sum(carried, np.zeros(3)) + sum(loads, np.zeros(3))
        size = sum(np.abs(force).sum() for force in [*carried, *loads])
        rounding = 1e-12 * scene["material"]["young"] * scene["sheet"]["thickness"] * max(length_of(scene))
        assert np.abs(left).max() <= 1e-6 * size + rounding, (left, about)


def length_of(scene: dict[str, Any]) -> tuple[float, float]:
    return scene["sheet"]["length_x"], scene["sheet"]["length_y"]


def applied(scene: dict[str, Any]) -> list[np.ndarray]:
    """Dead forces [N] on the sheet of a scene's document, histories at their last factor."""
    sheet, gravity = scene["sheet"], scene.get("gravity")
    length = {axis: sheet[f"length_{'y' if axis == 'x' else 'x'}"] for axis in "xy"}  # of the edge x0, y0, …
    forces = []
    if gravity:
        mass = scene["material"]["density"] * math.prod(
            sheet[f"{key}"] for key in ("length_x", "length_y", "thickness")
        )
        mass += sum(payload["mass"] for payload in scene["mass"])
        for rod in scene["actuator"]:
            if "line_density" in rod:
                mass += rod["line_density"] * length[rod["edge"][0]]
        forces.append(mass * last(gravity) * np.array(gravity["acceleration"]))
    for load in scene["load"]:
        if load["kind"] == "point":
            forces.append(last(load) * np.array(load["force"]))
        elif load["kind"] == "edge":
            forces.append(last(load) * length[load["edge"][0]] * np.array(load["force_per_length"]))
    return forces


def last(loading: dict[str, Any]) -> float:
    history = loading.get("history")
    return float(history["factor"][-1]) if history else 1.0


def files(folder: Path) -> set[str]:
    return {str(path.relative_to(folder)) for path in folder.rglob("*") if not path.is_dir()}
