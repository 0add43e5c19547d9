"""`sheetbench compare SCENE`: the lattice and a finite-element reference side by side."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated

from comparisons.cli.options import Export, Large, LatticeOptions, Law, Models, Scene, Symmetry, option
from comparisons.cli.output import PictureOptions
from sheetbench.choices import BRANCHES, ELEMENTS, REFERENCE, REFERENCES, listed

FRAMES = 100  # of a motion


def command(
    scene: Scene,
    lattice: LatticeOptions,
    reference: Annotated[str, option(f"{listed(REFERENCES)}.", "MODEL")] = REFERENCE,
    elements: Annotated[
        str | None,
        option(
            "The reference's elements along the shorter side, or 8x4 along x and y; "
            f"default: {ELEMENTS}; 8 with --duration.",
            "N",
        ),
    ] = None,
    law: Law = None,
    symmetry: Symmetry = False,
    model: Models = None,
    uncertainty: Annotated[
        bool,
        option("Solve the reference on coarser meshes too, for its error bar; plates and shells always are."),
    ] = False,
    no_uncertainty: Annotated[bool, option("Solve the reference once, without its error bar.")] = False,
    branch: Annotated[
        str | None,
        option(
            f"{listed(BRANCHES)}: buckled leaves an unstable equilibrium along its buckling mode. "
            "Default: path.",
            "NAME",
        ),
    ] = None,
    duration: Annotated[
        float | None, option("Compare the motion over this time, from rest.", "S", unit="s")
    ] = None,
    every: Annotated[
        float | None,
        option("With --duration: time between samples. Default: 1/100 of the lowest period.", "S", unit="s"),
    ] = None,
    animate: Annotated[
        bool, option("With --duration and --out: draw both sheets moving, side by side.")
    ] = False,
    export: Export = None,
    large: Large = False,
    *,
    output: PictureOptions,
) -> None:
    """Solve a scene with the lattice and with a reference, and show what differs and what it cost.

    Where no calibration is named, uniform springs are shown alongside. With --duration and --out, runs are
    written to the folder as they go, and the same command resumes them.
    """
    from comparisons.comparison.comparison import compare, load_static
    from comparisons.models.context import running
    from comparisons.models.grids import parse_elements
    from comparisons.models.resolve import resolve
    from comparisons.report.vtk import write_mesh
    from sheetbench import scenes
    from sheetbench.errors import BadInput, require_effect

    if uncertainty and no_uncertainty:
        raise BadInput("--uncertainty and --no-uncertainty: give one of them")
    models = {"--reference": reference, **({"--model": " ".join(model)} if model else {})}
    if duration is not None:
        from comparisons.motion.comparison import compare_motion

        statics = {"--symmetry": symmetry, "--branch": branch, "--export": export}
        require_effect("with --duration", statics)
        if animate:
            output.require_pictures("--animate")
        moving = scenes.load(scene)
        chosen = None if elements is None else parse_elements(elements)
        with output.open(scene=moving, variant={"--duration": duration, "--every": every, **models}) as out:
            for name in ("lumped", reference, "difference") if output.out is not None else ():
                out.reserve(f"{name}/")
            both = compare_motion(
                moving,
                duration,
                lattice.spec,
                reference,
                elements=chosen,
                law=law,
                uncertainty=not no_uncertainty,
                models=model or (),
                every=every,
                frames=FRAMES if output.out is not None else 0,
                store=out.reserve("runs/"),
            )
            out.show(replace(both, animate=animate))
        return
    if every is not None:
        raise BadInput("--every: needs --duration, how long the sheet is to move")
    if animate:
        raise BadInput("--animate: needs --duration, how long the sheet is to move")
    loaded = load_static(scene)
    size = parse_elements(elements or str(ELEMENTS))
    named = lattice.calibration is not None or lattice.k is not None
    models |= {"--calibration": "named" if named else "open"}
    with output.open(scene=loaded, variant=models) as out:

        def keep(solution: scenes.Solution) -> None:
            out.keep(f"{solution.model}.vtu", lambda path: write_mesh(path, solution.mesh))

        with running(solved=keep):
            comparison = compare(
                loaded,
                lattice.spec,
                reference,
                elements=size,
                law=law,
                uncertainty=False if no_uncertainty else uncertainty or None,
                symmetry=symmetry,
                branch=branch or "path",
                models=model or (),
            )
        if export is not None:
            out.export(export, loaded, resolve(loaded, lattice.spec).springs)
        out.show(comparison)
