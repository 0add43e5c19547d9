"""Kratos' thin shell as a model: `ShellThinElementCorotational3D3N`, Kirchhoff's, with drilling rotations.

It knows no transverse shear, so that edges along which nothing holds the director keep the twist that a plate
with shear lets go within about its thickness: it is stiffer than our shell, by a share of h over the length.

Kratos solves in a process of its own (`process`). A load in one step, in 4 if that does not converge, in 16
if that does not. Everything of a scene but chains and edge moments. Needs the extra [kratos].
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from importlib import metadata
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, ClassVar

import numpy as np

from comparisons.external.answer import SUBSTEPS, MovingCode, Reached, Sampled, refusal, require_count
from comparisons.external.kratos.problem import Triangles, problem
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


class Kratos(MovingCode):
    """The plug-in.

    settings: elements along the shorter side, near-square, each two triangles; time_limit [s] of every
    attempt.
    """

    name, called = "kratos", "Kratos' thin shell"
    needs = "the wheels of Kratos; pip install 'sheetbench[kratos]'"
    meshes, layered, integrator = (8, 12, 16), False, "Bossak"
    settings: ClassVar[dict[str, Any]] = {"elements": 16, "time_limit": 600.0}
    unknowns = 6

    def version(self) -> str | None:
        """Of the wheels, None where one is missing."""
        try:
            return {metadata.version(package) for package in PACKAGES}.pop()
        except metadata.PackageNotFoundError:
            return None

    def refusal(self, scene: Scene, settings: Mapping[str, Any]) -> str:
        return refusal(scene, CHAINS, MOMENTS)

    def mesh(self, scene: Scene, settings: Mapping[str, Any]) -> Triangles:
        require_count(settings["elements"])
        self.require_installed()
        return Triangles.of(scene.sheet, settings["elements"])

    def at_rest(self, scene: Scene, settings: Mapping[str, Any], mesh: Triangles) -> Reached:
        found = Reached(np.zeros_like(mesh.positions))
        for steps in STEPS:
            given = problem(scene, mesh, np.arange(1, steps + 1) / steps)
            try:
                answer = _solved(given, settings["time_limit"])
            except Failed as error:
                return found._replace(note=f"Kratos: {error}")
            found = Reached(
                answer["displacement"],
                float(answer["load_factor"]),
                found.iterations + int(answer["iterations"]),
                seconds=found.seconds + float(answer["seconds"]),
                held=int(given["held"].sum()),
            )
            if found.load_factor == 1.0 and np.isfinite(found.displacement).all():
                break
        return found

    def in_motion(
        self, scene: Scene, settings: Mapping[str, Any], mesh: Triangles, duration: float, count: int
    ) -> Sampled:
        even = duration / (count * SUBSTEPS) * np.arange(1, count * SUBSTEPS + 1)
        times = np.concatenate([[BEGINS * even[0]], even])
        given = problem(scene, mesh, np.ones(len(times)), times)
        found, seconds, note = np.zeros((0, *mesh.positions.shape)), 0.0, "Kratos: a step did not converge"
        try:
            answer = _solved(given, settings["time_limit"])
            found, seconds = answer["displacement"][SUBSTEPS::SUBSTEPS], float(answer["seconds"])
        except Failed as error:
            note = f"Kratos: {error}"
        reached = times[SUBSTEPS::SUBSTEPS][: len(found)]
        return Sampled(reached, found, "" if len(found) == count else note, seconds, int(given["held"].sum()))


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
