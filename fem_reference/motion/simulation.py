"""Motion of a reference from rest: a scene in, a `scenes.History` out.

Gravity, loads and commands act from t = 0 on, loads scaled by their histories. The sheet starts flat and at
rest; with a curved support or a tilted clamp, in the shape that supports alone give it. Steps are as long as
their error allows; samples lie within them, cubic in time between their ends.
"""

from __future__ import annotations

from collections.abc import Callable
from inspect import signature
from typing import Any

import numpy as np

from fem_reference.motion.energy_momentum import EnergyMomentum
from fem_reference.motion.generalised_alpha import ERROR, GeneralisedAlpha, StepFailed
from fem_reference.motion.loads import kinks
from fem_reference.motion.moving import Motion, Moving
from fem_reference.motion.plate import MovingPlate
from fem_reference.motion.shell import MovingShell
from fem_reference.motion.solid import MovingSolid
from fem_reference.vibration import modes
from sheetbench.choices import REFERENCE, STRAIN_LAW, listed
from sheetbench.clock import now
from sheetbench.errors import BadInput, require_choice
from sheetbench.numerics.direct import SingularMatrixError
from sheetbench.numerics.threads import one_blas_thread
from sheetbench.scenes import AnyScene, History, Scene, Status, require_no_branches, scene_of
from sheetbench.scenes.quantities import require_positive

MODELS: dict[str, Callable[..., Moving]] = {
    "plate": MovingPlate,
    "shell": MovingShell,
    "solid": MovingSolid,
}
INTEGRATORS = {"generalised-alpha": GeneralisedAlpha, "energy-momentum": EnergyMomentum}
SAMPLES_PER_PERIOD, STEPS_PER_PERIOD = 100, 200
MOST_SAMPLES = 10**7
MOST_STEPS = 10**6


def simulate(
    scene: AnyScene,
    model: str = REFERENCE,
    duration: float = 1.0,
    *,
    integrator: str = "generalised-alpha",
    step: float | None = None,
    error: float = ERROR,
    every: float | None = None,
    frames: int = 0,
    progress: Callable[[float], None] | None = None,
    **options: Any,
) -> History:
    """Motion of a scene's sheet over `duration` [s] as a reference has it.

    integrator: "generalised-alpha", or "energy-momentum", which keeps energy and momenta to rounding in fixed
    steps, 1/200 of the lowest period unless given. step [s]: fixed; without it steps keep to an `error` each,
    of the displacement relative to the largest so far. every [s]: distance of samples, 1/100 of the lowest
    period unless given. frames: whole displacements to keep, evenly over the run, in `extra`: "frames"
    (f, n, 3), "frame_times" (f,), the "mesh" they belong to and "sample", which takes one and plan points
    (p, 2) to displacements (p, 3). progress: called with the time reached. options: the model's own,
    `elements` among them.

    Raises BadInput for a model that does not move, or what a model cannot move.

    >>> import fem_reference
    >>> history = fem_reference.simulate("two-edges-settling", "shell", 0.01, elements=2)
    >>> history.status, float(history.time[-1])
    (<Status.CONVERGED: 'converged'>, 0.01)
    """
    require_moving(scene_of(scene), model)
    for name, value in {"duration": duration, "step": step, "every": every, "error": error}.items():
        require_positive(name, value, "s")
    began = now()
    asked = scene_of(scene)
    require_choice("integrator", integrator, INTEGRATORS)
    if asked.material.law is not None and "law" in signature(MODELS[model]).parameters:
        options.setdefault("law", asked.material.law)
    moving = MODELS[model](asked, **options)
    times = _sample_times(asked, duration, every)
    if integrator == "energy-momentum":
        require_no_branches(asked.material, f"the integrator {integrator}")
        if not moving.conservative:
            raise BadInput(f"integrator = '{integrator}': the strain law '{STRAIN_LAW}' alone is conserved")
        longest = step or _lowest_period(asked) / STEPS_PER_PERIOD
        step = float(times[1]) / np.ceil(times[1] / longest - 1e-9)  # energies are kept at the steps' ends
    ready = now()
    with one_blas_thread():
        method = INTEGRATORS[integrator](moving, step, error, 0.1 * float(times[1]))
        run = _Run(moving, asked, times, method, frames, progress or (lambda time: None))
        status, message = run.finish()
    done = now()
    return History(
        label=moving.label,
        integrator=integrator,
        settings={**moving.settings, "step": step or "adaptive", "error": error, "every": float(times[1])},
        status=status,
        message=message,
        time=times[: len(run.energies)],
        probes={name: np.array([u[i] for u in run.probes]) for i, name in enumerate(asked.probes)},
        energies=run.energy_table(),
        reactions={name: np.array([r[name] for r in run.reactions]) for name in run.reactions[0]},
        actuators={},
        steps=run.steps,
        setup_seconds=ready - began,
        solve_seconds=done - ready,
        extra={
            "frames": np.array(run.frames),
            "frame_times": times[sorted(run.shown)][: len(run.frames)],
            "mesh": moving.mesh(moving.displacement(np.zeros(moving.mass.shape[0]))),
            "sample": moving.sample,
            "axes": {},
            "unknowns": moving.unknowns,
            "factorisations": run.method.factorisations,
        },
    )


def require_moving(scene: Scene, model: str) -> None:
    """Raise BadInput for a model that does not move, or a scene with what no reference moves."""
    if model not in MODELS:
        raise BadInput(f"reference = '{model}': {listed(MODELS)} can move")


def _sample_times(scene: Scene, duration: float, every: float | None) -> np.ndarray:
    spacing = every or _lowest_period(scene) / SAMPLES_PER_PERIOD
    if duration / spacing > MOST_SAMPLES:
        said = f"would keep {duration / spacing:.1e} samples, {MOST_SAMPLES:.0e} at most"
        raise BadInput(f"duration = {duration:g} s: {said}: ask for a shorter run or a larger --every")
    count = max(1, round(duration / spacing) if every else int(np.ceil(duration / spacing - 1e-9)))
    return np.linspace(0.0, duration, count + 1)


def _lowest_period(scene: Scene) -> float:
    return 1.0 / float(modes(scene, "plate", 4, count=1).frequencies[0])


class _Run:
    """A run and the samples that it has taken."""

    def __init__(
        self,
        model: Moving,
        scene: Scene,
        times: np.ndarray,
        method: GeneralisedAlpha,
        frames: int,
        progress: Callable[[float], None],
    ):
        self._model, self._times, self._progress = model, times, progress
        self._points = scene.probe_points()
        self._kinks = [time for time in kinks(scene) if time < times[-1]]
        self.method = method
        self.shown = set(np.linspace(0, len(times) - 1, frames).round().astype(int).tolist())
        self.probes: list[np.ndarray] = []
        self.reactions: list[dict[str, np.ndarray]] = []
        self.energies: list[list[float]] = []
        self.frames: list[np.ndarray] = []
        self.steps = 0
        self._spent = np.zeros(2)  # dissipated, work

    def finish(self) -> tuple[Status, str]:
        """Go on to the end, or to the last step that could be made: how it ended."""
        q = self._model.start()
        motion = self._begin(0.0, q, np.zeros_like(q))
        self._sample(motion, motion)
        for end in (*self._kinks, float(self._times[-1])):
            while end - motion.time > 1e-9 * end:
                try:
                    after = self.method.advance(motion, end - motion.time)
                except (StepFailed, SingularMatrixError) as failure:
                    return Status.DIVERGED, f"at {motion.time:.6g} s: {failure}"
                self.steps += 1
                if self.steps >= MOST_STEPS:
                    return Status.STEP_LIMIT, f"at {motion.time:.6g} s: {MOST_STEPS} steps were not enough"
                self._sample(motion, after)
                motion = after
                self._progress(motion.time)
            if end < self._times[-1]:
                motion = self._begin(end, self._model.placed(motion.q, end), motion.v)
        return Status.CONVERGED, ""

    def energy_table(self) -> dict[str, np.ndarray]:
        """Energies [J] by name, as a history has them."""
        names = ("kinetic", "elastic", "potential", "dissipated", "work")
        return dict(zip(names, np.array(self.energies).T, strict=True))

    def _begin(self, time: float, q: np.ndarray, v: np.ndarray) -> Motion:
        """The motion from a time on; what a sudden rate of a support adds is work."""
        motion, mass = self.method.begin(time, q, v), self._model.mass
        self._spent[1] += 0.5 * float(motion.v @ (mass @ motion.v) - v @ (mass @ v))
        return motion

    def _sample(self, start: Motion, end: Motion) -> None:
        """Take the samples of a step."""
        h = end.time - start.time
        spent = self._model.spent(start, end) if h else np.zeros(2)
        while len(self.energies) < len(self._times):
            time = float(self._times[len(self.energies)])
            if time > end.time + 1e-9 * self._times[-1]:
                break
            motion = between(start, end, time) if h else end
            so_far = self._spent + spent * ((motion.time - start.time) / h if h else 0.0)
            self.energies.append([*self._model.energies(motion.q, motion.v, motion.time), *so_far])
            displacement = self._model.displacement(motion.q)
            self.probes.append(self._model.sample(displacement, self._points))
            self.reactions.append(self._model.reactions(motion.exerted))
            if len(self.energies) - 1 in self.shown:
                self.frames.append(displacement.copy())
        self._spent = self._spent + spent


def between(start: Motion, end: Motion, time: float) -> Motion:
    """The motion within a step: coordinates cubic in time, all else linear."""
    h = end.time - start.time
    s = min((time - start.time) / h, 1.0)
    if s == 1.0:
        return end
    cubic = (1.0 + 2.0 * s) * (1.0 - s) ** 2 * start.q + s * s * (3.0 - 2.0 * s) * end.q
    cubic = cubic + h * s * (1.0 - s) * ((1.0 - s) * start.v - s * end.v)
    v, a, algorithm, exerted = (
        (1.0 - s) * getattr(start, name) + s * getattr(end, name)
        for name in ("v", "a", "algorithm", "exerted")
    )
    return Motion(time, cubic, v, a, algorithm, exerted)
