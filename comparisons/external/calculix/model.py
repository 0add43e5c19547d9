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

from comparisons.external.answer import BRICK_MOMENTS, refusal, require, solution_on_bricks
from comparisons.external.bricks import GRADINGS, Bricks
from comparisons.external.calculix import results
from comparisons.external.calculix.deck import INCOMPRESSIBLE, LAWS, deck
from comparisons.external.process import Failed, output_of
from sheetbench.errors import BadInput
from sheetbench.scenes import Scene, Solution, Status

PROGRAM, JOB = "ccx", "sheet"
SAYS_ITS_VERSION = 201  # its exit status after `ccx -v`

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
        require(settings["elements"], settings["layers"], settings["grading"], GRADINGS)
        program = shutil.which(PROGRAM)
        if program is None:
            raise BadInput(f"model = 'calculix': needs {self.needs}")
        bricks = Bricks.of(scene.sheet, settings["elements"], settings["layers"], settings["grading"])
        began = perf_counter()
        note = refusal(scene, CHAINS, BRICK_MOMENTS, LAWS) or _of_volume(scene, settings["linear"])
        displacement, load_factor, iterations = np.zeros_like(bricks.positions), 0.0, 0
        ready, status = began, Status.REFUSED
        if not note:
            with TemporaryDirectory(prefix="sheetbench-ccx-") as kept:
                folder = Path(kept)
                text = deck(scene, bricks, settings["linear"])
                (folder / f"{JOB}.inp").write_text(text, encoding="ascii")
                ready = perf_counter()
                try:
                    output_of([program, JOB], folder, settings["time_limit"])
                    load_factor, displacement = results.displacements(_read(folder, "dat"), len(displacement))
                    status = Status.CONVERGED if load_factor == 1.0 else Status.DIVERGED
                    if not np.isfinite(displacement).all():
                        status, displacement = Status.NON_FINITE, np.nan_to_num(displacement)
                except Failed as error:
                    status, note = Status.DIVERGED, f"CalculiX: {error}"
                iterations = results.iterations(_read(folder, "sta"))
        seconds = (ready - began, perf_counter() - ready)
        return solution_on_bricks(
            self, scene, settings, bricks, displacement, status, load_factor, note, iterations, seconds
        )


def _of_volume(scene: Scene, linear: bool) -> str:
    """Return why a rubber is none of CalculiX', "" if it is."""
    material = scene.material
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


MODEL = CalculiX()
