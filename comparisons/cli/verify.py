"""`sheetbench verify`: the finite-element references against published values, and their error bars."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

import typer

from comparisons.cli.options import Figure, Json, NoPictures, Out, Overwrite, Retry, Workers

if TYPE_CHECKING:
    from comparisons.cli.finish import End


def command(
    case: Annotated[
        list[str] | None,
        typer.Option(
            "--case",
            metavar="NAME",
            help="Only this case; may be repeated. All unless given.",
            show_default=False,
        ),
    ] = None,
    locking: Annotated[
        bool, typer.Option("--locking", help="Only the locking sweeps; with --out, their picture.")
    ] = False,
    laws: Annotated[
        bool, typer.Option("--laws", help="Only the laws of strain, with a table of what they change.")
    ] = False,
    coverage: Annotated[
        bool,
        typer.Option(
            "--coverage",
            help="Instead: how often the references' error bars hold the error, on drawn scenes. With "
            "--out an interrupted run is resumed.",
        ),
    ] = False,
    scenes: Annotated[
        int | None,
        typer.Option(
            min=1,
            metavar="N",
            help="With --coverage: scenes drawn; 40 unless given. Each takes half a minute of one processor, "
            "less than half of that without the solid.",
            show_default=False,
        ),
    ] = None,
    seed: Annotated[
        int | None,
        typer.Option(
            min=0, metavar="N", help="With --coverage: of the scenes; 41 unless given.", show_default=False
        ),
    ] = None,
    model: Annotated[
        list[str] | None,
        typer.Option(
            "--model",
            metavar="NAME",
            help="With --coverage: only plate, shell or solid; may be repeated.",
            show_default=False,
        ),
    ] = None,
    workers: Workers = None,
    retry: Retry = False,
    json: Json = False,
    out: Out = None,
    figure: Figure = None,
    no_pictures: NoPictures = False,
    overwrite: Overwrite = False,
) -> None:
    """Check the references against published values, one row each: exit status 3 unless all pass."""
    from comparisons.cli.finish import finish
    from comparisons.verification import tables
    from fem_reference.verification import CASES, run
    from fem_reference.verification.locking import MODELS
    from sheetbench.choices import REFERENCES
    from sheetbench.scenes.errors import BadInput, require_choice

    for name in case or ():
        require_choice("case", name, CASES)
    for name in model or ():
        require_choice("model", name, REFERENCES)
    parts = {"--locking": locking, "--laws": laws, "--coverage": coverage, "--case": bool(case)}
    if len(both := [option for option, given in parts.items() if given]) > 1:
        raise BadInput(f"{' and '.join(both)}: choose one")
    if not coverage and (scenes or seed is not None or model or workers or retry):
        raise BadInput("--scenes, --seed, --model, --workers and --retry are of --coverage")
    chosen = list(MODELS) if locking else ["strain-laws"] if laws else case
    with finish(
        "verify",
        json,
        out,
        overwrite,
        apart={key: parts[key] for key in list(parts)[:3]},
        figure=figure,
        pictures=not no_pictures,
    ) as end:
        if coverage:
            _coverage(end, scenes, seed, model, workers, retry)
            return
        rows = list(run(chosen, starting=lambda name: end.progress(f"verifying {name} …")))
        end(tables.report(rows, locking, laws))


def _coverage(
    end: End,
    scenes: int | None,
    seed: int | None,
    models: list[str] | None,
    workers: int | None,
    retry: bool,
) -> None:
    import os

    from comparisons.coverage import study

    with end.campaign() as (store, pool, progress):
        found = study.coverage(
            store,
            count=scenes or study.SCENES,
            seed=study.SEED if seed is None else seed,
            models=[name for name in study.MODELS if name in (models or study.MODELS)],
            workers=workers or os.cpu_count() or 1,
            pool=pool,
            retry=retry,
            progress=progress,
        )
    end(found.report())
