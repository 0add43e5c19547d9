"""`sheetbench compare SCENE`: the lattice and a finite-element reference side by side."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from comparisons.cli.options import LatticeOptions, Models, Seconds
from comparisons.cli.output import PictureOptions
from comparisons.cli.verb import no_effect
from sheetbench.choices import REFERENCE

if TYPE_CHECKING:
    from comparisons.comparison.answer import Comparison
    from comparisons.comparison.motion_answer import MotionComparison
    from sheetbench.answers.solution import Solution

FRAMES = 100  # of a motion


@no_effect(
    with_duration="branch settle sensitivity",
    with_settle="branch uncertainty",
    without_duration="every animate",
)
def command(
    scene: str,
    lattice: LatticeOptions,
    reference: str = REFERENCE,
    *,
    elements: str | None = None,
    law: str | None = None,
    model: Models = None,
    uncertainty: bool | None = None,
    branch: str | None = None,
    settle: bool = False,
    sensitivity: list[str] | None = None,
    duration: Seconds = None,
    every: Seconds = None,
    animate: bool = False,
    large: bool = False,
    output: PictureOptions,
) -> Annotated[Comparison | MotionComparison, "duration: MotionComparison"]:
    """Solve a scene with the lattice and a reference, side by side.

    Differences are shown with the reference's error bar, and the cost of each model. Uniform springs are
    added unless a calibration is named. Runs with --duration and --out are saved continuously; run the
    command again to resume them.

    Args:
        reference (MODEL): {REFERENCES}.
        elements (N): The reference's elements along the shorter side, or 8x4 along x and y; default:
            {ELEMENTS}; 8 with --duration.
        uncertainty: Solve the reference on coarser meshes too, for its error bar. Default: on for plate and
            shell.
        branch (NAME): {BRANCHES}: buckled leaves an unstable equilibrium along its buckling mode. Default:
            path.
        settle: Start both models from the end of a strongly damped motion: for thin sheets, which fold before
            statics reach the full load.
        sensitivity (NAMES): Parameters of the scene (young, thickness, load1.force.z): a column each, the
            change of every probe's displacement by 1 % more of it.
        duration (S): Compare the motion over this time, from rest.
        every (S): Time between samples (with --duration). Default: 1/100 of the lowest period.
        animate: Draw an animation of both sheets side by side (with --duration and --out).
    """
    from comparisons.comparison.comparison import compare, load_static
    from comparisons.models.context import running
    from comparisons.models.grids import parse_elements
    from comparisons.pictures.array_files import write_mesh
    from sheetbench import scenes

    name_of_reference = reference if isinstance(reference, str) else reference.label
    models = {"--reference": name_of_reference, **({"--model": " ".join(map(str, model))} if model else {})}
    size = None if elements is None else parse_elements(elements)
    shared: dict[str, Any] = {"reference": reference, "elements": size, "law": law, "models": model or ()}
    if duration is not None:
        from comparisons.comparison.motion import compare_motion

        loaded = scenes.scene_of(scene)
        with output.open(scene=loaded, variant={"--duration": duration, "--every": every, **models}) as out:
            for name in ("lumped", name_of_reference) if output.out is not None else ():
                out.reserve(f"{name}/")
            motions = compare_motion(
                loaded,
                duration,
                lattice.spec,
                uncertainty=uncertainty is not False,
                every=every,
                frames=FRAMES if output.out is not None else 0,
                store=out.reserve("runs/"),
                **shared,
            )
            return out.show(replace(motions, animate=animate))
    loaded = load_static(scene)
    spec = lattice.spec.but(branch=branch or "path")
    models |= {"--calibration": "open" if spec.calibration is None and spec.k is None else "named"}
    with output.open(scene=loaded, variant=models) as out:

        def keep(solution: Solution) -> None:
            out.keep(f"{solution.model}.vtu", lambda path: write_mesh(path, solution.mesh))

        with running(solved=keep):
            comparison = compare(loaded, spec, uncertainty=uncertainty, settle=settle, **shared)
        return out.show(replace(comparison, sensitive_to=tuple(sensitivity or ())))
