"""Models that are programs: any executable that reads a scene's JSON and writes an answer's JSON.

It is named `exec:PATH`, with settings after it: `exec:./mysim:seconds=5,n=9` runs `./mysim --n=9` for
five seconds at most. On standard input it gets the scene, as "scene" in `compare --json` has it, its probes
always there; on standard output it answers with one JSON object:

    status    "converged", or another of `Status`
    probes    {name: [ux, uy, uz]} in metres, of every probe of the scene
    and, if it likes, solve_seconds (else the whole run counts), unknowns, iterations, load_factor, reactions
    {edge: [Fx, Fy, Fz]} of what the scene holds, label, message

Exit status 2 with a line on standard error refuses a scene, as bad input. Any other that is not 0, a signal,
no answer within the time, too much of it, or one that cannot be read is the status `failed` with what
happened: it costs that row and no other. docs/strip.sh is a short one.
"""

from __future__ import annotations

import json
import os
import shutil
from collections.abc import Mapping
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

from comparisons.external import memory
from sheetbench.answers.solution import FieldMesh, Solution, Status
from sheetbench.errors import BadInput, foreign
from sheetbench.process import run
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.quantities import LARGEST
from sheetbench.scenes.objects.supports import named

PREFIX = "exec:"
SETTINGS = {"seconds": 60.0, "memory_mb": None}  # the limits; all others are the program's own
UNLIMITED = 2**40  # MB
SHOWN = 60  # characters of what an answer has in a number's place
REFUSED = 2  # exit status
NUMBERS = ("solve_seconds", "unknowns", "iterations", "load_factor")


class Program:
    """An executable as a model (`comparisons.external.plugins.Model`)."""

    settings = SETTINGS
    takes_any = True  # settings, which are passed on

    def __init__(self, path: str) -> None:
        """Raises BadInput for what is not there or cannot be run."""
        executable = shutil.which(path) or shutil.which(path, path=os.curdir)
        if executable is None:
            there = Path(path).is_file()
            raise BadInput(f"{path}: " + ("not executable, see chmod +x" if there else "no such program"))
        self.path = Path(executable)
        self.name = Path(path).stem

    def digest(self) -> str:
        """Of the program's own file."""
        return sha256(self.path.read_bytes()).hexdigest()

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the program's answer at the probes, none elsewhere. Raises BadInput where it refuses the
        scene, or a limit is not one."""
        seconds, most = _limits(settings)
        own = {key: value for key, value in settings.items() if key not in SETTINGS}
        options = [f"--{key}" if value is True else f"--{key}={written(value)}" for key, value in own.items()]
        question = json.dumps(scene.document()).encode()
        try:
            ended = run([str(self.path.resolve()), *options], question, seconds, most)
        except OSError as error:
            raise BadInput(f"{self.path}: cannot be run: {error.strerror}") from None
        if ended.code == REFUSED and not ended.stopped:
            raise BadInput(f"{self.name}: {ended.complaint or 'refused, without a reason'}")
        document, why = {}, ended.fault
        if not why:
            try:
                document = _read(scene, ended.answer)
            except BadInput as error:
                why = f"its answer cannot be read: {error}"
        nowhere, points = np.full(3, np.nan), scene.probe_points()
        at = {scene.probes[probe]: u for probe, u in document.get("probes", {}).items()}

        def sample(wanted: np.ndarray) -> np.ndarray:
            return np.array([at.get(tuple(p), nowhere) for p in wanted.tolist()]).reshape(-1, 3)

        solving = float(document.get("solve_seconds", ended.seconds))
        places, vertices = np.column_stack([points, np.zeros(len(points))]), np.arange(len(points))[:, None]
        return Solution(
            model=self.name,
            label=document.get("label", " ".join([self.name, *options])),
            settings=own,
            status=Status(document["status"]) if document else Status.FAILED,
            unknowns=int(document.get("unknowns", 0)),
            iterations=int(document.get("iterations", 0)),
            setup_seconds=max(0.0, ended.seconds - solving),
            solve_seconds=solving,
            sample=sample,
            reactions=document.get("reactions", {}),
            energies={},
            mesh=FieldMesh(places, [("vertex", vertices)], {"displacement": sample(points)}),
            load_factor=float(document.get("load_factor", 1.0)) if document else 0.0,
            remarks=tuple(filter(None, [why, document.get("message", "")])),
        )


def _limits(settings: Mapping[str, Any]) -> tuple[float, int | None]:
    """Seconds, and megabytes of memory: as much as is free unless set."""
    seconds, most = settings["seconds"], settings["memory_mb"]
    for name, value in (("seconds", seconds), ("memory_mb", most)):
        usual = value is None and name == "memory_mb"
        if not usual and not (type(value) in (int, float) and 0 < value <= LARGEST):
            raise BadInput(f"exec: {name} = {value}: a number above 0, and at most {LARGEST:g}")
    if most is None:
        free = memory.available()
        return float(seconds), None if free is None else max(1, free // 2**20)
    return float(seconds), min(max(1, int(most)), UNLIMITED)


def _read(scene: Scene, answer: bytes) -> dict[str, Any]:
    """Return the answer, its vectors as arrays. Raises BadInput that says what is wrong with it."""
    try:
        document = json.loads(answer)
    except (ValueError, RecursionError):
        raise BadInput("not one JSON document") from None
    if not isinstance(document, dict):
        raise BadInput("not a JSON object")
    probes, status = document.get("probes"), document.get("status", str(Status.CONVERGED))
    if status not in [str(known) for known in Status]:
        raise BadInput(f"status = {status!r}: choose from {', '.join(Status)}")
    probes = probes if isinstance(probes, dict) else {}
    missing = [name for name in scene.probes if name not in probes]
    if missing:
        raise BadInput(f"probes: {', '.join(missing)} missing")
    read = {"probes": {name: _vector(probes[name], f"probes.{name}") for name in scene.probes}}
    reactions = document.get("reactions") or {}
    edges = dict(reactions) if isinstance(reactions, dict) else {}
    held = dict.fromkeys([*named(scene.supports), *(actuator.held_as for actuator in scene.actuators)])
    if strange := [edge for edge in edges if edge not in held]:
        raise BadInput(f"reactions: {foreign(', '.join(strange))}: the scene holds {', '.join(held)}")
    forces = {"reactions": {edge: _vector(force, f"reactions.{edge}") for edge, force in edges.items()}}
    numbers = {name: _number(document[name], name) for name in NUMBERS if document.get(name) is not None}
    texts = {name: foreign(document[name]) for name in ("label", "message") if document.get(name)}
    return {**read, **forces, **numbers, **texts, "status": status}


def _vector(value: Any, name: str) -> np.ndarray:
    numbers = isinstance(value, list) and all(type(part) in (int, float) for part in value)
    if not numbers or len(value) != 3 or not all(abs(part) <= LARGEST for part in value):
        raise BadInput(f"{name} = {str(value)[:SHOWN]}: three finite numbers, at most {LARGEST:g}")
    return np.array(value, dtype=float)


def _number(value: Any, name: str) -> float:
    if type(value) not in (int, float) or not 0.0 <= value <= LARGEST:
        raise BadInput(f"{name} = {str(value)[:SHOWN]}: a number, not below 0, and at most {LARGEST:g}")
    return float(value)


def written(value: Any) -> str:
    """Return a setting as text: a size 9x13, other values as JSON has them."""
    if isinstance(value, list):
        return "x".join(map(str, value))
    return value if isinstance(value, str) else json.dumps(value)
