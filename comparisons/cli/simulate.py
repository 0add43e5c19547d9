"""`sheetbench simulate SCENE`: the lattice in motion, from rest, gravity and loads on at t = 0."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any

from comparisons.cli.options import Kind, LatticeOptions, Seconds
from comparisons.cli.output import PictureOptions
from sheetbench.choices import INTEGRATOR, INTEGRATORS

if TYPE_CHECKING:
    from comparisons.comparison.simulation import Simulation

FRAMES = 100
SUMMARIES = "; ".join(f"{name}: {summary}" for name, summary in INTEGRATORS.items())


def command(
    scene: str,
    duration: Annotated[float, Kind("s")] = 1.0,
    *,
    lattice: LatticeOptions,
    step: Seconds = None,
    error: float | None = None,
    integrator: str = INTEGRATOR,
    every: Seconds = None,
    animate: bool = False,
    large: bool = False,
    output: PictureOptions,
) -> Simulation:
    """Simulate the lattice in motion, from rest.

    Gravity and loads are on at t = 0. A run with --out is saved continuously; run the command again to
    resume.

    Args:
        duration (S): Simulated time.
        step (S): Largest time step. Default: from the stability limit or the error.
        error (FRACTION): Error per step, relative to the displacement, for integrators with step control.
        integrator (NAME): {SUMMARIES}; auto: esdirk; generalised-alpha with chains;
            verlet with obstacles, unless dampers make its steps much shorter.
        every (S): Time between samples. Default: 1/100 of the lowest period.
        animate: Draw an animation too (with --out).
    """
    from comparisons.comparison.simulation import Simulation
    from comparisons.models.resolve import resolve
    from comparisons.models.solve import simulate
    from sheetbench.scenes import scene_of

    loaded = scene_of(scene)
    model = resolve(loaded, lattice.spec, "motion")
    run = {"--integrator": integrator, "--step": step, "--every": every, "--error": error}
    run |= {f"--{name}": value for name, value in lattice.spec.settings.items()}
    keywords: dict[str, Any] = {} if error is None else {"error": error}
    with output.open(scene=loaded, variant=run, locked=True) as out:
        history = simulate(
            model,
            duration,
            step=step,
            integrator=integrator,
            every=every,
            store=out.reserve("run/"),
            frames=FRAMES if output.out is not None else 0,
            **keywords,
        )
        out.reserve("frames/")
        return out.show(Simulation(**vars(history), scene=loaded, animate=animate))
