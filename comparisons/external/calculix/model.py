"""CalculiX as a model: the sheet as 20-node bricks, two layers through the thickness.

A program of its own (Debian: calculix-ccx), `ccx` on the PATH, which reads a deck and writes its
results in a temporary folder. Everything of a scene but chains and edge moments.
"""

from __future__ import annotations

import re
import shutil
from collections.abc import Mapping
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from comparisons.external.answer import BRICK_MOMENTS, SUBSTEPS, MovingCode, Reached, Sampled, refusal
from comparisons.external.bricks import Bricks
from comparisons.external.calculix.deck import INCOMPRESSIBLE, LAWS, Steps, deck
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


class CalculiX(MovingCode):
    """The plug-in.

    settings: elements along the shorter side, near-square; layers of bricks, an even number; grading "edges"
    or "uniform"; linear: without NLGEOM; time_limit [s].
    """

    name, called = "calculix", "CalculiX"
    needs = "the program ccx on the PATH (Debian: calculix-ccx)"
    meshes, layered, integrator = (6, 8, 12), True, "HHT"
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

    def installed(self) -> bool:
        return shutil.which(PROGRAM) is not None

    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Bricks) -> Reached:
        text = deck(scene, mesh, settings["linear"])
        began = perf_counter()
        times, found, iterations, note = _carried_out(text, settings["time_limit"], mesh)
        factor, u = (float(times[-1]), found[-1]) if len(found) else (0.0, np.zeros_like(mesh.positions))
        return Reached(u, factor, iterations, note, perf_counter() - began)

    def in_motion(
        self, scene: Scene, settings: Mapping[str, Any], mesh: Bricks, duration: float, count: int
    ) -> Sampled:
        nodes, _ = mesh.weights(scene.probe_points())
        steps = Steps(duration / count / SUBSTEPS, duration, SUBSTEPS, np.unique(nodes))
        text = deck(scene, mesh, False, steps)
        began = perf_counter()
        times, found, _, note = _carried_out(text, settings["time_limit"], mesh)
        return Sampled(times, found, note, perf_counter() - began)

    def refusal_of_motion(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        of_statics = "linear = true: is for statics" if settings["linear"] else ""
        return self.refusal(scene, settings) or of_statics or super().refusal_of_motion(scene, settings)

    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        if note := refusal(scene, CHAINS, BRICK_MOMENTS, LAWS, DRAWN):
            return note
        material, linear = scene.material, settings["linear"]
        for number, patch in enumerate(scene.patches, start=1):
            if patch.thickness not in (None, scene.sheet.thickness):
                thickness = f"patch {number}.thickness = {patch.thickness:g} m"
                return f"{thickness}: its bricks have no steps in thickness"
        if material.law is not None and scene.varied_by:
            return f"{scene.varied_by}: it is given rubbers that are the same all over"
        if material.kind == "orthotropic":
            return impossible_in_space(material.ply)
        if material.law is None or (material.poisson >= INCOMPRESSIBLE and not linear):
            return ""
        if linear:
            return f"linear = true: the law '{material.law}' is not linear"
        return (
            f"poisson = {material.poisson:g}: its rubbers take volume apart and are those of a scene near "
            f"ν = ½ only; from {INCOMPRESSIBLE:g} on it is given them"
        )


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
