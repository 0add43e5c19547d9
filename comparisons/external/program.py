"""Models that are programs: any executable that reads a scene's JSON and writes an answer's JSON.

The model's name is `exec:PATH`, followed by settings: `exec:./mysim:seconds=5,n=9` runs `./mysim --n=9` for
five seconds at most. Standard input is the scene in the form of "scene" in `compare --json`, always with its
probes; standard output has to be one JSON object:

    status    "converged", or another of `Status`
    probes    {name: [ux, uy, uz]} in metres, for every probe of the scene
    optional  solve_seconds (else the whole run counts), unknowns, iterations, load_factor, label, message,
              reactions {edge: [Fx, Fy, Fz]} of supported edges

Exit status 2 with a line on standard error refuses a scene, as bad input. Any other nonzero status, a signal,
no answer within the time, too long an answer, or an unreadable one gives the status `failed` with the reason,
for this row alone. docs/strip.sh is a short example.
"""

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
SHOWN = 60  # characters quoted from an answer in a refusal
REFUSED = 2  # exit status
NUMBERS = ("solve_seconds", "unknowns", "iterations", "load_factor")


class Program:
    """An executable as a model (`comparisons.external.plugins.Model`)."""

    settings = SETTINGS
    takes_any = True  # settings, which are passed on

    def __init__(self, path: str) -> None:
        """Find the executable. Raises BadInput if it is missing or not executable."""
        executable = shutil.which(path) or shutil.which(path, path=os.curdir)
        if executable is None:
            exists = Path(path).is_file()
            raise BadInput(f"{path}: " + ("not executable, see chmod +x" if exists else "no such program"))
        self.path = Path(executable)
        self.name = Path(path).stem

    def digest(self) -> str:
        """Return a digest of the program's file."""
        return sha256(self.path.read_bytes()).hexdigest()

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the program's answer at the probes, NaN elsewhere. Raises BadInput if the program refuses
        the scene or a limit is invalid."""
        seconds, megabytes = _limits(settings)
        passed = {key: value for key, value in settings.items() if key not in SETTINGS}
        options = [f"--{key}" if v is True else f"--{key}={written(v)}" for key, v in passed.items()]
        question = json.dumps(scene.document()).encode()
        try:
            process = run([str(self.path.resolve()), *options], question, seconds, megabytes)
        except OSError as error:
            raise BadInput(f"{self.path}: cannot be run: {error.strerror}") from None
        if process.code == REFUSED and not process.stopped:
            raise BadInput(f"{self.name}: {process.complaint or 'refused, without a reason'}")
        document, fault = {}, process.fault
        if not fault:
            try:
                document = _read(scene, process.answer)
            except BadInput as error:
                fault = f"its answer cannot be read: {error}"
        no_value, probes = np.full(3, np.nan), scene.probe_points()
        by_point = {scene.probes[probe]: u for probe, u in document.get("probes", {}).items()}

        def sample(points: np.ndarray) -> np.ndarray:
            return np.array([by_point.get(tuple(p), no_value) for p in points.tolist()]).reshape(-1, 3)

        solve_seconds = float(document.get("solve_seconds", process.seconds))
        positions, vertices = (
            np.column_stack([probes, np.zeros(len(probes))]),
            np.arange(len(probes))[:, None],
        )
        return Solution(
            model=self.name,
            label=document.get("label", " ".join([self.name, *options])),
            settings=passed,
            status=Status(document["status"]) if document else Status.FAILED,
            unknowns=int(document.get("unknowns", 0)),
            iterations=int(document.get("iterations", 0)),
            setup_seconds=max(0.0, process.seconds - solve_seconds),
            solve_seconds=solve_seconds,
            sample=sample,
            reactions=document.get("reactions", {}),
            energies={},
            mesh=FieldMesh(positions, [("vertex", vertices)], {"displacement": sample(probes)}),
            load_factor=float(document.get("load_factor", 1.0)) if document else 0.0,
            remarks=tuple(filter(None, [fault, document.get("message", "")])),
        )


def _limits(settings: Mapping[str, Any]) -> tuple[float, int | None]:
    """Return the limits of time [s] and of memory [MB], by default all free memory. Raises BadInput."""
    seconds, megabytes = settings["seconds"], settings["memory_mb"]
    for name, value in (("seconds", seconds), ("memory_mb", megabytes)):
        is_default = value is None and name == "memory_mb"
        if not is_default and not (type(value) in (int, float) and 0 < value <= LARGEST):
            raise BadInput(f"exec: {name} = {value}: a number above 0, and at most {LARGEST:g}")
    if megabytes is None:
        free = memory.available()
        return float(seconds), None if free is None else max(1, free // 2**20)
    return float(seconds), min(max(1, int(megabytes)), UNLIMITED)


def _read(scene: Scene, answer: bytes) -> dict[str, Any]:
    """Return a program's answer, its vectors as arrays. Raises BadInput with the fault of an invalid one."""
    try:
        document = json.loads(answer)
    except (ValueError, RecursionError):
        raise BadInput("not one JSON document") from None
    if not isinstance(document, dict):
        raise BadInput("not a JSON object")
    probes, status = document.get("probes"), document.get("status", str(Status.CONVERGED))
    if status not in [str(valid) for valid in Status]:
        raise BadInput(f"status = {status!r}: choose from {', '.join(Status)}")
    probes = probes if isinstance(probes, dict) else {}
    missing = [name for name in scene.probes if name not in probes]
    if missing:
        raise BadInput(f"probes: {', '.join(missing)} missing")
    read = {"probes": {name: _vector(probes[name], f"probes.{name}") for name in scene.probes}}
    reactions = document.get("reactions") or {}
    edges = dict(reactions) if isinstance(reactions, dict) else {}
    held = dict.fromkeys([*named(scene.supports), *(actuator.held_as for actuator in scene.actuators)])
    if unknown := [edge for edge in edges if edge not in held]:
        raise BadInput(f"reactions: {foreign(', '.join(unknown))}: the scene holds {', '.join(held)}")
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
    """Return a setting as text: a size as 9x13, other values in JSON."""
    if isinstance(value, list):
        return "x".join(map(str, value))
    return value if isinstance(value, str) else json.dumps(value)
