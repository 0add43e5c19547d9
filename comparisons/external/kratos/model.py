"""Kratos' thin shell as a model: `ShellThinElementCorotational3D3N`, Kirchhoff's, with drilling rotations.

It knows no transverse shear, so that edges along which nothing holds the director keep the twist that a plate
with shear lets go within about its thickness: it is stiffer than our shell, by a share of h over the length.

Kratos solves in a process of its own (`process`). A load in one step, in 4 if that does not converge, in 16
if that does not. Everything of a scene but chains and edge moments. Needs the extra [kratos].
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from dataclasses import dataclass
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from comparisons.external.answer import SUBSTEPS, moved, refusal, refusal_of_motion, require_count, solution
from comparisons.external.kratos.problem import Triangles, problem
from sheetbench.answers.history import History
from sheetbench.answers.solution import Solution, Status
from sheetbench.errors import BadInput
from sheetbench.process import Failed, output_of
from sheetbench.scenes import Scene

STEPS = (1, 4, 16)
BEGINS = 1e-3  # of a motion's steps, its first: the load acts from t = 0 on, the acceleration after a step
PACKAGES = (
    "KratosMultiphysics",
    "KratosStructuralMechanicsApplication",
    "KratosLinearSolversApplication",
)

CHAINS = "actuators are not supported: Kratos' shell has no joint with a rest angle between rigid edges"
MOMENTS = "moments on Kratos' nodes do not follow the edge"


@dataclass(frozen=True)
class Kratos:
    """The plug-in.

    settings: elements along the shorter side, near-square, each two triangles; time_limit [s] of every
    attempt.
    """

    name: str = "kratos"
    called: str = "Kratos' thin shell"
    needs: str = "the wheels of Kratos; pip install 'sheetbench[kratos]'"
    meshes: tuple[int, ...] = (8, 12, 16)
    layered: bool = False
    settings: ClassVar[dict[str, Any]] = {"elements": 16, "time_limit": 600.0}

    def version(self) -> str | None:
        """Of the wheels, None where one is missing."""
        try:
            return {metadata.version(package) for package in PACKAGES}.pop()
        except metadata.PackageNotFoundError:
            return None

    def solve(self, scene: Scene, settings: Mapping[str, Any]) -> Solution:
        """Return the static answer. Raises BadInput without Kratos or for settings it cannot use."""
        mesh = self._mesh(scene, settings["elements"])
        note = refusal(scene, CHAINS, MOMENTS)
        displacement, load_factor, iterations = np.zeros_like(mesh.positions), 0.0, 0
        began, seconds, status = perf_counter(), 0.0, Status.REFUSED
        for steps in () if note else STEPS:
            given = problem(scene, mesh, np.arange(1, steps + 1) / steps)
            try:
                answer = _solved(given, settings["time_limit"])
            except Failed as error:
                status, note = Status.DIVERGED, f"Kratos: {error}"
                break
            displacement, load_factor = answer["displacement"], float(answer["load_factor"])
            iterations += int(answer["iterations"])
            seconds += float(answer["seconds"])
            status = Status.CONVERGED if load_factor == 1.0 else Status.DIVERGED
            if not np.isfinite(displacement).all():
                status, displacement = Status.NON_FINITE, np.nan_to_num(displacement)
            if status is Status.CONVERGED:
                break
        held = 0 if note else int(given["held"].sum())
        spent = (perf_counter() - began - seconds, seconds)
        unknowns = 2 * displacement.size - held
        return solution(
            self, settings, mesh, displacement, status, load_factor, note, iterations, spent, unknowns
        )

    def refusal_of_motion(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        """Return why it does not move a scene, "" if it does."""
        return refusal(scene, CHAINS, MOMENTS) or refusal_of_motion(scene)

    def simulate(
        self, scene: Scene, settings: Mapping[str, Any], duration: float, *, every: float
    ) -> History:
        """Return the motion over `duration` [s] from rest, sampled every so often [s], without energies.

        Raises BadInput without Kratos, and for scenes and settings that it does not take.
        """
        if note := self.refusal_of_motion(scene, settings):
            raise BadInput(f"kratos: {note}")
        mesh = self._mesh(scene, settings["elements"])
        began, count = perf_counter(), max(1, round(duration / every))
        even = duration / (count * SUBSTEPS) * np.arange(1, count * SUBSTEPS + 1)
        times = np.concatenate([[BEGINS * even[0]], even])
        given = problem(scene, mesh, np.ones(len(times)), times)
        found, seconds, note = np.zeros((0, *mesh.positions.shape)), 0.0, "Kratos: a step did not converge"
        try:
            answer = _solved(given, settings["time_limit"])
            found, seconds = answer["displacement"][SUBSTEPS::SUBSTEPS], float(answer["seconds"])
        except Failed as error:
            note = f"Kratos: {error}"
        return moved(
            self,
            "Bossak",
            scene,
            {**settings, "every": duration / count},
            mesh,
            times[SUBSTEPS::SUBSTEPS][: len(found)],
            found,
            "" if len(found) == count else note,
            2 * mesh.positions.size - int(given["held"].sum()),
            (perf_counter() - began - seconds, seconds),
        )

    def _mesh(self, scene: Scene, elements: Any) -> Triangles:
        """Return the mesh. Raises BadInput without Kratos, and for what is no number of elements."""
        require_count(elements)
        if self.version() is None:
            raise BadInput(f"model = 'kratos': needs {self.needs}")
        return Triangles.of(scene.sheet, elements)


def _solved(given: Mapping[str, Any], limit: float) -> dict[str, np.ndarray]:
    """Return what the process answers. Raises Failed where it does not."""
    with TemporaryDirectory(prefix="sheetbench-kratos-") as kept:
        question, answer = Path(kept) / "problem.npz", Path(kept) / "answer.npz"
        np.savez(question, **given)
        module = "comparisons.external.kratos.process"
        output_of([sys.executable, "-m", module, str(question), str(answer)], Path(kept), limit)
        try:
            with np.load(answer) as arrays:
                return dict(arrays)
        except (OSError, ValueError) as error:
            raise Failed(f"left no answer that can be read ({error})") from None


MODEL = Kratos()
