"""CalculiX as a model: the sheet as 20-node bricks, two layers through the thickness.

A program of its own (Debian: calculix-ccx), `ccx` on the PATH, which reads a deck and writes its
results in a temporary folder. Everything of a scene but chains and edge moments.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from comparisons.external.answer import (
    BRICK_MOMENTS,
    SUBSTEPS,
    moved,
    refusal,
    refusal_of_motion,
    require,
    solution,
)
from comparisons.external.bricks import GRADINGS, Bricks
from comparisons.external.calculix.deck import INCOMPRESSIBLE, LAWS, Steps, deck
from sheetbench.answers.history import History
from sheetbench.answers.solution import Solution, Status
from sheetbench.errors import BadInput
from sheetbench.process import Failed, output_of
from sheetbench.scenes import Scene
from sheetbench.scenes.objects.fields import SHAPED
from sheetbench.scenes.objects.orthotropy import FIBRES, impossible_in_space

_HEADING = re.compile(r"^ *displacements .* and time +(\S+) *$", re.MULTILINE)
PROGRAM, JOB = "ccx", "sheet"
SAYS_ITS_VERSION = 201  # its exit status after `ccx -v`

# What of drawn sheets it is given, as scenes call it (`Scene.drawn_by`).
DRAWN = (*SHAPED, FIBRES, "sheet.taper_x", "sheet.taper_y", "patch")
CHAINS = "actuators are not supported: it has no joint with a rest angle between rigid bodies"


@dataclass(frozen=True)
class CalculiX:
    """The plug-in.

    settings: elements along the shorter side, near-square; layers of bricks, an even number; grading "edges"
    or "uniform"; linear: without NLGEOM; time_limit [s].
    """

    name: str = "calculix"
    called: str = "CalculiX"
    needs: str = "the program ccx on the PATH (Debian: calculix-ccx)"
    meshes: tuple[int, ...] = (6, 8, 12)
    layered: bool = True
    settings: ClassVar[dict[str, Any]] = {
        "elements": 8,
        "layers": 2,
        "grading": "edges",
        "linear": False,
        "time_limit": 600.0,
    }

    def version(self) -> str | None:
        """Return the program's, None where it is not there."""
        return _version(shutil.which(PROGRAM))

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the static answer. Raises BadInput without the program or for settings it cannot use."""
        began, bricks = perf_counter(), self._bricks(scene, settings)
        note = _refusal(scene, settings["linear"])
        displacement, load_factor, iterations = np.zeros_like(bricks.positions), 0.0, 0
        ready, status = began, Status.REFUSED
        if not note:
            text = deck(scene, bricks, settings["linear"])
            ready = perf_counter()
            times, found, iterations, note = _carried_out(text, settings["time_limit"], bricks)
            status = Status.CONVERGED if not note and times[-1] == 1.0 else Status.DIVERGED
            if len(found):
                load_factor, displacement = float(times[-1]), found[-1]
            if not np.isfinite(displacement).all():
                status, displacement = Status.NON_FINITE, np.nan_to_num(displacement)
        seconds = (ready - began, perf_counter() - ready)
        return solution(self, settings, bricks, displacement, status, load_factor, note, iterations, seconds)

    def refusal_of_motion(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        """Return why it does not move a scene, "" if it does."""
        of_statics = "linear = true: is for statics" if settings["linear"] else ""
        return _refusal(scene, settings["linear"]) or of_statics or refusal_of_motion(scene)

    def simulate(
        self, scene: Scene, settings: Mapping[str, Any], duration: float, *, every: float
    ) -> History:
        """Return the motion over `duration` [s] from rest, sampled every so often [s], without energies.

        Raises BadInput without the program, and for scenes and settings that it does not take.
        """
        if note := self.refusal_of_motion(scene, settings):
            raise BadInput(f"calculix: {note}")
        began, bricks = perf_counter(), self._bricks(scene, settings)
        nodes, _ = bricks.weights(scene.probe_points())
        count = max(1, round(duration / every))
        steps = Steps(float(duration) / count / SUBSTEPS, float(duration), SUBSTEPS, np.unique(nodes))
        text = deck(scene, bricks, False, steps)
        ready = perf_counter()
        times, found, _, note = _carried_out(text, settings["time_limit"], bricks)
        ended = perf_counter()
        return moved(
            self,
            "HHT",
            scene,
            {**settings, "every": duration / count},
            bricks,
            times,
            found,
            note if note or len(found) == count else "it stopped before the end",
            bricks.positions.size,
            (ready - began, ended - ready),
        )

    def _bricks(self, scene: Scene, settings: Mapping[str, Any]) -> Bricks:
        """Return the mesh. Raises BadInput without the program or for settings it cannot use."""
        require(settings["elements"], settings["layers"], settings["grading"], GRADINGS)
        if shutil.which(PROGRAM) is None:
            raise BadInput(f"model = 'calculix': needs {self.needs}")
        return Bricks.of(scene, settings["elements"], settings["layers"], settings["grading"])


def _carried_out(deck: str, seconds: float, bricks: Bricks) -> tuple[np.ndarray, np.ndarray, int, str]:
    """Return times and displacements as `displacements` has them, none where the run failed before
    any, its iterations, and why it failed, "" if it did not."""
    times, found, why = np.zeros(0), np.zeros((0, *bricks.positions.shape)), ""
    with TemporaryDirectory(prefix="sheetbench-ccx-") as kept:
        folder = Path(kept)
        (folder / f"{JOB}.inp").write_text(deck, encoding="ascii")
        try:
            output_of([shutil.which(PROGRAM) or PROGRAM, JOB], folder, seconds)
            times, found = displacements(_read(folder, "dat"), len(bricks.positions))
        except Failed as error:
            why = f"CalculiX: {error}"
        return times, found, iterations(_read(folder, "sta")), why


def _refusal(scene: Scene, linear: bool) -> str:
    """Return why it cannot solve a scene, "" if it can."""
    if note := refusal(scene, CHAINS, BRICK_MOMENTS, LAWS, DRAWN):
        return note
    material = scene.material
    for number, patch in enumerate(scene.patches, start=1):
        if patch.thickness not in (None, scene.sheet.thickness):
            return f"patch {number}.thickness = {patch.thickness:g} m: its bricks have no steps in thickness"
    if material.law is not None and scene.varied_by:
        return f"{scene.varied_by}: it is given rubbers that are the same all over"
    if material.kind == "orthotropic":
        return impossible_in_space(material.ply)
    if material.law is None or (material.poisson >= INCOMPRESSIBLE and not linear):
        return ""
    if linear:
        return f"linear = true: the law '{material.law}' is not linear"
    return (
        f"poisson = {material.poisson:g}: its rubbers take volume apart and are those of a scene near ν = ½ "
        f"only; from {INCOMPRESSIBLE:g} on it is given them"
    )


def _read(folder: Path, ending: str) -> str:
    try:
        return (folder / f"{JOB}.{ending}").read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""


@cache
def _version(program: str | None) -> str | None:
    if program is None:
        return None
    try:
        printed = output_of([program, "-v"], Path.cwd(), 10.0, fine=(0, SAYS_ITS_VERSION))
    except Failed:
        return None
    match = re.search(r"Version +(\S+)", printed, re.IGNORECASE)
    return match.group(1) if match else "of unknown version"


def displacements(dat: str, nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the times (s,) of the increments that were printed, of statics the load factors, and their
    displacements (s, nodes, 3) [m], nan of nodes that were not.

    Raises Failed for a file that does not have them.
    """
    headings = list(_HEADING.finditer(dat))
    if not headings:
        raise Failed("its .dat file has no displacements")
    out = np.full((len(headings), nodes, 3), np.nan)
    try:
        for sample, heading in zip(out, headings, strict=True):
            for line in dat[heading.end() :].split("\n\n", 2)[1].splitlines():
                number, *components = line.split()
                sample[int(number) - 1] = [float(c) for c in components]
        times = [float(heading.group(1)) for heading in headings]
    except (ValueError, IndexError):
        raise Failed("its .dat file cannot be read") from None
    return np.array(times), out


def iterations(sta: str) -> int:
    """Equilibrium iterations, each one factorisation; a linear step has one."""
    rows = [line.split() for line in sta.splitlines()]
    counts = [int(row[3]) for row in rows if len(row) >= 7 and all(part.isdigit() for part in row[:4])]
    return max(sum(counts), 1)


MODEL = CalculiX()
